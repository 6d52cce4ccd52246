#include "certify/equilibrate.h"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <numeric>
#include <vector>

#include "certify/patch.h"
#include "fem/quadrature.h"

namespace tribound
{

namespace
{

/// Vertices along a space-filling curve (Morton order): the cells that a stretch of it needs at a time are
/// few.
template <int dim>
std::vector<Index> vertices_by_locality(const Mesh<dim>& mesh)
{
  Point<dim> lower = mesh.vertex(0);
  Point<dim> upper = mesh.vertex(0);
  for (const Point<dim>& x : mesh.vertices())
  {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  constexpr int bits = 60 / dim;
  const double scale = ((std::uint64_t{1} << bits) - 1) / (upper - lower).maxCoeff();
  std::vector<std::uint64_t> key(mesh.n_vertices(), 0);
  for (Index v = 0; v < mesh.n_vertices(); ++v)
    for (int c = 0; c < dim; ++c)
    {
      const auto coordinate = static_cast<std::uint64_t>((mesh.vertex(v)[c] - lower[c]) * scale);
      for (int b = 0; b < bits; ++b) key[v] |= (coordinate >> b & 1) << (b * dim + c);
    }
  std::vector<Index> order(mesh.n_vertices());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index v) { return std::pair(key[v], v); });
  return order;
}

/// Moments of psi_a f on U for every vertex of every cell, or nothing where f = 0. Formulas of the case are
/// evaluated by one thread only.
template <int dim, int p>
class BodyMoments
{
 public:
  using Vector = Eigen::Matrix<double, Sizes<dim, p>::u, 1>;

  explicit BodyMoments(const NitscheForm<dim>& form)
  {
    const Mesh<dim>& mesh = form.space().mesh();
    const Quadrature<dim> rule = quadrature<dim>(data_quadrature_degree(p));
    constexpr int m = Sizes<dim, p>::multiplier;
    std::vector<double> chi(m * rule.size());
    for (int q = 0; q < rule.size(); ++q)
      orthonormal_values<dim>(p - 1, rule.points[q], std::span(chi).subspan(m * q, m));
    for (Index c = 0; c < mesh.n_cells(); ++c)
    {
      if (form.problem().body_force_is_zero(mesh.region(c))) continue;
      if (moments_.empty())
        moments_.assign(static_cast<std::size_t>(mesh.n_cells()) * (dim + 1), Vector::Zero());
      const Frame<dim> frame = make_frame(mesh, c);
      for (int q = 0; q < rule.size(); ++q)
      {
        const Point<dim>& xhat = rule.points[q];
        const Point<dim> f = form.problem().body_force(mesh.region(c), frame.origin + frame.jacobian * xhat);
        const double weight = rule.weights[q] * std::sqrt(frame.det);
        for (int a = 0; a <= dim; ++a)
        {
          const double hat = a == 0 ? 1 - xhat.sum() : xhat[a - 1];
          for (int r = 0; r < dim; ++r)
            for (int i = 0; i < m; ++i)
              moments_[c * (dim + 1) + a][r * m + i] += weight * hat * f[r] * chi[m * q + i];
        }
      }
    }
  }

  [[nodiscard]] Vector operator()(Index cell, int vertex) const
  {
    return moments_.empty() ? Vector(Vector::Zero())
                            : moments_[static_cast<std::size_t>(cell) * (dim + 1) + vertex];
  }

 private:
  std::vector<Vector, Eigen::aligned_allocator<Vector>> moments_;
};

/// What the patches leave for their cells; column 0 is dis, column 1 lin.
template <int dim, int p>
struct PatchResults
{
  using FacetColumns = Eigen::Matrix<double, Sizes<dim, p>::block, 2>;

  explicit PatchResults(const Mesh<dim>& mesh)
      : facet(mesh.topology().facets.size() * dim),
        outer(static_cast<std::size_t>(mesh.n_cells()) * (dim + 1)),
        y(mesh.n_vertices()),
        w(mesh.n_vertices())
  {
  }

  std::vector<FacetColumns, Eigen::aligned_allocator<FacetColumns>> facet;  ///< [dim * facet + its vertex]
  std::vector<FacetColumns, Eigen::aligned_allocator<FacetColumns>>
      outer;                                      ///< [(dim + 1) * cell + vertex opposite]
  std::vector<std::array<RigidField<dim>, 2>> y;  ///< y_a per vertex
  std::vector<std::array<Tensor<dim>, 2>> w;      ///< w_a per vertex
};

/// The cells that a stretch of vertices needs: prepared when first asked for, forgotten after their last
/// vertex.
template <int dim, int p>
class CellWindow
{
 public:
  CellWindow(const NitscheForm<dim>& form, std::span<const double> u, const BodyMoments<dim, p>& body)
      : form_(form), u_(u), body_(body), slot_(form.space().mesh().n_cells(), -1)
  {
  }

