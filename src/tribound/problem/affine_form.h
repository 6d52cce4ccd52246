#pragma once

/// @file affine_form.h
/// Affine parts of a formula, with their rounding errors.

#include <array>
#include <optional>
#include <span>

#include "tribound/problem/formula_program.h"

namespace tribound::problem
{

/// c_0 x + c_1 y + c_2 z + c_3, computed from terms whose absolute values add up to `size`.
struct AffineForm
{
  std::array<double, 4> c{};
  std::array<double, 4> size{};
  int n_operations = 1;

  [[nodiscard]] static AffineForm number(double value);
  [[nodiscard]] static AffineForm variable(int index);

  /// Whether it is the same everywhere; and whether it has never contained a variable.
  [[nodiscard]] bool is_constant() const { return c[0] == 0.0 && c[1] == 0.0 && c[2] == 0.0; }
  [[nodiscard]] bool is_number() const { return size[0] == 0.0 && size[1] == 0.0 && size[2] == 0.0; }
  /// Whether it is a variable compared with a number, so that its sign is computed without rounding.
  [[nodiscard]] bool is_shifted_variable() const;
  [[nodiscard]] double value(std::span<const double> x) const;
  /// The sum of the absolute values of all terms at `x`.
  [[nodiscard]] double scale(std::span<const double> x) const;
  /// A bound of the rounding errors where the terms sum up to `scale`.
  [[nodiscard]] double rounding(double scale) const;
};

[[nodiscard]] AffineForm operator-(const AffineForm& a);

/// The result of the binary operation `op` if it is affine again: +, -, a product with or a quotient by a
/// constant.
[[nodiscard]] std::optional<AffineForm> affine_result(Op op, const AffineForm& a, const AffineForm& b);

}  // namespace tribound::problem
