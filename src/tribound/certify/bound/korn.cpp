#include "tribound/certify/bound/korn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/poincare_korn.h"
#include "tribound/contact/nitsche/rigid_modes.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// S(x) = sum_i C_i^2 (1 / |F_i| + |x - c_i|^2 / I_i) over the facets on the path from the root of a body to
/// a cell.
template <int dim>
struct PathSum
{
  double square = 0;                       ///< of |x|^2
  Point<dim> linear = Point<dim>::Zero();  ///< of -2 x
  double constant = 0;

  void add(double weight, double measure, double inertia, const Point<dim>& centre)
  {
    square += weight / inertia;
    linear += weight / inertia * centre;
    constant += weight * (1 / measure + centre.squaredNorm() / inertia);
  }

  /// From above, rounding included.
  [[nodiscard]] double at(const Point<dim>& x) const
  {
    constexpr double rounding = 1e-12;
    const double size = square * x.squaredNorm() + constant + 2 * linear.norm() * x.norm();
    return square * x.squaredNorm() - 2 * linear.dot(x) + constant + rounding * size;
  }

  template <std::size_t n>
  [[nodiscard]] double largest(const std::array<Point<dim>, n>& points) const  // S is convex
  {
    double result = 0;
    for (const Point<dim>& x : points) result = std::max(result, at(x));
    return result;
  }
};

/// The smallest moment of inertia of a facet about an axis through its centre, and the centre.
template <int dim>
std::pair<double, Point<dim>> inertia(const std::array<Point<dim>, dim>& facet, double measure)
{
  Point<dim> centre = Point<dim>::Zero();
  for (const Point<dim>& x : facet) centre += x / dim;
  double trace = 0;
  for (const Point<dim>& x : facet) trace += (x - centre).squaredNorm() * measure / (dim * (dim + 1));
  if constexpr (dim == 2) return {trace, centre};
  const double product = std::pow(measure, 4) / 108;  // of both moments in the plane
  return {2 * product / (trace + std::sqrt(std::max(0.0, trace * trace - 4 * product))), centre};
}

/// Integrals of the products of columns, functions of degree 1 with these values at the vertices of a
/// simplex.
template <class Matrix, std::size_t n>
Eigen::MatrixXd products(const std::array<Matrix, n>& values, double measure)
{
  Matrix sum = values[0];
  Eigen::MatrixXd result = values[0].transpose() * values[0];
  for (std::size_t i = 1; i < n; ++i)
  {
    sum += values[i];
    result += values[i].transpose() * values[i];
  }
  return measure / static_cast<double>(n * (n + 1)) * (result + sum.transpose() * sum);
}

/// What the cells of a body add up to.
template <int dim>
struct BodySums
{
  static constexpr int n_modes = contact::RigidModes<dim>::n_modes;

  double cell = 0;    ///< the largest C_V
  double trace = 0;   ///< the largest sum over the fixed facets of a cell of the squares of C_tr
  double volume = 0;  ///< sum_T |T| max S
  double fixed = 0;   ///< sum_F |F| max S over fixed facets
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n_modes, n_modes);   ///< (z_i, z_j)
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(n_modes, n_modes);  ///< of fixed components, on Gamma_D

  [[nodiscard]] double constant() const
  {
    const Eigen::MatrixXd lower = CholeskyFactors(all).lower();
    const Eigen::MatrixXd half = solve_lower(lower, held);
    const double least = symmetric_eigen(solve_lower(lower, half.transpose())).values[0];
    constexpr double rounding = 1e-10;
    if (!(least > rounding * held.trace() / all.trace())) return std::numeric_limits<double>::infinity();
    constexpr double chains = 2 * (dim + 2);  // sum_i (C_i^{-1} ||jump||_i)^2 <= chains ||eps(w)||^2
    return cell + std::sqrt(chains * volume) +
           (std::sqrt(trace) + std::sqrt(chains * fixed)) / std::sqrt(least);
  }
};

