#pragma once

/// @file normal_field.h
/// The direction along which contact acts, in place of the normal of the facet.

#include <array>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::problem
{

/// A field of unit vectors N(x) that point out of the body.
class NormalField
{
 public:
  /// N by its components, one per dimension. It must have length 1 everywhere, not only where it is
  /// evaluated, as formulas divided by their length do.
  explicit NormalField(std::vector<Field> components);

  /// N at x. Throws InputError naming the point where its length is not 1 up to rounding.
  template <int dim>
  [[nodiscard]] Point<dim> operator()(const Point<dim>& x) const;
  /// The same at all points: n[q] = N(x[q]). Much faster than one by one where N is given by formulas.
  template <int dim>
  void evaluate(std::span<const Point<dim>> x, std::span<Point<dim>> n) const;

  [[nodiscard]] std::span<const Field> components() const { return components_; }
  [[nodiscard]] std::span<Field> components() { return components_; }
  [[nodiscard]] bool is_constant() const;
  /// Whether all components are enclosed.
  [[nodiscard]] bool is_enclosed() const;

 private:
  /// n divided by its length, which is 1 up to rounding; else throws.
  template <int dim>
  [[nodiscard]] Point<dim> checked(const Point<dim>& n, const Point<dim>& x) const;

  std::vector<Field> components_;
};

/// How far N may be from polynomials on a simplex: upper bounds of the largest |N - P|, at most 1.
struct NormalDeviation
{
  double linear = 0;     ///< P of degree 1
  double quadratic = 0;  ///< P of degree 2
};

/// Over the convex hull of the points vertices[i*dim + k], from enclosures. Components that have none count
/// as 0.
[[nodiscard]] NormalDeviation deviation(const NormalField& normal, std::span<const double> vertices, int dim);

}  // namespace tribound::problem
