#include "certify/equilibrate.h"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "certify/cell_window.h"
#include "certify/patch.h"

namespace tribound
{

namespace
{

/// Vertices along a space-filling curve (Morton order): the cells that a stretch of it needs at a time are
/// few.
template <int dim>
std::vector<Index> vertices_by_locality(const Mesh<dim>& mesh, int n_threads)
{
  Point<dim> lower = mesh.vertex(0);
  Point<dim> upper = mesh.vertex(0);
  for (const Point<dim>& x : mesh.vertices())
  {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  constexpr int bits = 20;
  const double scale = ((std::uint64_t{1} << bits) - 1) / (upper - lower).maxCoeff();
  std::vector<std::pair<std::uint64_t, Index>> keys(mesh.n_vertices());
#pragma omp parallel for num_threads(n_threads)
  for (Index v = 0; v < mesh.n_vertices(); ++v)
  {
    keys[v] = {0, v};
    for (int c = 0; c < dim; ++c)
    {
      const auto coordinate = static_cast<std::uint64_t>((mesh.vertex(v)[c] - lower[c]) * scale);
      for (int b = 0; b < bits; ++b) keys[v].first |= (coordinate >> b & 1) << (b * dim + c);
    }
  }
  std::ranges::sort(keys);
  std::vector<Index> order(mesh.n_vertices());
  std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
  return order;
}

/// The patches write their shares into the cells, and a cell with all of them gives its stress. Every thread
/// has a stretch of the vertices; cells with vertices in several of them come last.
template <int dim, int p>
class Equilibration
{
 public:
  Equilibration(const NitscheForm<dim>& form, std::span<const double> u, std::span<const Point<dim>> t)
      : mesh_(form.space().mesh()),
        data_(form, u, t),
        body_(form),
        shapes_(mesh_),
        source_{form, u, body_, shapes_}
  {
  }

  Stress<dim> run(int n_threads)
  {
    prepare_stress();
    divide(n_threads);
    in_parallel(n_threads, [&](int stretch) { solve_patches(stretch); });
    in_parallel(n_threads, [&](int stretch) { recover_shared_cells(stretch, n_threads); });
    return std::move(stress_);
  }

 private:
  using S = Sizes<dim, p>;
  using Window = CellWindow<dim, p>;
  using Shares = typename Window::Shares;

  void prepare_stress();
  void divide(int n_stretches);
  template <class Work>
  void in_parallel(int n_threads, Work work);
  void solve_patches(int stretch);
  void recover_shared_cells(int stretch, int n_stretches);
  void recover(Index cell, const PreparedCell<dim, p>& prepared, const Shares& shares);

  const Mesh<dim>& mesh_;
  FacetData<dim, p> data_;
  BodyMoments<dim, p> body_;
  RepeatedShapes<dim, p> shapes_;
  CellSource<dim, p> source_;
  Stress<dim> stress_;
  std::vector<Index> order_;         ///< of the vertices
  std::vector<std::size_t> begin_;   ///< of the stretches in order_
  std::vector<int> stretch_;         ///< per vertex
  std::vector<Index> shared_cells_;  ///< with vertices in several stretches
  std::vector<int> shared_place_;    ///< per cell: place in shared_cells_ and shares_, or -1
  std::vector<Shares> shares_;
};

template <int dim, int p>
void Equilibration<dim, p>::prepare_stress()
{
  stress_.degree = p;
  stress_.n = S::stress;
  stress_.dis.resize(mesh_.n_cells() * stress_.block_size());
  stress_.lin_place.assign(mesh_.n_cells(), -1);
  int n_lin = 0;
  for (Index c = 0; c < mesh_.n_cells(); ++c)
    if (std::ranges::any_of(mesh_.cell(c), [&](Index v) { return data_.on_contact(v); }))
      stress_.lin_place[c] = n_lin++;
  stress_.lin.resize(n_lin * stress_.block_size());
}

template <int dim, int p>
void Equilibration<dim, p>::divide(int n_stretches)
{
  order_ = vertices_by_locality(mesh_, n_stretches);
  stretch_.resize(mesh_.n_vertices());
  for (int s = 0; s <= n_stretches; ++s) begin_.push_back(order_.size() * s / n_stretches);
  for (int s = 0; s < n_stretches; ++s)
    for (std::size_t i = begin_[s]; i < begin_[s + 1]; ++i) stretch_[order_[i]] = s;
  shared_place_.assign(mesh_.n_cells(), -1);
  for (Index c = 0; c < mesh_.n_cells(); ++c)
  {
    const Cell<dim>& cell = mesh_.cell(c);
    if (std::ranges::all_of(cell, [&](Index v) { return stretch_[v] == stretch_[cell[0]]; })) continue;
    shared_place_[c] = static_cast<int>(shared_cells_.size());
    shared_cells_.push_back(c);
  }
  shares_.resize(shared_cells_.size());
}

/// Calls work(i) for i < n_threads; throws what one of them threw.
template <int dim, int p>
template <class Work>
void Equilibration<dim, p>::in_parallel(int n_threads, Work work)
{
  std::exception_ptr failure;
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
  for (int i = 0; i < n_threads; ++i) try
    {
      work(i);
    }
    catch (...)
    {
#pragma omp critical
      failure = std::current_exception();
    }
  if (failure) std::rethrow_exception(failure);
}

template <int dim, int p>
void Equilibration<dim, p>::solve_patches(int stretch)
{
  const Topology<dim>& topology = mesh_.topology();
  const auto in_stretch = [&](Index v) { return stretch_[v] == stretch; };
  Window window(source_);
  Patch<dim, p> patch(mesh_, data_);
  for (std::size_t i = begin_[stretch]; i < begin_[stretch + 1]; ++i)
  {
    const Index v = order_[i];
    const auto begin = topology.vertex_cells_begin[v];
    const auto cells =
        std::span(topology.vertex_cells).subspan(begin, topology.vertex_cells_begin[v + 1] - begin);
    patch.begin(v);
    for (const Index c : cells)
    {
      auto& slot = window.get(c);
      if (slot.waiting == 0)
        slot.waiting = static_cast<int>(std::ranges::count_if(mesh_.cell(c), in_stretch));
      Shares& shares = shared_place_[c] < 0 ? slot.shares : shares_[shared_place_[c]];
      patch.add_cell(c, slot.cell, shares[slot.cell.frame.find(v)]);
    }
    patch.solve();
    for (const Index c : cells)
    {
      auto& slot = window.get(c);
      if (--slot.waiting > 0) continue;
      if (shared_place_[c] < 0) recover(c, slot.cell, slot.shares);
      window.forget(c);
    }
  }
}

template <int dim, int p>
void Equilibration<dim, p>::recover_shared_cells(int stretch, int n_stretches)
{
  const auto prepared = std::make_unique<PreparedCell<dim, p>>();
  for (std::size_t i = stretch; i < shared_cells_.size(); i += n_stretches)
  {
    source_.prepare(shared_cells_[i], *prepared, false);
    recover(shared_cells_[i], *prepared, shares_[i]);
  }
}

/// sigma = sum of the patch stresses of the cell's vertices: the data of the cell problem add up, psi_a to 1.
template <int dim, int p>
void Equilibration<dim, p>::recover(Index cell, const PreparedCell<dim, p>& prepared, const Shares& shares)
{
  constexpr int m = S::multiplier;
  const Frame<dim>& frame = prepared.frame;
  for (int problem = 0; problem < 2; ++problem)
  {
    if (problem == 1 && stress_.lin_place[cell] < 0) return;
    DenseVector<S::u> r_u;
    if (problem == 0) r_u = prepared.divergence;
    Tensor<dim> w = Tensor<dim>::Zero();
    typename CellOperator<dim, p>::FacetVectors mu;
    for (int a = 0; a <= dim; ++a)
    {
      if (problem == 0) add_multiple(r_u, 1, prepared.body[a]);
      if (problem == 1 && !data_.on_contact(frame.vertices[a])) continue;
      const CellShare<dim, p>& share = shares[a][problem];
      add_moments(r_u, prepared, a, share.y, problem == 0 ? 1 : -1);
      w += share.w;
      add_multiple(mu, 1, share.mu);
    }
    StressCoefficients<dim, p> sigma = prepared.op->correction(frame, r_u, w, mu);
    if (problem == 0)
      for (int entry = 0; entry < dim * dim; ++entry)
        for (int j = 0; j < m; ++j) sigma[entry * S::stress + j] += prepared.sigma[entry * m + j];
    std::ranges::copy(sigma, problem == 0 ? &stress_.dis[cell * stress_.block_size()]
                                          : &stress_.lin[stress_.lin_place[cell] * stress_.block_size()]);
  }
}

}  // namespace

template <int dim>
Stress<dim> equilibrate(const NitscheForm<dim>& form, std::span<const double> u,
                        std::span<const Point<dim>> t, int n_threads)
{
  if (n_threads == 0) n_threads = omp_get_max_threads();
  switch (form.space().degree())
  {
    case 1:
      return Equilibration<dim, 1>(form, u, t).run(n_threads);
    case 2:
      return Equilibration<dim, 2>(form, u, t).run(n_threads);
    case 3:
      return Equilibration<dim, 3>(form, u, t).run(n_threads);
    default:
      return Equilibration<dim, 4>(form, u, t).run(n_threads);
  }
}

template Stress<2> equilibrate(const NitscheForm<2>&, std::span<const double>, std::span<const Point<2>>,
                               int);
template Stress<3> equilibrate(const NitscheForm<3>&, std::span<const double>, std::span<const Point<3>>,
                               int);

}  // namespace tribound
