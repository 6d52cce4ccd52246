#include "tribound/certify/truth/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/truth/solution_error.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// Computed distances and bounds have rounding errors below this part of themselves.
constexpr double rounding = 1e-10;
/// The part of d^2 that the core of the error has.
constexpr double core_part = 0.9;
/// Without it half of d is left.
constexpr double halving_part = 0.75;

/// The cells in the order of their distances, the largest first, as many as have this part of the square.
std::vector<Index> largest(std::span<const double> cells, double part)
{
  std::vector<Index> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order,
                    [&](Index a, Index b) { return cells[a] != cells[b] ? cells[a] > cells[b] : a < b; });
  double rest = part * std::transform_reduce(cells.begin(), cells.end(), 0.0, std::plus<>(),
                                             [](double d) { return d * d; });
  std::size_t n = 0;
  for (; n < order.size() && rest > 0; ++n) rest -= cells[order[n]] * cells[order[n]];
  order.resize(n);
  return order;
}

template <int dim>
double volume_of(const mesh::Mesh<dim>& mesh, Index cell)
{
  return mesh::cell_map(mesh, cell).det / (dim == 2 ? 2 : 6);
}

template <int dim>
Point<dim> centre_of(const mesh::Mesh<dim>& mesh, Index cell)
{
  Point<dim> centre = Point<dim>::Zero();
  for (const Index v : mesh.cell(cell)) centre += mesh.vertex(v) / (dim + 1);
  return centre;
}

template <int dim>
ErrorCore core_of(const mesh::Mesh<dim>& mesh, const JudgedField& field, double bound)
{
  ErrorCore core;
  const std::vector<Index> cells = largest(field.cells, core_part);
  double square = 0;
  double volume = 0;
  Point<dim> centre = Point<dim>::Zero();
  for (const Index c : cells)
  {
    const double own = field.cells[c] * field.cells[c];
    square += own;
    volume += volume_of(mesh, c);
    centre += own * centre_of(mesh, c);
  }
  if (square == 0) return core;
  double all = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c) all += volume_of(mesh, c);
  const double inside = error_interval(std::sqrt(square), bound).lower;
  core.share = std::pow(inside / field.error.upper, 2);
  core.volume = volume / all;
  core.n_cells = cells.size();
  centre /= square;
  core.centre.assign(centre.begin(), centre.end());
  return core;
}

template <int dim>
JudgedField judged(const mesh::Mesh<dim>& mesh, std::vector<double> cells, double bound)
{
  JudgedField field;
  field.cells = std::move(cells);
  std::vector<double> squares(mesh.region_names().size(), 0.0);
  for (Index c = 0; c < mesh.n_cells(); ++c) squares[mesh.region(c)] += field.cells[c] * field.cells[c];
  field.distance = std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0));
  field.error = error_interval(field.distance, bound);
  for (std::size_t r = 0; r < squares.size(); ++r)
    field.regions.push_back(
        {mesh.region_names()[r], std::sqrt(squares[r]), error_interval(std::sqrt(squares[r]), bound)});
  field.core = core_of(mesh, field, bound);
  field.halving = largest(field.cells, halving_part);
  return field;
}

/// A field that is a power of ten too large or small, or has the other sign, is so by mistake.
std::string doubt(const LocalError& error)
{
  if (!(error.own_energy > 0) || !(error.reference_energy > 0)) return {};
  const double factor = error.product / error.own_energy;
  const double distance = error.own_energy - 2 * error.product + error.reference_energy;
  const double scaled = error.reference_energy - factor * error.product;
  const double power = std::round(std::log10(std::abs(factor)));
  const bool is_power = std::abs(std::abs(factor) / std::pow(10, power) - 1) < 0.01;
  if (!is_power || (power == 0 && factor > 0) || scaled > distance / 4) return {};
  std::string text = factor < 0 ? "has the other sign" : "";
  if (power != 0)
    text += fmt::format("{}is {:g} times too {}", text.empty() ? "" : " and ", std::pow(10, std::abs(power)),
                        power > 0 ? "small" : "large");
  return text + (power != 0 ? ": metres for millimetres?" : "");
}

/// The node of each vertex.
template <int dim>
std::vector<Index> vertex_nodes(const fem::LagrangeSpace<dim>& space)
{
  std::vector<Index> nodes(space.mesh().n_vertices());
  for (Index c = 0; c < space.mesh().n_cells(); ++c)
    for (int i = 0; i < space.basis().n_nodes(); ++i)
      for (int v = 0; v <= dim; ++v)
        if (space.basis().node(i)[v] == space.degree())
          nodes[space.mesh().cell(c)[v]] = space.cell_nodes(c)[i];
  return nodes;
}