  const PreparedCell<dim, p>& get(Index cell)
  {
    if (slot_[cell] >= 0) return *pool_[slot_[cell]];
    if (free_.empty())
    {
      free_.push_back(static_cast<int>(pool_.size()));
      pool_.push_back(std::make_unique<PreparedCell<dim, p>>());
    }
    slot_[cell] = free_.back();
    free_.pop_back();
    PreparedCell<dim, p>& prepared = *pool_[slot_[cell]];
    prepare(cell, prepared);
    prepared.op.condense(prepared.frame);
    return prepared;
  }
  void forget(Index cell)
  {
    free_.push_back(slot_[cell]);
    slot_[cell] = -1;
  }

  /// Everything but the Schur complement.
  void prepare(Index cell, PreparedCell<dim, p>& prepared) const
  {
    const LagrangeSpace<dim>& space = form_.space();
    prepared.frame = make_frame(space.mesh(), cell);
    prepared.op.build(prepared.frame);
    prepared.sigma = discrete_stress<dim, p>(
        prepared.frame, form_.problem().material(space.mesh().region(cell)), space.cell_nodes(cell), u_);
    prepared.divergence = prepared.op.divergence(prepared.sigma);
    for (int a = 0; a <= dim; ++a) prepared.body[a] = body_(cell, a);
  }

 private:
  const NitscheForm<dim>& form_;
  std::span<const double> u_;
  const BodyMoments<dim, p>& body_;
  std::vector<int> slot_;  ///< per cell: place in pool_, or -1
  std::vector<std::unique_ptr<PreparedCell<dim, p>>> pool_;
  std::vector<int> free_;
};

/// The two passes: patches leave multipliers, cells turn them into stresses.
template <int dim, int p>
class Equilibration
{
 public:
  Equilibration(const NitscheForm<dim>& form, std::span<const double> u, std::span<const Point<dim>> t)
      : form_(form), mesh_(form.space().mesh()), u_(u), data_(form, u, t), body_(form), results_(mesh_)
  {
  }

  Stress<dim> run(int n_threads)
  {
    const std::vector<Index> order = vertices_by_locality(mesh_);
    Stress<dim> stress = empty_stress();
    std::exception_ptr failure;
#pragma omp parallel num_threads(n_threads)
    {
      const std::size_t n = omp_get_num_threads();
      const std::size_t i = omp_get_thread_num();
      try
      {
        solve_patches(std::span(order).subspan(order.size() * i / n,
                                               order.size() * (i + 1) / n - order.size() * i / n));
      }
      catch (...)
      {
#pragma omp critical
        failure = std::current_exception();
      }
#pragma omp barrier
      if (!failure) recover(stress);
    }
    if (failure) std::rethrow_exception(failure);
    return stress;
  }

 private:
  using S = Sizes<dim, p>;

  Stress<dim> empty_stress() const;
  void solve_patches(std::span<const Index> vertices);
  void store(Index vertex, const Patch<dim, p>& patch);
  void recover(Stress<dim>& stress) const;
  void recover_cell(Index cell, const PreparedCell<dim, p>& prepared, Stress<dim>& stress) const;

