#pragma once

/// @file mesh_equilibrator.templates.h
/// The definition of mesh_equilibrator.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include "tribound/certify/equilibrate/mesh_equilibrator.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/base/parallel.h"
#include "tribound/certify/equilibrate/cell_cache.h"
#include "tribound/certify/equilibrate/patch.h"
#include "tribound/certify/equilibrate/row_patch.h"
#include "tribound/certify/equilibrate/vertex_partition.h"

namespace tribound::certify
{

namespace detail
{

/// The stress of one iterate. The patches write their shares into the cells, and a cell with all of them
/// gives its stress. Every thread has a part of the vertices; cells with vertices in several of them come
/// last. `with_dis`: the partition has all vertices; otherwise those on Gamma_C, which give sigma_lin.
template <class Patch>
class Equilibration
{
 public:
  using Kind = typename Patch::Kind;
  static constexpr int dim = Kind::dim;
  static constexpr int p = Kind::p;

  Equilibration(const mesh::Mesh<dim>& mesh, const FacetData<dim, p>& data, const CellSource<Kind>& source,
                const VertexPartition& partition, bool with_dis)
      : mesh_(mesh),
        data_(data),
        source_(source),
        partition_(partition),
        with_dis_(with_dis),
        shares_(partition.shared_cells.size(), Shares(data.n_parts()))
  {
  }

  Stress<dim> run()
  {
    prepare_stress();
    in_threads(partition_.size(), [&](int part) { solve_patches(part); });
    in_threads(partition_.size(), [&](int part) { recover_shared_cells(part); });
    return std::move(stress_);
  }

 private:
  using S = Sizes<dim, p>;
  using Cell = typename Kind::Cell;
  using Shares = CellShares<typename Kind::Share, dim>;

  void prepare_stress();
  void solve_patches(int part);
  void recover_shared_cells(int part);
  void recover(Index cell, const Cell& prepared, const Shares& shares);

  const mesh::Mesh<dim>& mesh_;
  const FacetData<dim, p>& data_;
  const CellSource<Kind>& source_;
  const VertexPartition& partition_;
  const bool with_dis_;
  Stress<dim> stress_;
  std::vector<Shares> shares_;  ///< of the shared cells
};

template <class Patch>
void Equilibration<Patch>::prepare_stress()
{
  stress_.degree = p;
  stress_.n = S::stress;
  stress_.patches = Kind::patches;
  if (with_dis_) stress_.dis.resize(mesh_.n_owned_cells() * stress_.block_size());
  stress_.lin_block.assign(mesh_.n_owned_cells(), -1);
  int n_lin = 0;
  for (Index c = 0; c < mesh_.n_owned_cells(); ++c)
    if (std::ranges::any_of(mesh_.cell(c), [&](Index v) { return data_.on_contact(v); }))
      stress_.lin_block[c] = n_lin++;
  stress_.lin.resize(n_lin * stress_.block_size());
  if (data_.n_parts() > 2) stress_.reg.resize(stress_.lin.size());
}

template <class Patch>
void Equilibration<Patch>::solve_patches(int part)
{
  const mesh::Topology<dim>& topology = mesh_.topology();
  const auto in_part = [&](Index v) { return partition_.part[v] == part; };
  CellCache<Kind> cache(source_, data_.n_parts());
  Patch patch(mesh_, data_);
  for (std::size_t i = partition_.begin[part]; i < partition_.begin[part + 1]; ++i)
  {
    const Index v = partition_.order[i];
    const auto begin = topology.vertex_cells_begin[v];
    const auto cells =
        std::span(topology.vertex_cells).subspan(begin, topology.vertex_cells_begin[v + 1] - begin);
    patch.begin(v);
    for (const Index c : cells)
    {
      auto& slot = cache.get(c);
      if (slot.waiting == 0) slot.waiting = static_cast<int>(std::ranges::count_if(mesh_.cell(c), in_part));
      const int shared = partition_.shared_index[c];
      Shares& shares = shared < 0 ? slot.shares : shares_[shared];
      patch.add_cell(c, slot.cell, shares[slot.cell.sorted.find(v)]);
    }
    patch.solve();
    for (const Index c : cells)
    {
      auto& slot = cache.get(c);
      if (--slot.waiting > 0) continue;
      if (partition_.shared_index[c] < 0) recover(c, slot.cell, slot.shares);
      cache.forget(c);
    }
  }
}

template <class Patch>
void Equilibration<Patch>::recover_shared_cells(int part)
{
  const std::vector<Index>& cells = partition_.shared_cells;
  const auto prepared = std::make_unique<Cell>();
  for (std::size_t i = part; i < cells.size(); i += partition_.size())
  {
    source_.prepare(cells[i], *prepared, false);
    recover(cells[i], *prepared, shares_[i]);
  }
}

/// sigma = sum of the patch stresses of the cell's vertices. Not of ghosts, whose other patches are
/// elsewhere.
template <class Patch>
void Equilibration<Patch>::recover(Index cell, const Cell& prepared, const Shares& shares)
{
  if (cell >= mesh_.n_owned_cells()) return;
  constexpr int m = S::multiplier;
  const std::size_t size = stress_.block_size();
  for (int problem = with_dis_ ? 0 : 1; problem < (with_dis_ ? data_.n_parts() : 2); ++problem)
  {
    if (problem > 0 && stress_.lin_block[cell] < 0) return;
    StressCoefficients<dim, p> sigma = Patch::stress(prepared, shares, problem, data_);
    if (problem == 0)
      for (int entry = 0; entry < dim * dim; ++entry)
        for (int j = 0; j < m; ++j) sigma[entry * S::stress + j] += prepared.sigma[entry * m + j];
    for (std::size_t a = 0; problem == 0 && a < prepared.rest.size(); ++a)
      for (std::size_t i = 0; i < sigma.size(); ++i) sigma[i] += prepared.rest[a][i];
    std::vector<double>& values = problem == 0 ? stress_.dis : problem == 1 ? stress_.lin : stress_.reg;
    std::ranges::copy(sigma, &values[(problem == 0 ? cell : stress_.lin_block[cell]) * size]);
  }
}

/// What the iterates on a mesh share.
template <class Patch>
class MeshEquilibrator : public Equilibrator<Patch::Kind::dim>::Implementation
{
 public:
  using Kind = typename Patch::Kind;
  static constexpr int dim = Kind::dim;
  static constexpr int p = Kind::p;