/// Bisection keeps the numbers of vertices.
template <int dim>
std::vector<RigidDifference> rigid_differences(const fem::LagrangeSpace<dim>& their_space,
                                               std::span<const double> v,
                                               const fem::LagrangeSpace<dim>& space,
                                               std::span<const double> u)
{
  constexpr int n_rotations = dim == 2 ? 1 : 3;
  const mesh::Mesh<dim>& mesh = their_space.mesh();
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  const std::vector<Index> theirs = vertex_nodes(their_space);
  const std::vector<Index> ours = vertex_nodes(space);
  std::vector<RigidDifference> result;
  for (int body = 0; body < bodies.n; ++body)
  {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(dim + n_rotations, dim + n_rotations);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(dim + n_rotations, 1);
    Point<dim> centroid = Point<dim>::Zero();
    double volume = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (bodies.of_cell[c] == body)
      {
        centroid += volume_of(mesh, c) * centre_of(mesh, c);
        volume += volume_of(mesh, c);
      }
    centroid /= volume;
    for (Index c = 0; c < mesh.n_cells(); ++c)
    {
      if (bodies.of_cell[c] != body) continue;
      for (const Index vertex : mesh.cell(c))
      {
        Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(dim, dim + n_rotations);
        motions.leftCols(dim).setIdentity();
        const Point<dim> x = mesh.vertex(vertex) - centroid;
        if constexpr (dim == 2)
          motions.col(2) << -x[1], x[0];
        else
          motions.rightCols(3) << 0, x[2], -x[1], -x[2], 0, x[0], x[1], -x[0], 0;
        Eigen::VectorXd difference(dim);
        for (int d = 0; d < dim; ++d)
          difference[d] = v[dim * static_cast<std::size_t>(theirs[vertex]) + d] -
                          u[dim * static_cast<std::size_t>(ours[vertex]) + d];
        a += volume_of(mesh, c) * motions.transpose() * motions;
        b += volume_of(mesh, c) * motions.transpose() * difference;
      }
    }
    const Eigen::MatrixXd motion = solve_regular(a, b);
    RigidDifference& found = result.emplace_back();
    found.body = body;
    found.translation.assign(motion.data(), motion.data() + dim);
    found.rotation.assign(motion.data() + dim, motion.data() + motion.size());
  }
  return result;
}

}  // namespace

ErrorInterval error_interval(double distance, double bound)
{
  return {std::max(0.0, distance * (1 - rounding) - bound * (1 + rounding)),
          (distance + bound) * (1 + rounding)};
}

ErrorInterval relative_interval(const ErrorInterval& error, double norm, double bound)
{
  ErrorInterval relative{error.lower / ((norm + bound) * (1 + rounding))};
  const double least = norm * (1 - rounding) - bound;
  if (least > 0) relative.upper = error.upper / least;
  return relative;
}

template <int dim>
Judgement judge(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& their_space,
                const ForeignSolution<dim>& theirs, const fem::LagrangeSpace<dim>& space,
                std::span<const double> u, double bound)
{
  LocalError error = solution_error<dim>(problem, their_space, theirs.u, space, u);
  Judgement judgement;
  judgement.bound = bound;
  judgement.energy_norm = std::sqrt(error.reference_energy);
  judgement.displacement = judged(their_space.mesh(), std::move(error.energy), bound);
  JudgedField& displacement = judgement.displacement;
  displacement.relative = relative_interval(displacement.error, judgement.energy_norm, bound);
  if (!theirs.stress.empty())
  {
    judgement.stress =
        judged(their_space.mesh(), stress_error<dim>(problem, their_space, theirs.stress, space, u), bound);
    const bool has_initial = std::ranges::any_of(
        problem.regions(), [](const problem::Region<dim>& region) { return region.has_initial_stress(); });
    if (!has_initial)
      judgement.stress->relative = relative_interval(judgement.stress->error, judgement.energy_norm, bound);
  }
  judgement.factor = error.own_energy > 0 ? error.product / error.own_energy : 0;
  judgement.doubt = doubt(error);
  judgement.rigid = rigid_differences<dim>(their_space, theirs.u, space, u);
  return judgement;
}

template Judgement judge(const problem::Problem<2>&, const fem::LagrangeSpace<2>&, const ForeignSolution<2>&,
                         const fem::LagrangeSpace<2>&, std::span<const double>, double);
template Judgement judge(const problem::Problem<3>&, const fem::LagrangeSpace<3>&, const ForeignSolution<3>&,
                         const fem::LagrangeSpace<3>&, std::span<const double>, double);

}  // namespace tribound::certify
