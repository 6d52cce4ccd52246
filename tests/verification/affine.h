#pragma once

/// @file affine.h
/// Affine displacements in every state of contact: the solutions of the constant-stress patch tests.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/meshes.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::test
{

/// u(x) = gradient x + offset on the box (0,2) x (0,1) (x (0,1)), with contact at the bottom.
template <int dim>
struct AffineCase
{
  std::string name;
  Tensor<dim> gradient;
  Point<dim> offset;
  std::string contact;  ///< TOML
  problem::ContactStatus status;
};

inline const problem::Material affine_material = problem::lame(1.0, 0.3, problem::PlaneModel::strain);

inline std::string tresca(double s)
{
  return fmt::format("{{ friction = \"tresca\", threshold = {:.17g} }}", s);
}

inline std::string coulomb(double mu_F)
{
  return fmt::format("{{ friction = \"coulomb\", coefficient = {:.17g} }}", mu_F);
}

/// All states. The displacement is (d (c + k.x + b y), D y) with the tangential direction d, in 3D not along
/// an axis, and a slip c + k.x that varies along the contact but stays positive; shear mu b |d| at the
/// bottom.
template <int dim>
std::vector<AffineCase<dim>> affine_cases()
{
  Point<dim> d = Point<dim>::Unit(0);
  Point<dim> k = 0.1 * Point<dim>::Unit(0);
  if constexpr (dim == 3)
  {
    d = {0.8, 0, -0.6};
    k = {0.1, 0, 0.04};
  }
  const Point<dim> y = Point<dim>::Unit(1);
  const auto field = [&](double slip, double shear, double stretch) -> Tensor<dim>
  { return slip * d * k.transpose() + shear * d * y.transpose() + stretch * y * y.transpose(); };
  const auto pressure = [&](const Tensor<dim>& g) { return -contact::sigma<dim>(affine_material, g)(1, 1); };
  const Tensor<dim> slip = field(1, 0.2, -0.3);
  const Tensor<dim> stick = field(0, 0.2, -0.3);
  const Tensor<dim> smooth = field(1, 0, -0.3);
  const double free_stretch =
      -affine_material.lambda * d.dot(k) / (affine_material.lambda + 2 * affine_material.mu);
  const Tensor<dim> open = field(1, 0, free_stretch);
  const Point<dim> offset = 0.05 * d;
  const Point<dim> none = Point<dim>::Zero();
  const double shear = 0.2 * affine_material.mu;
  return {
      {"slip, Tresca", slip, offset, tresca(shear), problem::ContactStatus::slip},
      {"slip, Coulomb", slip, offset, coulomb(shear / pressure(slip)), problem::ContactStatus::slip},
      {"stick, Tresca", stick, none, tresca(2 * shear), problem::ContactStatus::stick},
      {"stick, Coulomb", stick, none, coulomb(2 * shear / pressure(stick)), problem::ContactStatus::stick},
      {"frictionless", smooth, offset, "{ friction = \"none\" }", problem::ContactStatus::slip},
      {"open, frictionless", open, offset, "{ friction = \"none\", gap = 1 }", problem::ContactStatus::open},
      {"open, Tresca", open, offset, "{ friction = \"tresca\", threshold = 0, gap = 1 }",
       problem::ContactStatus::open},
      {"open, Coulomb", open, offset, "{ friction = \"coulomb\", coefficient = 0.5, gap = 1 }",
       problem::ContactStatus::open},
  };
}

/// The same physics in a frame turned by `q`.
template <int dim>
AffineCase<dim> turned(AffineCase<dim> c, const Tensor<dim>& q)
{
  c.gradient = (q * c.gradient * q.transpose()).eval();
  c.offset = (q * c.offset).eval();
  return c;
}

/// No side of the turned box is parallel to an axis.
template <int dim>
Tensor<dim> rotation()
{
  Tensor<2> plane;
  plane << 0.8, -0.6, 0.6, 0.8;
  if constexpr (dim == 2) return plane;
  Tensor<dim> about_z = Tensor<dim>::Identity();
  Tensor<dim> about_x = Tensor<dim>::Identity();
  about_z.topLeftCorner(2, 2) = plane;
  about_x.bottomRightCorner(2, 2) = plane;
  return about_x * about_z;
}

/// Displacement on all sides but the bottom and the right one, which carries the exact traction.
template <int dim>
std::string affine_toml(const AffineCase<dim>& c, int p, const Point<dim>& right_normal)
{
  std::string toml = fmt::format(
      "degree = {}\nmaterial = {{ E = 1, nu = 0.3 }}\nnewton.tolerance = 1e-13\nboundary.bottom.contact = "
      "{}\n",
      p, c.contact);
  std::string displacement;
  std::string traction;
  const Point<dim> t = contact::sigma<dim>(affine_material, c.gradient) * right_normal;
  for (int a = 0; a < dim; ++a)
  {
    displacement += fmt::format("\"{:.17g}", c.offset[a]);
    for (int b = 0; b < dim; ++b) displacement += fmt::format(" + {:.17g}*{}", c.gradient(a, b), "xyz"[b]);
    displacement += "\", ";
    traction += fmt::format("{:.17g}, ", t[a]);
  }
  toml += fmt::format("boundary.right.traction = [{}]\n", traction);
  for (const char* side : {"left", "top", "back", "front"})
    if (dim == 3 || (side[0] != 'b' && side[0] != 'f'))
      toml += fmt::format("boundary.{}.displacement = [{}]\n", side, displacement);
  return toml;
}

/// Runs `check(case, normal of the right side, normal of the bottom)` for every state.
template <int dim, class Check>
void for_all_states(const Tensor<dim>& frame, const Check& check)
{
  for (const AffineCase<dim>& c : affine_cases<dim>())
  {
    SCOPED_TRACE(c.name);
    check(turned<dim>(c, frame), Point<dim>(frame.col(0)), Point<dim>(-frame.col(1)));
  }
}

template <int dim>
mesh::MeshData<dim> structured()
{
  if constexpr (dim == 2)
    return box<2>({0, 0}, {2, 1}, {4, 2});
  else
    return box<3>({0, 0, 0}, {2, 1, 1}, {2, 2, 2});
}

}  // namespace tribound::test
