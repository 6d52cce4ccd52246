#pragma once

/// @file constants.h
/// The constants of the inequalities on a simplex T of diameter h_T on which the bound rests, method section
/// 5.

#include <cmath>
#include <numbers>

namespace tribound::certify
{

/// h_T / pi: ||v - mean_T(v)||_T <= h_T / pi ||grad v||_T, since T is convex.
[[nodiscard]] inline double poincare_constant(double h)
{
  return h / std::numbers::pi;
}

inline constexpr double bessel_zero = 3.8317059702;  ///< j_{1,1}, the first zero of J_1 > 0; rounded down

/// h_T / j_{1,1}: the same where T is a triangle [LS10].
[[nodiscard]] constexpr double poincare_constant_of_triangle(double h)
{
  return h / bessel_zero;
}

/// C_{T,F}^2 for h_T = 1 and |F| = |T|: 1/pi^2 + 2/(d pi).
template <int dim>
[[nodiscard]] constexpr double trace_constant_squared()
{
  constexpr double pi = std::numbers::pi;
  return 1 / (pi * pi) + 2 / (dim * pi);
}

/// C_{T,F} = h_T (|F|/|T| (1/pi^2 + 2/(d pi)))^{1/2}: ||v - mean_F(v)||_F <= C_{T,F} ||grad v||_T on a facet
/// F of T, |F| = `measure` and |T| = `volume`.
template <int dim>
[[nodiscard]] double trace_constant(double h, double measure, double volume)
{
  return h * std::sqrt(measure / volume * trace_constant_squared<dim>());
}

}  // namespace tribound::certify
