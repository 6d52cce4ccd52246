#pragma once

/// @file datum.h
/// A datum of the problem: a sum of fields, each in a direction.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::contact
{

/// f(x) = sum_j value_j(x) direction_j, with n components.
template <int dim, int n = dim>
struct Datum
{
  struct Term
  {
    const problem::Field* value;
    Point<n> direction;
  };
  std::vector<Term> terms;

  [[nodiscard]] Point<n> operator()(const Point<dim>& x) const { return (*this)(std::span(&x, 1)).front(); }
  /// At all points; functions of a program are called once.
  [[nodiscard]] std::vector<Point<n>> operator()(std::span<const Point<dim>> points) const;
  /// The largest degree of a term; not_polynomial if a term is not a polynomial.
  [[nodiscard]] int degree() const;
  /// Whether all terms are enclosed.
  [[nodiscard]] bool is_enclosed() const;
};

}  // namespace tribound::contact
