#pragma once

/// @file arched_block.h
/// A block with a round lower side, obstacles that it may touch there, and another body below it.

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/adapt/method.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/problem/surface.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{

inline constexpr double radius = 1;

/// A block of width 1 above an arc of the circle around (0, 1) (3D: of the cylinder along z).
template <int dim>
mesh::MeshData<dim> arched_block(int n)
{
  Point<dim> lower = Point<dim>::Zero();
  Point<dim> upper = Point<dim>::Ones();
  lower[0] = -0.5;
  upper[0] = 0.5;
  if (dim == 3) upper[dim - 1] = 1.0 / n;
  std::array<int, dim> cells;
  cells.fill(n);
  if (dim == 3) cells[dim - 1] = 1;
  return mapped<dim>(box<dim>(lower, upper, cells),
                     [](Point<dim> x) -> Point<dim>
                     {
                       x[1] += (1 - x[1]) * (radius - std::sqrt(radius * radius - x[0] * x[0]));
                       return x;
                     });
}

[[nodiscard]] inline std::vector<double> point(std::initializer_list<double> x, int dim)
{
  return {x.begin(), x.begin() + dim};
}

/// The true lower side of the block.
[[nodiscard]] inline problem::Surface arc(int dim)
{
  if (dim == 2) return problem::sphere(point({0, 1}, 2), radius, problem::Positive::outside);
  return problem::cylinder(point({0, 1, 0}, 3), point({0, 0, 1}, 3), radius, problem::Positive::outside);
}

/// Obstacles below the block: a floor, a round punch, a groove that is wider than the block.
[[nodiscard]] inline std::vector<std::pair<std::string, problem::Surface>> obstacles(int dim)
{
  const auto round = [dim](double y, double r, problem::Positive side)
  {
    return dim == 2 ? problem::sphere(point({0.05, y}, 2), r, side)
                    : problem::cylinder(point({0.05, y, 0}, 3), point({0, 0, 1}, 3), r, side);
  };
  return {{"floor", problem::plane(point({0, 0, 0}, dim), point({0, 1, 0}, dim))},
          {"punch", round(-0.6, 0.6, problem::Positive::outside)},
          {"groove", round(1.3, 1.3, problem::Positive::inside)}};
}

[[nodiscard]] inline problem::Contact contact_with(const problem::Surface& obstacle, problem::ContactLaw law,
                                                   int dim, bool with_shape = true)
{
  problem::ContactGeometry geometry{.obstacle = obstacle, .where = {.file = {}, .key = "contact"}};
  if (with_shape) geometry.shape = arc(dim);
  problem::Contact contact(std::move(law), problem::gap_of(geometry));
  contact.normal = problem::direction_of_obstacle(geometry);
  if (with_shape) contact.true_surface = problem::Field(arc(dim).distance, geometry.where);
  return contact;
}

/// Pressed down and sideways on top.
template <int dim>
ProblemData<dim> pressed_on(const problem::Contact& contact)
{
  ProblemData<dim> data{.boundaries = {fixed<dim>("top", 0.004, -0.02, 0.001), obstacle<dim>("bottom")},
                        .material = lame(1, 0.3)};
  data.boundaries.back().contact = contact;
  return data;
}

/// A round body on a block whose upper side is the same arc, slightly flatter.
template <int dim>
std::pair<mesh::MeshData<dim>, ProblemData<dim>> pair_on_arc(int n, problem::ContactLaw law)
{
  Point<dim> lower = -Point<dim>::Ones();
  Point<dim> upper = Point<dim>::Zero();
  lower[0] = -0.6;
  upper[0] = 0.6;
  std::array<int, dim> cells;
  cells.fill(n + 1);
  if (dim == 3)
  {
    lower[dim - 1] = 0;
    upper[dim - 1] = 1.0 / n;
    cells[dim - 1] = 1;
  }
  constexpr double flatter = 1.25;
  mesh::MeshData<dim> below =
      mapped<dim>(box<dim>(lower, upper, cells),
                  [](Point<dim> x) -> Point<dim>
                  {
                    x[1] += (1 + x[1]) * (flatter - std::sqrt(flatter * flatter - x[0] * x[0]));
                    return x;
                  });
  mesh::MeshData<dim> data = side_by_side(arched_block<dim>(n), below, "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  const problem::Surface hole =
      dim == 2 ? problem::sphere(point({0, flatter}, 2), flatter, problem::Positive::inside)
               : problem::cylinder(point({0, flatter, 0}, 3), point({0, 0, 1}, 3), flatter,
                                   problem::Positive::inside);
  ProblemData<dim> problem{
      .boundaries = {fixed<dim>("top", 0.004, -0.02, 0.001), clamped<dim>("bottom_below")},
      .material = lame(1, 0.3),
      .regions = {{.name = "box_below", .material = lame(3, 0.2)}},
      .pairs = {pair<dim>("bottom", "top_below", law)}};
  problem.pairs[0].contact = contact_with(hole, law, dim);
  problem.pairs[0].pairing.direction = -Point<dim>::Unit(1);
  return {std::move(data), std::move(problem)};
}

[[nodiscard]] inline const std::vector<problem::ContactLaw>& laws()
{
  static const std::vector<problem::ContactLaw> all = {Frictionless(), Tresca(0.004), Coulomb(0.3)};
  return all;
}

/// The largest pressure on the lower side of a block with this mesh, pressed down by 0.02, degree 2.
[[nodiscard]] inline double largest_pressure(const problem::Contact& contact, const mesh::Mesh<2>& mesh)
{
  ProblemData<2> data = pressed_on<2>(contact);
  data.boundaries[0] = fixed<2>("top", 0.0, -0.02);
  const problem::Problem<2> problem = data.on(mesh);
  const fem::LagrangeSpace<2> space(mesh, 2);
  const adapt::Method method{.degree = 2};
  const contact::NitscheForm<2> form(problem, space, method.gamma_0());
  const solve::NewtonResult<2> newton = solve::solve<2>(form, {}, method.newton, method.solver);
  double largest = 0;
  const std::vector<Point<2>> traction = form.traction(newton.u);
  for (std::size_t i = 0; i < traction.size(); ++i)
    largest = std::max(largest, -traction[i].dot(form.contact_points()[i].normal));
  return largest;
}

}  // namespace tribound::test
