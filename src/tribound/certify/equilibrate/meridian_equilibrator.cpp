#include "tribound/certify/equilibrate/meridian_equilibrator.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/base/parallel.h"
#include "tribound/certify/equilibrate/meridian_patch.h"
#include "tribound/certify/equilibrate/vertex_partition.h"

namespace tribound::certify
{

namespace
{

/// The stress of one iterate. Patches leave their stresses by cell and vertex; then every cell adds up those
/// of its vertices in one order, whichever threads they came from.
class MeridianEquilibration
{
 public:
  MeridianEquilibration(const mesh::Mesh<2>& mesh, const MeridianCellSource& source,
                        const MeridianFacets& facets, const VertexPartition& partition,
                        std::span<const double> u, std::span<const Tensor<2>> turning, bool with_dis)
      : mesh_(mesh),
        source_(source),
        facets_(facets),
        partition_(partition),
        u_(u),
        turning_(turning),
        first_part_(with_dis ? 0 : 1)
  {
  }

  Stress<2> run()
  {
    prepare_stress();
    in_threads(partition_.size(), [&](int thread) { solve_patches(thread); });
    add_up();
    return std::move(stress_);
  }

 private:
  void prepare_stress();
  void solve_patches(int thread);
  void add_up();

  [[nodiscard]] std::span<const Index> cells_around(Index vertex) const
  {
    const mesh::Topology<2>& topology = mesh_.topology();
    const Index begin = topology.vertex_cells_begin[vertex];
    return std::span(topology.vertex_cells).subspan(begin, topology.vertex_cells_begin[vertex + 1] - begin);
  }
  [[nodiscard]] std::vector<double>& values(int part)
  {
    return part == 0 ? stress_.dis : part == 1 ? stress_.lin : stress_.reg;
  }
  [[nodiscard]] MeridianCell prepare(Index cell) const
  {
    return source_.prepare(cell, u_,
                           turning_.empty() ? turning_ : turning_.subspan(std::size_t{3} * cell, 3));
  }
  /// The number of the cell among those that have the part.
  [[nodiscard]] std::size_t block(int part, Index cell) const
  {
    return part == 0 ? cell : stress_.lin_block[cell];
  }
  /// Where the patch of a vertex leaves its stress; nowhere for ghosts, whose other patches are elsewhere.
  [[nodiscard]] std::span<double> share(int part, Index cell, int vertex)
  {
    if (cell >= mesh_.n_owned_cells()) return {};
    const std::size_t size = stress_.block_size();
    return std::span(shares_[part]).subspan((3 * block(part, cell) + vertex) * size, size);
  }

