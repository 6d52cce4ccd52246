#pragma once

/// @file constants.h
/// The constants of the inequalities on a simplex T of diameter h_T on which the bounds rest, method sections
/// 5 and 13.4.

#include <array>
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

/// The same with the weight r on a meridian: (int_F r (v - m)^2)^{1/2} <= C (int_T r |grad v|^2)^{1/2}, m the
/// mean with weight r over T or over F. With the vertex a opposite to F, div(r (x - a)) = 3 r - a_r <= 3 r,
/// so H int_F r w^2 <= 3 ||w||^2 + 2 h_T ||w|| ||grad w||, H = 2 |T|/|F|; in w = v - mean_T(v), ||w|| <= h_T
/// / pi
/// ||grad w|| also with this weight, because r is log-concave.
[[nodiscard]] inline double meridian_trace_constant(double h, double measure, double volume)
{
  constexpr double pi = std::numbers::pi;
  return h * std::sqrt(measure / (2 * volume) * (3 / (pi * pi) + 2 / pi));
}

/// ||w - r||_T <= cell ||eps(w)||_T and ||w - r||_F <= facets[i] ||eps(w)||_T on the facet F opposite to
/// vertex i, r the nearest rigid motion each time, on Hill's simplex with the vertices 0, v_1, v_1 + v_2,
/// ..., |v_i| = 1 and v_i . v_j = gram for all i != j. With the rigid motion nearest on T, ||w - r|| has the
/// constant `trace` on any facet and `boundary` on all of them together, from which the others follow.
/// `scripts/constants` reads all of them from here and proves them.
template <int dim>
struct KornConstants
{
  double gram;
  double cell;
  std::array<double, dim + 1> facets;
  double trace;
  double boundary;
};

inline constexpr KornConstants<2> right_triangle{
    .gram = 0, .cell = 0.625, .facets = {1.999, 2.474, 1.999}, .trace = 2.592, .boundary = 3.588};
inline constexpr KornConstants<2> equilateral_triangle{
    .gram = -0.5, .cell = 0.387, .facets = {1.573, 1.573, 1.573}, .trace = 1.612, .boundary = 2.199};
inline constexpr KornConstants<3> path_tetrahedron{
    .gram = 0, .cell = 0.858, .facets = {4.449, 4.735, 4.735, 4.449}, .trace = 4.959, .boundary = 8.071};
inline constexpr KornConstants<3> disphenoid{.gram = -1.0 / 3,
                                             .cell = 0.505,
                                             .facets = {2.431, 2.431, 2.431, 2.431},
                                             .trace = 2.475,
                                             .boundary = 4.171};

}  // namespace tribound::certify
