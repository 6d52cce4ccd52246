#pragma once

/// @file projection.h
/// The two projections of the contact conditions and their generalised derivatives, method section 2.

#include "base/types.h"

namespace tribound
{

/// [x]_- = min(x, 0).
[[nodiscard]] inline double negative_part(double x)
{
  return x < 0 ? x : 0;
}

/// D[x]_- = 1 if x <= 0 else 0.
[[nodiscard]] inline double negative_part_derivative(double x)
{
  return x <= 0 ? 1 : 0;
}

/// [x]_a, the projection of x on the ball B(0, a), a >= 0.
template <int dim>
[[nodiscard]] Point<dim> ball_projection(const Point<dim>& x, double a)
{
  const double norm = x.norm();
  if (norm <= a) return x;
  return (a / norm) * x;
}

/// D_x [x]_a = I if |x| <= a, else (a/|x|) (I - x x^T / |x|^2); 0 for a = 0 (no friction).
template <int dim>
[[nodiscard]] Tensor<dim> ball_projection_derivative(const Point<dim>& x, double a)
{
  if (a <= 0) return Tensor<dim>::Zero();
  const double norm = x.norm();
  if (norm <= a) return Tensor<dim>::Identity();
  const Point<dim> direction = x / norm;
  return (a / norm) * (Tensor<dim>::Identity() - direction * direction.transpose());
}

/// D_a [x]_a = 0 if |x| <= a, else x/|x|.
template <int dim>
[[nodiscard]] Point<dim> ball_projection_radius_derivative(const Point<dim>& x, double a)
{
  const double norm = x.norm();
  if (norm <= a) return Point<dim>::Zero();
  return x / norm;
}

}  // namespace tribound