template <int dim>
class BodyConstants
{
 public:
  BodyConstants(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
      : problem_(problem),
        mesh_(mesh),
        bodies_(mesh::number_bodies(mesh)),
        paths_(mesh.n_cells()),
        sums_(bodies_.n)
  {
    const auto box = mesh::bounding_box(mesh.vertices());
    modes_.centre = (box.lower + box.upper) / 2;
    modes_.size = box.diagonal();
    constants_.reserve(mesh.n_cells());
    for (Index c = 0; c < mesh.n_cells(); ++c) constants_.push_back(poincare_korn<dim>(points(c)));
    walk();
    for (Index c = 0; c < mesh.n_cells(); ++c) add_cell(c);
    add_fixed_facets();
  }

  [[nodiscard]] double largest() const
  {
    double result = 0;
    for (const BodySums<dim>& body : sums_) result = std::max(result, body.constant());
    return result;
  }

 private:
  [[nodiscard]] std::array<Point<dim>, dim + 1> points(Index cell) const
  {
    return mesh::points_of(mesh_.vertices(), mesh_.cell(cell));
  }

  [[nodiscard]] bool is_fixed(const mesh::BoundaryFacet& facet) const
  {
    return problem_.boundary(facet.tag).clamps_any();
  }

  /// Paths from cell to cell, the shortest from a cell at Gamma_D.
  void walk()
  {
    std::vector<Index> reached;
    std::vector<char> has_root(bodies_.n, 0);
    std::vector<char> is_reached(mesh_.n_cells(), 0);
    for (const mesh::BoundaryFacet& facet : mesh_.boundary())
    {
      char& is_known = has_root[bodies_.of_cell[facet.cell]];
      if (is_known || !is_fixed(facet)) continue;
      is_known = is_reached[facet.cell] = 1;
      reached.push_back(facet.cell);
    }
    const auto& topology = mesh_.topology();
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (const Index facet : topology.cell_facets[reached[k]])
        for (const Index next : topology.facet_cells[facet])
        {
          if (next < 0 || is_reached[next]) continue;
          is_reached[next] = 1;
          reached.push_back(next);
          step(reached[k], next, facet);
        }
  }

  /// r_T - r_T' of neighbours T and T' is at most C_tr(T) ||eps||_T + C_tr(T') ||eps||_T' on their facet.
  void step(Index from, Index to, Index facet)
  {
    const auto& topology = mesh_.topology();
    const double jump = std::max(constants_[from].traces[topology.local_facet(from, facet)],
                                 constants_[to].traces[topology.local_facet(to, facet)]);
    const double measure = mesh::facet_geometry(mesh_, to, topology.local_facet(to, facet)).measure;
    const auto [moment, centre] =
        inertia<dim>(mesh::points_of(mesh_.vertices(), topology.facets[facet]), measure);
    paths_[to] = paths_[from];
    paths_[to].add(jump * jump, measure, moment, centre);
  }

  void add_cell(Index c)
  {
    BodySums<dim>& body = sums_[bodies_.of_cell[c]];
    const auto x = points(c);
    const double measure = mesh::cell_map(mesh_, c).measure();
    body.cell = std::max(body.cell, constants_[c].cell);
    body.volume += measure * paths_[c].largest(x);
    body.all += products(modes_at(x), measure);
  }

  void add_fixed_facets()
  {
    std::vector<double> traces(mesh_.n_cells(), 0.0);
    for (const mesh::BoundaryFacet& facet : mesh_.boundary())
    {
      if (!is_fixed(facet)) continue;
      BodySums<dim>& body = sums_[bodies_.of_cell[facet.cell]];
      const auto vertices = mesh::facet_vertices(mesh_.cell(facet.cell), facet.local);
      const auto x = mesh::points_of(mesh_.vertices(), vertices);
      const double measure = mesh::facet_geometry(mesh_, facet.cell, facet.local).measure;
      traces[facet.cell] += std::pow(constants_[facet.cell].traces[facet.local], 2);
      body.trace = std::max(body.trace, traces[facet.cell]);
      body.fixed += measure * paths_[facet.cell].largest(x);
      auto modes = modes_at(x);
      for (int a = 0; a < dim; ++a)
        if (!problem_.boundary(facet.tag).clamps(a))
          for (auto& at_vertex : modes) at_vertex.row(a).setZero();
      body.held += products(modes, measure);
    }
  }

  template <std::size_t n>
  [[nodiscard]] std::array<typename contact::RigidModes<dim>::ModeMatrix, n> modes_at(
      const std::array<Point<dim>, n>& x) const
  {
    std::array<typename contact::RigidModes<dim>::ModeMatrix, n> result;
    for (std::size_t i = 0; i < n; ++i) result[i] = modes_.at(x[i]);
    return result;
  }

  const problem::Problem<dim>& problem_;
  const mesh::Mesh<dim>& mesh_;
  mesh::Bodies bodies_;
  contact::RigidModes<dim> modes_;
  std::vector<PoincareKorn<dim>> constants_;
  std::vector<PathSum<dim>> paths_;
  std::vector<BodySums<dim>> sums_;
};

}  // namespace

template <int dim>
double korn_constant(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  constexpr int resolved = 3;  // p + 2 for p = 1: rules integrate loads of such degrees
  if (std::max(problem.load_degree(), problem.spring_load_degree()) <= resolved) return 0;
  return mesh.partition() ? std::numeric_limits<double>::infinity()
                          : BodyConstants<dim>(problem, mesh).largest();
}

template double korn_constant(const problem::Problem<2>&, const mesh::Mesh<2>&);
template double korn_constant(const problem::Problem<3>&, const mesh::Mesh<3>&);

}  // namespace tribound::certify
