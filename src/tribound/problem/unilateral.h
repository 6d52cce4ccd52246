#pragma once

/// @file unilateral.h
/// The contact traction of laws without bond, and its derivative, method section 2.

#include "tribound/problem/contact_law.h"
#include "tribound/problem/projection.h"

namespace tribound::problem
{

namespace detail
{

/// A friction limit S_h and its derivative by P^n.
struct Limit
{
  double value;
  double by_normal = 0;
};

inline Limit limit(const Frictionless& /*law*/, double /*strength*/, double /*p_n*/, double /*delta*/)
{
  return {0};
}

inline Limit limit(const Tresca& /*law*/, double strength, double /*p_n*/, double /*delta*/)
{
  return {strength};
}

/// S_h = -mu_F [P^n]_{-,delta}.
inline Limit limit(const Coulomb& law, double /*strength*/, double p_n, double delta)
{
  return {-law.coefficient * negative_part(p_n, delta),
          -law.coefficient * negative_part_derivative(p_n, delta)};
}

/// P with the slip remembered by friction without bond.
template <int dim>
Point<dim> remembered(const LawPoint<dim>& point, const Point<dim>& P)
{
  return P + point.gamma * point.state.slip;
}

}  // namespace detail

/// T = [P^n]_- n + [P^t]_S of Frictionless, Tresca or Coulomb, P with gamma times the slip remembered at the
/// point; regularised projections for delta > 0. P, S, delta: stresses.
template <int dim, FrictionLaw L>
[[nodiscard]] Response<dim> respond_unilaterally(const L& law, const LawPoint<dim>& point,
                                                 const Point<dim>& P, double delta)
{
  const Point<dim> p = detail::remembered(point, P);
  const double p_n = p.dot(point.normal);
  const Point<dim> p_t = p - p_n * point.normal;
  const double S = detail::limit(law, point.strength, p_n, delta).value;
  ContactStatus status = p_t.norm() <= S ? ContactStatus::stick : ContactStatus::slip;
  if (p_n > 0) status = ContactStatus::open;
  return {negative_part(p_n, delta) * point.normal + ball_projection<dim>(p_t, S, delta), S, status};
}

/// DT = D[P^n]_- n n^T + D_x[P^t]_S (I - n n^T) + D_a[P^t]_S DS n^T.
template <int dim, FrictionLaw L>
[[nodiscard]] Tensor<dim> unilateral_tangent(const L& law, const LawPoint<dim>& point, const Point<dim>& P,
                                             double delta)
{
  const Point<dim>& n = point.normal;
  const Point<dim> p = detail::remembered(point, P);
  const double p_n = p.dot(n);
  const Point<dim> p_t = p - p_n * n;
  const detail::Limit S = detail::limit(law, point.strength, p_n, delta);
  const Tensor<dim> tangential = Tensor<dim>::Identity() - n * n.transpose();
  Tensor<dim> derivative = negative_part_derivative(p_n, delta) * n * n.transpose() +
                           ball_projection_derivative<dim>(p_t, S.value, delta) * tangential;
  if (S.by_normal != 0)
    derivative += S.by_normal * ball_projection_radius_derivative<dim>(p_t, S.value, delta) * n.transpose();
  return derivative;
}

}  // namespace tribound::problem
