#pragma once

/// @file contact_resultant.h
/// Contact forces and moments, as rigid motions by which tractions are multiplied, and what statics says
/// about them.

#include <optional>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/problem/quantity.h"

namespace tribound::certify
{

/// m(x) = translation + spin (x - centre), spin skew.
template <int dim>
struct RigidMotion
{
  Point<dim> translation = Point<dim>::Zero();
  Tensor<dim> spin = Tensor<dim>::Zero();
  Point<dim> centre = Point<dim>::Zero();

  [[nodiscard]] Point<dim> operator()(const Point<dim>& x) const { return translation + spin * (x - centre); }
};

/// The motion whose product with forces is their moment about the point, in 3D about `axis` through it.
template <int dim>
[[nodiscard]] RigidMotion<dim> rotation(const Point<dim>& point, const Point<dim>& axis);

/// integral of sigma(u) n . m over the facets of one boundary, or of all, that are slaves or face obstacles.
template <int dim>
struct ContactResultant
{
  int tag = -1;  ///< of the boundary; -1: all contact boundaries
  RigidMotion<dim> motion{};

  [[nodiscard]] bool has(int boundary) const { return tag < 0 || boundary == tag; }
  /// Whether the force of this boundary's spring is part of the resultant.
  [[nodiscard]] bool has_spring(const problem::Problem<dim>& problem, int boundary) const
  {
    return boundary == tag && problem.boundary(boundary).spring;
  }
};

/// A number known up to rounding and what quadrature may miss.
struct KnownNumber
{
  double value = 0;
  double uncertainty = 0;
};

/// The resultant if it follows from equilibrium: nothing else may stop the motion of the bodies on whose
/// contact boundaries or springs it is taken. Then every solution has -(f, m) - (g_N, m)_N over these bodies,
/// for any contact law. Of axisymmetric problems, with the weight r, motions along the axis alone have one.
/// All ranks together.
template <int dim>
[[nodiscard]] std::optional<KnownNumber> from_equilibrium(const contact::NitscheForm<dim>& form,
                                                          const ContactResultant<dim>& resultant);

}  // namespace tribound::certify
