#pragma once

/// @file rigid_motion_testing.h
/// What the tests of check_rigid_motions share.

#include <Eigen/Geometry>
#include <string>

#include "support/discrete_case.h"
#include "support/meshes.h"
#include "tribound/base/error.h"
#include "tribound/contact/support/rigid_motion.h"

namespace tribound::test
{

inline const std::string material = "degree = 1\nmaterial = { E = 1, nu = 0.3 }\n";

/// What check_rigid_motions says about the case, or "held".
template <int dim>
std::string verdict(const mesh::MeshData<dim>& mesh, const std::string& toml)
{
  const DiscreteCase<dim> c(material + toml, mesh);
  try
  {
    contact::check_rigid_motions<dim>(c.problem, c.space, c.form.data(), c.form.load());
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "held";
}

inline mesh::MeshData<2> block()
{
  return box<2>({0, 0}, {2, 1}, {4, 2});
}

inline mesh::MeshData<3> brick()
{
  return box<3>({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
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