  const NitscheForm<dim>& form_;
  const Mesh<dim>& mesh_;
  std::span<const double> u_;
  FacetData<dim, p> data_;
  BodyMoments<dim, p> body_;
  PatchResults<dim, p> results_;
};

template <int dim, int p>
Stress<dim> Equilibration<dim, p>::empty_stress() const
{
  Stress<dim> stress;
  stress.degree = p;
  stress.n = S::stress;
  stress.dis.resize(mesh_.n_cells() * stress.block_size());
  stress.lin_place.assign(mesh_.n_cells(), -1);
  int n_lin = 0;
  for (Index c = 0; c < mesh_.n_cells(); ++c)
    if (std::ranges::any_of(mesh_.cell(c), [&](Index v) { return data_.on_contact(v); }))
      stress.lin_place[c] = n_lin++;
  stress.lin.resize(n_lin * stress.block_size());
  return stress;
}

template <int dim, int p>
void Equilibration<dim, p>::solve_patches(std::span<const Index> vertices)
{
  const Topology<dim>& topology = mesh_.topology();
  CellWindow<dim, p> window(form_, u_, body_);
  Patch<dim, p> patch(mesh_, data_);
  std::vector<std::uint8_t> visits(mesh_.n_cells(), 0);  // vertices of the stretch that still need the cell
  const auto cells_around = [&](Index v)
  {
    const auto begin = topology.vertex_cells_begin[v];
    return std::span(topology.vertex_cells).subspan(begin, topology.vertex_cells_begin[v + 1] - begin);
  };
  for (const Index v : vertices)
    for (const Index c : cells_around(v)) ++visits[c];
  for (const Index v : vertices)
  {
    patch.begin(v);
    for (const Index c : cells_around(v)) patch.add_cell(c, window.get(c));
    patch.solve();
    store(v, patch);
    for (const Index c : cells_around(v))
      if (--visits[c] == 0) window.forget(c);
  }
}

template <int dim, int p>
void Equilibration<dim, p>::store(Index vertex, const Patch<dim, p>& patch)
{
  for (std::size_t i = 0; i < patch.facets().size(); ++i)
  {
    const auto& vertices = mesh_.topology().facets[patch.facets()[i]];
    const auto v = std::ranges::find(vertices, vertex) - vertices.begin();
    results_.facet[static_cast<std::size_t>(patch.facets()[i]) * dim + v] =
        patch.multipliers(static_cast<int>(i));
  }
  for (const auto& part : patch.cells())
    results_.outer[static_cast<std::size_t>(part.cell) * (dim + 1) + part.vertex] = part.outer;
  for (int column = 0; column < 2; ++column)
  {
    results_.y[vertex][column] = patch.y(column);
    results_.w[vertex][column] = patch.w(column);
  }
}

template <int dim, int p>
void Equilibration<dim, p>::recover(Stress<dim>& stress) const
{
  const CellWindow<dim, p> window(form_, u_, body_);
  const auto prepared = std::make_unique<PreparedCell<dim, p>>();
#pragma omp for schedule(static)
  for (Index c = 0; c < mesh_.n_cells(); ++c)
  {
    window.prepare(c, *prepared);
    recover_cell(c, *prepared, stress);
  }
}

/// sigma = sum of the patch stresses of the cell's vertices: the data of the cell problem add up, psi_a to 1.
template <int dim, int p>
void Equilibration<dim, p>::recover_cell(Index cell, const PreparedCell<dim, p>& prepared,
                                         Stress<dim>& stress) const
{
  constexpr int m = S::multiplier;
  const Frame<dim>& frame = prepared.frame;
  const auto& hat = reference<dim, p>().hat_moment;
  const auto& numbers = mesh_.topology().cell_facets[cell];
  const double scale = std::sqrt(frame.det);
  for (int column = 0; column < 2; ++column)
  {
    if (column == 1 && stress.lin_place[cell] < 0) return;
    Eigen::Matrix<double, S::u, 1> r_u = Eigen::Matrix<double, S::u, 1>::Zero();
    Eigen::Matrix<double, S::rotation, 1> r_rotation = Eigen::Matrix<double, S::rotation, 1>::Zero();
    const double sign = column == 0 ? 1 : -1;
    if (column == 0) r_u = prepared.divergence;
    for (int a = 0; a <= dim; ++a)
    {
      if (column == 0) r_u += prepared.body[a];
      const RigidField<dim>& y = results_.y[frame.vertices[a]][column];
      for (int v = 0; v <= dim; ++v)
      {
        const Point<dim> value =
            y.translation + y.gradient * (mesh_.vertex(frame.vertices[v]) - mesh_.vertex(frame.vertices[a]));
        for (int r = 0; r < dim; ++r) r_u.template segment<m>(r * m) += sign * scale * value[r] * hat.col(v);
      }
      if (p == 1)
        for (int i = 0; i < S::pairs; ++i)
          r_rotation[i] -=
              2 * results_.w[frame.vertices[a]][column](skew_pairs<dim>[i][0], skew_pairs<dim>[i][1]) *
              scale * hat.row(0).sum();
    }

    typename CellOperator<dim, p>::FacetVectors mu;
    for (int f = 0; f <= dim; ++f)
    {
      mu[f] = results_.outer[static_cast<std::size_t>(cell) * (dim + 1) + f].col(column);
      const auto facet = static_cast<std::size_t>(numbers[frame.local[f]]);
      for (int v = 0; v < dim; ++v) mu[f] += results_.facet[facet * dim + v].col(column);
    }
    StressCoefficients<dim, p> sigma = prepared.op.correction(frame, r_u, r_rotation, mu);
    if (column == 0) sigma.template topRows<m>() += prepared.sigma;
    double* const target = column == 0 ? &stress.dis[cell * stress.block_size()]
                                       : &stress.lin[stress.lin_place[cell] * stress.block_size()];
    std::copy_n(sigma.data(), sigma.size(), target);
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
