#pragma once

/// @file rigid_motion_testing.h
/// Shared by the tests of check_rigid_motions.

#include <Eigen/Geometry>
#include <string>

#include "support/discrete_problem.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/contact/support/rigid_motion.h"

namespace tribound::test
{

/// The message of check_rigid_motions for the problem with this load, or "held".
template <int dim>
std::string verdict(const DiscreteProblem<dim>& c, std::span<const double> load)
{
  const std::string said = message_of([&] { contact::check_rigid_motions(c.form, load); });
  return said.empty() ? "held" : said;
}

/// The same with the load of the problem.
template <int dim>
std::string verdict(const mesh::MeshData<dim>& mesh,
                    const std::vector<problem::BoundaryCondition<dim>>& boundaries,
                    const std::array<problem::Field, dim>& body_force = {})
{
  const DiscreteProblem<dim> c(mesh, {.boundaries = boundaries, .body_force = body_force});
  return verdict<dim>(c, c.form.load());
}

inline mesh::MeshData<2> block()
{
  return block<2>({4, 2});
}

inline mesh::MeshData<3> brick()
{
  return block<3>({2, 1, 1});
}

/// A block on a slope of the given angle: its bottom is inclined, gravity points down.
inline mesh::MeshData<2> on_slope(double angle)
{
  const Eigen::Rotation2Dd turn(angle);
  return mapped<2>(block(), [&](const Point<2>& x) -> Point<2> { return turn * x; });
}

inline mesh::MeshData<3> brick_on_slope(double angle)
{
  const auto turn = Eigen::AngleAxisd(angle, Point<3>(0, -1, 0)).toRotationMatrix();
  return mapped<3>(brick(), [&](const Point<3>& x) -> Point<3> { return turn * x; });
}

}  // namespace tribound::test
