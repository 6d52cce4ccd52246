#pragma once

/// @file unilateral.h
/// The contact traction of laws without bond, and its derivative, method section 2.

#include "tribound/problem/contact_law.h"

namespace tribound::problem
{

/// T = [P^n]_- n + [P^t]_S of Frictionless, Tresca or Coulomb, P with gamma times the slip remembered at the
/// point; regularised projections for delta > 0. P, S, delta: stresses.
template <int dim, FrictionLaw L>
[[nodiscard]] Response<dim> respond_unilaterally(const L& law, const LawPoint<dim>& point,
                                                 const Point<dim>& P, double delta);

/// DT = D[P^n]_- n n^T + D_x[P^t]_S (I - n n^T) + D_a[P^t]_S DS n^T.
template <int dim, FrictionLaw L>
[[nodiscard]] Tensor<dim> unilateral_tangent(const L& law, const LawPoint<dim>& point, const Point<dim>& P,
                                             double delta);

}  // namespace tribound::problem
