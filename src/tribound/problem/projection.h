#pragma once

/// @file projection.h
/// The two projections of the contact conditions and their generalised derivatives, method section 2, and
/// their regularised counterparts, method section 7: with delta > 0 all are C^1, with delta = 0 they are the
/// projections themselves.

#include <cmath>

#include "tribound/base/types.h"

namespace tribound::problem
{

/// [x]_- = min(x, 0); for delta > 0 the mean of [.]_- over (x - delta, x + delta) [DFK22]:
/// [x]_{-,delta} = x for x <= -delta, -(x - delta)^2 / (4 delta) for |x| < delta, 0 for x >= delta.
[[nodiscard]] inline double negative_part(double x, double delta = 0)
{
  if (std::abs(x) < delta) return -(x - delta) * (x - delta) / (4 * delta);
  return x < 0 ? x : 0;
}

/// D[x]_- = 1 if x <= 0 else 0; D[x]_{-,delta} = (delta - x) / (2 delta) for |x| < delta.
[[nodiscard]] inline double negative_part_derivative(double x, double delta = 0)
{
  if (std::abs(x) < delta) return (delta - x) / (2 * delta);
  return x <= 0 ? 1 : 0;
}

/// The length that the regularised projection on B(0, a) gives to a vector of length r: the mean over
/// (r - delta, r + delta) of the projection of the line on [-a, a],
/// phi(r) = [r - a]_{-,delta} - [-r - a]_{-,delta} - r, odd in r, at most a, and 0 for a = 0.
[[nodiscard]] inline double clamped_length(double r, double a, double delta)
{
  return negative_part(r - a, delta) - negative_part(-r - a, delta) - r;
}

/// phi'(r).
[[nodiscard]] inline double clamped_length_derivative(double r, double a, double delta)
{
  return negative_part_derivative(r - a, delta) + negative_part_derivative(-r - a, delta) - 1;
}

/// [x]_a, the projection of x on the ball B(0, a), a >= 0; for delta > 0 [x]_{a,delta} = phi(|x|) x/|x|.
template <int dim>
[[nodiscard]] Point<dim> ball_projection(const Point<dim>& x, double a, double delta = 0)
{
  const double norm = x.norm();
  if (norm + delta <= a) return x;
  if (delta == 0) return (a / norm) * x;
  if (a <= 0 || norm == 0) return Point<dim>::Zero();
  return (clamped_length(norm, a, delta) / norm) * x;
}

/// D_x [x]_a = I if |x| <= a, else (a/|x|) (I - x x^T / |x|^2); 0 for a = 0 (no friction).
/// D_x [x]_{a,delta} = phi(|x|)/|x| (I - x x^T / |x|^2) + phi'(|x|) x x^T / |x|^2, and phi'(0) I in 0.
template <int dim>
[[nodiscard]] Tensor<dim> ball_projection_derivative(const Point<dim>& x, double a, double delta = 0)
{
  if (a <= 0) return Tensor<dim>::Zero();
  const double norm = x.norm();
  if (norm + delta <= a) return Tensor<dim>::Identity();
  if (norm == 0) return clamped_length_derivative(0, a, delta) * Tensor<dim>::Identity();
  const Point<dim> direction = x / norm;
  const Tensor<dim> radial = direction * direction.transpose();
  const Tensor<dim> across = Tensor<dim>::Identity() - radial;
  if (delta == 0) return (a / norm) * across;
  return clamped_length(norm, a, delta) / norm * across + clamped_length_derivative(norm, a, delta) * radial;
}

/// D_a [x]_a = 0 if |x| <= a, else x/|x|;
/// D_a [x]_{a,delta} = (D[-|x| - a]_{-,delta} - D[|x| - a]_{-,delta}) x/|x|.
template <int dim>
[[nodiscard]] Point<dim> ball_projection_radius_derivative(const Point<dim>& x, double a, double delta = 0)
{
  const double norm = x.norm();
  if (norm + delta <= a || norm == 0) return Point<dim>::Zero();
  return (negative_part_derivative(-norm - a, delta) - negative_part_derivative(norm - a, delta)) / norm * x;
}

}  // namespace tribound::problem
