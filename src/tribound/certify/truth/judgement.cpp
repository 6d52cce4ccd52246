#include "tribound/certify/truth/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/truth/solution_error.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

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

/// Of an axisymmetric body that of one radian.
template <int dim>
double volume_of(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, Index cell)
{
  return mesh::cell_map(mesh, cell).measure() *
         problem::mean_weight(problem, mesh::points_of(mesh.vertices(), mesh.cell(cell)));
}

template <int dim>
Point<dim> centre_of(const mesh::Mesh<dim>& mesh, Index cell)
{
  Point<dim> centre = Point<dim>::Zero();
  for (const Index v : mesh.cell(cell)) centre += mesh.vertex(v) / (dim + 1);
  return centre;
}

template <int dim>
ErrorCore core_of(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, const JudgedField& field,
                  double bound, double doubt)
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
    volume += volume_of(problem, mesh, c);
    centre += own * centre_of(mesh, c);
  }
  if (square == 0) return core;
  double all = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c) all += volume_of(problem, mesh, c);
  const double inside = error_interval(std::sqrt(square), bound, doubt).lower;
  core.share = std::pow(inside / field.error.upper, 2);
  core.volume = volume / all;
  core.n_cells = cells.size();
  centre /= square;
  core.centre.assign(centre.begin(), centre.end());
  return core;
}

template <int dim>
JudgedField judged(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                   std::vector<double> cells, double bound, double doubt)
{
  JudgedField field;
  field.cells = std::move(cells);
  for (double& distance : field.cells) distance *= std::sqrt(problem.full_circle());
  std::vector<double> squares(mesh.region_names().size(), 0.0);
  for (Index c = 0; c < mesh.n_cells(); ++c) squares[mesh.region(c)] += field.cells[c] * field.cells[c];
  field.distance = std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0));
  field.error = error_interval(field.distance, bound, doubt);
  for (std::size_t r = 0; r < squares.size(); ++r)
    field.regions.push_back(
        {mesh.region_names()[r], std::sqrt(squares[r]), error_interval(std::sqrt(squares[r]), bound, doubt)});
  field.core = core_of(problem, mesh, field, bound, doubt);
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

template <int dim>
Point<dim> value_at(const fem::LagrangeSpace<dim>& space, std::span<const double> u, Index cell,
                    const Point<dim>& xhat)
{
  const fem::Tabulation<dim> table = space.basis().tabulate({&xhat, 1});
  Point<dim> value = Point<dim>::Zero();
  for (int i = 0; i < table.n_nodes; ++i)
    value += table.values[i] * Eigen::Map<const Point<dim>>(
                                   u.data() + dim * static_cast<std::size_t>(space.cell_nodes(cell)[i]));
  return value;
}

/// The normal equations of the nearest rigid motion of a body. Of an axisymmetric one only that along the
/// axis is not fixed to 0.
template <int dim>
struct RigidFit
{
  static constexpr int n = dim == 2 ? 3 : 6;
  bool is_axisymmetric = false;
  Point<dim> centroid = Point<dim>::Zero();
  double volume = 0;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, 1);

  void add(double weight, const Point<dim>& point, const Point<dim>& difference)
  {
    Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(dim, n);
    motions.leftCols(dim).setIdentity();
    const Point<dim> x = point - centroid;
    if constexpr (dim == 2)
      motions.col(2) << -x[1], x[0];
    else
      motions.rightCols(3) << 0, x[2], -x[1], -x[2], 0, x[0], x[1], -x[0], 0;
    a += weight * motions.transpose() * motions;
    b += weight * motions.transpose() * difference;
  }

  /// Translations, then rotations.
  [[nodiscard]] Eigen::VectorXd motion() const
  {
    if (!is_axisymmetric) return solve_regular(a, b);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(n);
    along[1] = b(1) / a(1, 1);
    return along;
  }
};

