#pragma once

/// @file bernstein.h
/// Polynomials on the reference simplex in Bernstein's basis, whose coefficients enclose them.

#include <vector>

#include "tribound/fem/lagrange.h"
#include "tribound/fem/quadrature.h"

namespace tribound::fem
{

/// The matrix, [coefficient * rule.size() + point], that gives the coefficients b_a of q = sum_a b_a B_a, |a|
/// = degree, from the values of q at the points of a rule exact for products of two polynomials of the
/// degree. Then min b <= q <= max b on the simplex, since the B_a = |a|!/a! lambda^a are positive and add up
/// to 1; halving the simplex brings the b_a four times as close to q. If the values are not those of a
/// polynomial, the result is the L2 projection.
template <int k>
[[nodiscard]] std::vector<double> bernstein_from_points(const Quadrature<k>& rule, int degree);

/// The matrix, [node * n + coefficient], that gives the values of q = sum_a b_a B_a at the nodes of the basis
/// from b, both in the order of the nodes: a is that of LagrangeBasis::node(). On an edge or a facet of the
/// simplex, the coefficients of q are those of the nodes there.
template <int k>
[[nodiscard]] std::vector<double> values_from_bernstein(const LagrangeBasis<k>& basis);

/// Its inverse.
template <int k>
[[nodiscard]] std::vector<double> bernstein_from_values(const LagrangeBasis<k>& basis);

}  // namespace tribound::fem
