#pragma once

/// @file affine.h
/// Affine displacements in every state of contact: solutions of the constant-stress patch tests.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/adapt/method.h"
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
  problem::Contact contact;
  problem::ContactStatus status;
};

inline const problem::Material affine_material = problem::lame(1.0, 0.3, problem::PlaneModel::strain);

/// All states. The displacement is (d (c + k.x + b y), D y) with the tangential direction d, in 3D not along
/// an axis. The slip c + k.x varies along the contact but stays positive; the shear at the bottom is
/// mu b |d|.
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
  const auto field = [&](double slide, double shear, double stretch) -> Tensor<dim>
  { return slide * d * k.transpose() + shear * d * y.transpose() + stretch * y * y.transpose(); };
  const auto pressure = [&](const Tensor<dim>& g) { return -contact::sigma<dim>(affine_material, g)(1, 1); };
  const Tensor<dim> slipping = field(1, 0.2, -0.3);
  const Tensor<dim> sticking = field(0, 0.2, -0.3);
  const Tensor<dim> smooth = field(1, 0, -0.3);
  const double free_stretch =
      -affine_material.lambda * d.dot(k) / (affine_material.lambda + 2 * affine_material.mu);
  const Tensor<dim> lifted = field(1, 0, free_stretch);
  const Point<dim> offset = 0.05 * d;
  const Point<dim> none = Point<dim>::Zero();
  const double shear = 0.2 * affine_material.mu;
  const auto near = [](problem::ContactLaw l) { return problem::Contact(std::move(l)); };
  const auto far = [](problem::ContactLaw l) { return problem::Contact(std::move(l), 1); };
  using enum problem::ContactStatus;
  return {
      {"slip, Tresca", slipping, offset, near(Tresca(shear)), slip},
      {"slip, Coulomb", slipping, offset, near(Coulomb(shear / pressure(slipping))), slip},
      {"stick, Tresca", sticking, none, near(Tresca(2 * shear)), stick},
      {"stick, Coulomb", sticking, none, near(Coulomb(2 * shear / pressure(sticking))), stick},
      {"frictionless", smooth, offset, near(Frictionless()), slip},
      {"open, frictionless", lifted, offset, far(Frictionless()), open},
      {"open, Tresca", lifted, offset, far(Tresca(0)), open},
      {"open, Coulomb", lifted, offset, far(Coulomb(0.5)), open},
  };
}

/// The same problem in a frame rotated by `q`.
template <int dim>
AffineCase<dim> turned(AffineCase<dim> c, const Tensor<dim>& q)
{
  c.gradient = (q * c.gradient * q.transpose()).eval();
  c.offset = (q * c.offset).eval();
  return c;
}

/// The components of gradient x + offset.
template <int dim>
std::array<problem::Field, 3> affine_field(const Tensor<dim>& gradient, const Point<dim>& offset)
{
  std::array<problem::Field, 3> u;
  for (int a = 0; a < dim; ++a)
  {
    std::string text = fmt::format("{:.17g}", offset[a]);
    for (int b = 0; b < dim; ++b) text += fmt::format(" + {:.17g}*{}", gradient(a, b), "xyz"[b]);
    u[a] = formula(text);
  }
  return u;
}

/// max |u_h - gradient x - offset| over the nodes.
template <int dim>
double distance_from_affine(const fem::LagrangeSpace<dim>& space, std::span<const Index> nodes,
                            std::span<const double> u, const Tensor<dim>& gradient, const Point<dim>& offset)
{
  double largest = 0;
  const std::vector<Point<dim>> points = space.node_points();
  for (const Index i : nodes)
    largest = std::max(largest, (Eigen::Map<const Point<dim>>(u.data() + dim * static_cast<std::size_t>(i)) -
                                 gradient * points[i] - offset)
                                    .norm());
  return largest;
}

/// Prescribed displacement on all sides but the bottom and the right; the right carries the exact traction.
template <int dim>
ProblemData<dim> affine_data(const AffineCase<dim>& c, const Point<dim>& right_normal)
{
  const std::array<problem::Field, 3> u = affine_field<dim>(c.gradient, c.offset);
  const Point<dim> t = contact::sigma<dim>(affine_material, c.gradient) * right_normal;
  ProblemData<dim> data{
      .boundaries = {obstacle<dim>("bottom", c.contact), loaded<dim>("right", t[0], t[1], t[dim - 1])}};
  for (const std::string side : side_names<dim>)
    if (side != "right" && side != "bottom") data.boundaries.push_back(fixed<dim>(side, u[0], u[1], u[2]));
  return data;
}

inline adapt::Method affine_method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-13}};
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
  return block<dim>({4, 2}, {2, 2, 2});
}

}  // namespace tribound::test
