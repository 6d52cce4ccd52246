#pragma once

/// @file symmetric_rules.h
/// Tables of fully symmetric rules on the triangle and the tetrahedron; weights are positive, points inside.

#include <array>
#include <cstddef>
#include <span>

namespace tribound::fem
{

/// All points obtained from one by permuting its barycentric coordinates. Each has the same weight, relative
/// to the measure of the simplex. The names in the tables tell which coordinates are equal: s211(w, a, b) has
/// twelve points (a, a, b, 1 - 2a - b).
template <int k>
struct Orbit
{
  double weight;
  std::array<double, k + 1> lambda;
};

/// The orbits of a rule exact to the degree or beyond; none above the degrees of the tables.
template <int k>
[[nodiscard]] std::span<const Orbit<k>> symmetric_rule(int degree);

template <>
[[nodiscard]] std::span<const Orbit<2>> symmetric_rule<2>(int degree);
template <>
[[nodiscard]] std::span<const Orbit<3>> symmetric_rule<3>(int degree);

/// A rule and the degree up to which it is exact.
template <int k>
struct SymmetricRule
{
  int degree;
  std::span<const Orbit<k>> orbits;
};

/// Rules by ascending degree.
template <int k, std::size_t n>
using SymmetricRules = std::array<SymmetricRule<k>, n>;

template <int k, std::size_t n>
[[nodiscard]] std::span<const Orbit<k>> find_rule(const SymmetricRules<k, n>& rules, int degree)
{
  for (const SymmetricRule<k>& rule : rules)
    if (degree <= rule.degree) return rule.orbits;
  return {};
}

}  // namespace tribound::fem
