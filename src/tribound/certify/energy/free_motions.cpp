#include "tribound/certify/energy/free_motions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tribound/base/dense_factors.h"
#include "tribound/contact/support/holds.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

template <int dim>
constexpr int n_modes = contact::RigidModes<dim>::n_modes;

/// The rigid modes of each body, about the centre of its bounding box and scaled by its diagonal.
template <int dim>
std::vector<contact::RigidModes<dim>> modes_of(const mesh::Mesh<dim>& mesh, const mesh::Bodies& bodies)
{
  // largest x and -x of each body
  std::vector<double> corners(static_cast<std::size_t>(bodies.n) * 2 * dim,
                              -std::numeric_limits<double>::infinity());
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
    for (const Index v : mesh.cell(c))
      for (int a = 0; a < dim; ++a)
      {
        double* const corner = &corners[(static_cast<std::size_t>(bodies.of_cell[c]) * dim + a) * 2];
        corner[0] = std::max(corner[0], mesh.vertex(v)[a]);
        corner[1] = std::max(corner[1], -mesh.vertex(v)[a]);
      }
  mesh.ranks().max(std::span(corners));
  std::vector<contact::RigidModes<dim>> modes(bodies.n);
  for (int b = 0; b < bodies.n; ++b)
  {
    const Eigen::Map<const Eigen::Matrix<double, 2, dim>> corner(
        &corners[static_cast<std::size_t>(b) * dim * 2]);
    modes[b].centre = (corner.row(0) - corner.row(1)).transpose() / 2;
    modes[b].size = (corner.row(0) + corner.row(1)).norm();
  }
  return modes;
}

/// Per body the sum of r r^T over the rows r of for_each_hold().
template <int dim>
std::vector<double> fixed_grams(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                const mesh::Bodies& bodies, std::span<const contact::RigidModes<dim>> modes)
{
  constexpr int n = n_modes<dim>;
  std::vector<double> grams(static_cast<std::size_t>(bodies.n) * n * n, 0.0);
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const auto& boundary = problem.boundary(facet.tag);
    if (!boundary.holds_any()) continue;
    const int body = bodies.of_cell[facet.cell];
    Eigen::Map<Eigen::Matrix<double, n, n>> gram(&grams[static_cast<std::size_t>(body) * n * n]);
    contact::for_each_hold(boundary, mesh, facet, modes[body],
                           [&](const auto& rows) { gram += rows.transpose() * rows; });
  }
  mesh.ranks().sum(std::span(grams));
  return grams;
}