  MeshEquilibrator(const contact::NitscheForm<dim>& form, int n_threads, std::vector<StressMetric> metrics)
      : form_(form),
        mesh_(form.space().mesh()),
        n_threads_(n_threads > 0 ? n_threads : max_threads()),
        metrics_(std::move(metrics)),
        body_(form),
        initial_(form),
        shapes_(mesh_, metrics_)
  {
  }

  Stress<dim> run(std::span<const double> u, typename Stress<dim>::Tractions tractions, bool with_dis,
                  std::span<const Tensor<dim>> turning) override
  {
    const FacetData<dim, p> data(form_, u, std::move(tractions));
    std::optional<VertexPartition>& partition = with_dis ? all_ : on_contact_;
    if (!partition)
    {
      std::vector<Index> vertices;
      for (Index v = 0; v < mesh_.n_vertices(); ++v)
        if (mesh_.has_patch(v) && (with_dis || data.on_contact(v))) vertices.push_back(v);
      partition = partition_vertices(mesh_, std::span<const Index>(vertices), n_threads_);
    }
    const CellSource<Kind> source{form_, u, body_, initial_, shapes_, metrics_, turning};
    Stress<dim> stress = Equilibration<Patch>(mesh_, data, source, *partition, with_dis).run();
    stress.tractions = data.tractions();
    return stress;
  }

 private:
  const contact::NitscheForm<dim>& form_;
  const mesh::Mesh<dim>& mesh_;
  int n_threads_;
  std::vector<StressMetric> metrics_;  ///< of the regions; empty: L2 everywhere
  BodyMoments<dim, p> body_;
  InitialMoments<dim, p> initial_;
  RepeatedShapes<typename Kind::Operator> shapes_;
  std::optional<VertexPartition> all_;         ///< of all vertices
  std::optional<VertexPartition> on_contact_;  ///< of those on Gamma_C
};

}  // namespace detail

template <int dim, int p>
std::unique_ptr<typename Equilibrator<dim>::Implementation> make_mesh_equilibrator(
    const contact::NitscheForm<dim>& form, int n_threads, bool by_rows, std::vector<StressMetric> metrics)
{
  if (by_rows)
    return std::make_unique<detail::MeshEquilibrator<RowPatch<dim, p>>>(form, n_threads, std::move(metrics));
  return std::make_unique<detail::MeshEquilibrator<Patch<dim, p>>>(form, n_threads, std::move(metrics));
}

}  // namespace tribound::certify