  const mesh::Mesh<2>& mesh_;
  const MeridianCellSource& source_;
  const MeridianFacets& facets_;
  const VertexPartition& partition_;
  const std::span<const double> u_;
  const std::span<const Tensor<2>> turning_;  ///< K_{T,a}, or empty
  const int first_part_;
  Stress<2> stress_;
  std::array<std::vector<double>, 3> shares_;  ///< of each part
};

void MeridianEquilibration::prepare_stress()
{
  stress_.n = source_.reference().n_stress;
  stress_.degree = source_.reference().n_facet - 1;
  stress_.patches = source_.is_by_rows() ? PatchStress::rows : PatchStress::afw;
  stress_.lin_block.assign(mesh_.n_owned_cells(), -1);
  int n_lin = 0;
  for (Index c = 0; c < mesh_.n_owned_cells(); ++c)
    if (std::ranges::any_of(mesh_.cell(c), [&](Index v) { return facets_.on_contact(v); }))
      stress_.lin_block[c] = n_lin++;
  for (int part = first_part_; part < facets_.n_parts(); ++part)
  {
    values(part).resize((part == 0 ? mesh_.n_owned_cells() : n_lin) * stress_.block_size());
    shares_[part].resize(3 * values(part).size());
  }
}

/// A thread keeps the cells that its vertices still need.
void MeridianEquilibration::solve_patches(int thread)
{
  std::vector<std::unique_ptr<MeridianCell>> prepared(mesh_.n_cells());
  std::vector<std::uint8_t> waiting(mesh_.n_cells(), 0);  // vertices of the thread that need the cell
  const std::span<const Index> vertices =
      std::span(partition_.order)
          .subspan(partition_.begin[thread], partition_.begin[thread + 1] - partition_.begin[thread]);
  for (const Index v : vertices)
    for (const Index c : cells_around(v)) ++waiting[c];
  std::vector<MeridianPatchCell> cells;
  for (const Index v : vertices)
  {
    const int end_part = facets_.on_contact(v) ? facets_.n_parts() : 1;
    cells.clear();
    for (const Index c : cells_around(v))
    {
      if (!prepared[c]) prepared[c] = std::make_unique<MeridianCell>(prepare(c));
      MeridianPatchCell& cell = cells.emplace_back(c, prepared[c].get());
      for (int part = first_part_; part < end_part; ++part)
        cell.stress[part] = share(part, c, prepared[c]->sorted.find(v));
    }
    solve_meridian_patch(mesh_, source_.reference(), facets_, v, first_part_, end_part, cells,
                         source_.is_by_rows());
    for (const Index c : cells_around(v))
      if (--waiting[c] == 0) prepared[c].reset();
  }
}

void MeridianEquilibration::add_up()
{
  const std::size_t size = stress_.block_size();
  for (int part = first_part_; part < facets_.n_parts(); ++part)
    parallel_for(values(part).size() / size,
                 [&](std::size_t block)
                 {
                   const double* const shares = &shares_[part][3 * block * size];
                   double* const sum = &values(part)[block * size];
                   for (std::size_t i = 0; i < size; ++i)
                     sum[i] = shares[i] + shares[size + i] + shares[2 * size + i];
                 });
}

class MeridianEquilibrator : public Equilibrator<2>::Implementation
{
 public:
  MeridianEquilibrator(const contact::NitscheForm<2>& form, int n_threads, bool by_rows,
                       std::vector<StressMetric> metrics)
      : form_(form),
        source_(form, by_rows, std::move(metrics)),
        n_threads_(n_threads > 0 ? n_threads : max_threads())
  {
  }

  Stress<2> run(std::span<const double> u, Stress<2>::Tractions tractions, bool with_dis,
                std::span<const Tensor<2>> turning) override
  {
    assert(turning.empty() || !source_.is_by_rows());
    const mesh::Mesh<2>& mesh = form_.space().mesh();
    const MeridianFacets facets(form_, source_.reference(), u, std::move(tractions));
    std::optional<VertexPartition>& partition = with_dis ? all_ : on_contact_;
    if (!partition)
    {
      std::vector<Index> vertices;
      for (Index v = 0; v < mesh.n_vertices(); ++v)
        if (mesh.has_patch(v) && (with_dis || facets.on_contact(v))) vertices.push_back(v);
      partition = partition_vertices(mesh, std::span<const Index>(vertices), n_threads_);
    }
    Stress<2> stress = MeridianEquilibration(mesh, source_, facets, *partition, u, turning, with_dis).run();
    stress.tractions = facets.tractions();
    return stress;
  }

 private:
  const contact::NitscheForm<2>& form_;
  MeridianCellSource source_;
  int n_threads_;
  std::optional<VertexPartition> all_;         ///< of all vertices
  std::optional<VertexPartition> on_contact_;  ///< of those on Gamma_C
};

}  // namespace

std::unique_ptr<Equilibrator<2>::Implementation> make_meridian_equilibrator(
    const contact::NitscheForm<2>& form, int n_threads, bool by_rows, std::vector<StressMetric> metrics)
{
  return std::make_unique<MeridianEquilibrator>(form, n_threads, by_rows, std::move(metrics));
}

}  // namespace tribound::certify