/// The modes that have no strain: all of a plane or solid body, of a body of revolution the translation along
/// its axis.
template <int dim>
std::vector<int> rigid_modes(const problem::Problem<dim>& problem)
{
  if (problem.is_axisymmetric()) return {1};
  std::vector<int> all(n_modes<dim>);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

template <int dim>
FreeMotions<dim>::FreeMotions(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
    : bodies_(mesh::number_bodies(mesh))
{
  constexpr int n = n_modes<dim>;
  constexpr double rounding = 1e-14;  // of eigenvalues, relative to the largest
  constexpr double held = 1e-10;      // motions with larger eigenvalues are stopped
  const std::vector<Modes> modes = modes_of(mesh, bodies_);
  const std::vector<double> grams = fixed_grams<dim>(problem, mesh, bodies_, modes);
  const std::vector<int> rigid = rigid_modes(problem);
  begin_.push_back(0);
  for (int b = 0; b < bodies_.n; ++b)
  {
    const Eigen::Map<const Eigen::Matrix<double, n, n>> gram(&grams[static_cast<std::size_t>(b) * n * n]);
    const SymmetricEigen eigen = symmetric_eigen(gram(rigid, rigid));
    // also where nothing but rounding acts along the axis
    const double largest = symmetric_eigen(gram).values[n - 1];
    for (Eigen::Index i = 0; i < std::ssize(rigid) && eigen.values[i] <= held * largest; ++i)
    {
      is_unclear_ = is_unclear_ || eigen.values[i] > rounding * largest;
      modes_.push_back(modes[b]);
      motions_.push_back(Modes::Coefficients::Zero());
      motions_.back()(rigid) = eigen.vectors.col(i);
    }
    begin_.push_back(static_cast<int>(motions_.size()));
  }
}

namespace
{

/// A row of the matrix of the motions of a body (one row for each degree of freedom), or its part orthogonal
/// to the rows chosen so far.
template <int dim>
using MotionRow = Eigen::Matrix<double, n_modes<dim>, 1>;

/// The best row on this rank, for each body.
template <int dim>
struct Candidate
{
  MotionRow<dim> rest = MotionRow<dim>::Zero();
  double length = 0;
  Index own = -1;
};

/// Whether this rank is the lowest of those with the largest length, for each body.
template <int dim>
std::vector<char> is_here(const Ranks& ranks, std::span<const Candidate<dim>> candidates)
{
  std::vector<double> lengths(candidates.size());
  for (std::size_t b = 0; b < candidates.size(); ++b) lengths[b] = candidates[b].length;
  ranks.max(std::span(lengths));
  std::vector<double> minus_rank(candidates.size());
  for (std::size_t b = 0; b < candidates.size(); ++b)
    minus_rank[b] = candidates[b].length == lengths[b] ? -ranks.rank() : -ranks.size();
  ranks.max(std::span(minus_rank));
  std::vector<char> here(candidates.size());
  for (std::size_t b = 0; b < candidates.size(); ++b) here[b] = minus_rank[b] == -ranks.rank() ? 1 : 0;
  return here;
}

/// The body of each node of this rank.
template <int dim>
std::vector<int> bodies_of_nodes(const fem::LagrangeSpace<dim>& space, const FreeMotions<dim>& motions)
{
  std::vector<int> result(space.n_nodes(), 0);
  for (Index c = 0; c < space.mesh().n_cells(); ++c)
    for (const Index node : space.cell_nodes(c)) result[node] = motions.body_of(c);
  return result;
}

/// The best rows of this rank; `chosen` are those that each body has. None for a body with as many as
/// motions.
template <int dim>
std::vector<Candidate<dim>> best_rows(const FreeMotions<dim>& motions, const fem::LagrangeSpace<dim>& space,
                                      std::span<const char> fixed, std::span<const Point<dim>> points,
                                      std::span<const int> bodies,
                                      std::span<const std::vector<MotionRow<dim>>> chosen)
{
  std::vector<Candidate<dim>> candidates(chosen.size());
  for (Index own = 0; own < space.n_owned_nodes(); ++own)
  {
    const Index node = space.owned_node(own);
    const int body = bodies[node];
    const auto [begin, end] = motions.of_body(body);
    if (std::ssize(chosen[body]) >= end - begin) continue;
    Eigen::Matrix<double, dim, n_modes<dim>> rows = Eigen::Matrix<double, dim, n_modes<dim>>::Zero();
    for (int i = begin; i < end; ++i) rows.col(i - begin) = motions(i, points[node]);
    for (const MotionRow<dim>& unit : chosen[body]) rows -= rows * unit * unit.transpose();
    for (int a = 0; a < dim; ++a)
      if (const double length = rows.row(a).norm();
          fixed[dim * node + a] == 0 && length > candidates[body].length)
        candidates[body] = {rows.row(a).transpose(), length, dim * own + a};
  }
  return candidates;
}

}  // namespace

/// Gram-Schmidt orthogonalisation; takes the longest remainder first.
template <int dim>
std::vector<Index> FreeMotions<dim>::supports(const fem::LagrangeSpace<dim>& space,
                                              std::span<const char> fixed) const
{
  constexpr int n = n_modes<dim>;
  const Ranks& ranks = space.mesh().ranks();
  const std::vector<Point<dim>> points = space.node_points();
  const std::vector<int> bodies = bodies_of_nodes(space, *this);
  std::vector<std::vector<MotionRow<dim>>> chosen(bodies_.n);
  std::vector<Index> result;
  int most = 0;
  for (int b = 0; b < bodies_.n; ++b) most = std::max(most, of_body(b).size());
  for (int step = 0; step < most; ++step)
  {
    const std::vector<Candidate<dim>> candidates =
        best_rows<dim>(*this, space, fixed, points, bodies, chosen);
    const std::vector<char> here = is_here<dim>(ranks, candidates);
    std::vector<double> units(static_cast<std::size_t>(bodies_.n) * n, 0.0);
    const auto unit_of = [&](int b)
    { return Eigen::Map<MotionRow<dim>>(&units[static_cast<std::size_t>(b) * n]); };
    for (int b = 0; b < bodies_.n; ++b)
    {
      if (here[b] == 0 || candidates[b].own < 0) continue;
      result.push_back(candidates[b].own);
      unit_of(b) = candidates[b].rest / candidates[b].length;
    }
    ranks.sum(std::span(units));
    for (int b = 0; b < bodies_.n; ++b)
      if (step < of_body(b).size()) chosen[b].push_back(unit_of(b));
  }
  return result;
}

template class FreeMotions<2>;
template class FreeMotions<3>;

}  // namespace tribound::certify