/// Fitted at the vertices of the cells of u, weighted by their volumes.
template <int dim>
std::vector<RigidDifference> rigid_differences(const problem::Problem<dim>& problem,
                                               const fem::LagrangeSpace<dim>& their_space,
                                               std::span<const double> v,
                                               const fem::LagrangeSpace<dim>& space,
                                               std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = their_space.mesh();
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  std::vector<RigidFit<dim>> fits(bodies.n, {.is_axisymmetric = problem.is_axisymmetric()});
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    RigidFit<dim>& fit = fits[bodies.of_cell[c]];
    fit.centroid += volume_of(problem, mesh, c) * centre_of(mesh, c);
    fit.volume += volume_of(problem, mesh, c);
  }
  for (RigidFit<dim>& fit : fits) fit.centroid /= fit.volume;
  for (const auto& [theirs, ours] : cell_pairs(mesh, space.mesh()))
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, theirs);
    for (const Index vertex : space.mesh().cell(ours))
    {
      const Point<dim>& x = space.mesh().vertex(vertex);
      const Point<dim> difference =
          value_at<dim>(their_space, v, theirs, fem::reference_point(map, x)) -
          value_at<dim>(space, u, ours, fem::reference_point(mesh::cell_map(space.mesh(), ours), x));
      fits[bodies.of_cell[theirs]].add(volume_of(problem, space.mesh(), ours), x, difference);
    }
  }
  std::vector<RigidDifference> result;
  for (int body = 0; body < bodies.n; ++body)
  {
    RigidFit<dim>& fit = fits[body];
    space.mesh().ranks().sum(std::span(fit.a.data(), fit.a.size()));
    space.mesh().ranks().sum(std::span(fit.b.data(), fit.b.size()));
    const Eigen::VectorXd motion = fit.motion();
    RigidDifference& found = result.emplace_back();
    found.body = body;
    found.translation.assign(motion.data(), motion.data() + dim);
    found.rotation.assign(motion.data() + dim, motion.data() + motion.size());
  }
  return result;
}

}  // namespace

// A square up to the part `doubt` of itself is that of a root up to the same part, at most.
ErrorInterval error_interval(double distance, double bound, double doubt)
{
  return {std::max(0.0, distance * (1 - rounding - doubt) - bound * (1 + rounding)),
          (distance * (1 + doubt) + bound) * (1 + rounding)};
}

ErrorInterval relative_interval(const ErrorInterval& error, double norm, double bound, double doubt)
{
  ErrorInterval relative{error.lower / ((norm * (1 + doubt) + bound) * (1 + rounding))};
  const double least = norm * (1 - rounding - doubt) - bound;
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
  bound *= std::sqrt(problem.full_circle());
  judgement.bound = bound;
  judgement.energy_norm = std::sqrt(problem.full_circle() * error.reference_energy);
  judgement.displacement = judged(problem, their_space.mesh(), std::move(error.energy), bound, error.doubt);
  JudgedField& displacement = judgement.displacement;
  displacement.relative = relative_interval(displacement.error, judgement.energy_norm, bound, error.doubt);
  if (!theirs.stress.empty())
  {
    StressError of_stress = stress_error<dim>(problem, their_space, theirs.stress, theirs.hoop, space, u);
    judgement.stress =
        judged(problem, their_space.mesh(), std::move(of_stress.cells), bound, of_stress.doubt);
    if (!problem.has_initial_stress())
      judgement.stress->relative =
          relative_interval(judgement.stress->error, judgement.energy_norm, bound, error.doubt);
  }
  judgement.factor = error.own_energy > 0 ? error.product / error.own_energy : 0;
  judgement.doubt = doubt(error);
  judgement.rigid = rigid_differences<dim>(problem, their_space, theirs.u, space, u);
  return judgement;
}

template Judgement judge(const problem::Problem<2>&, const fem::LagrangeSpace<2>&, const ForeignSolution<2>&,
                         const fem::LagrangeSpace<2>&, std::span<const double>, double);
template Judgement judge(const problem::Problem<3>&, const fem::LagrangeSpace<3>&, const ForeignSolution<3>&,
                         const fem::LagrangeSpace<3>&, std::span<const double>, double);

}  // namespace tribound::certify
