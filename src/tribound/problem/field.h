#pragma once

/// @file field.h
/// A number or a formula in x, y, z from the case file.

#include <memory>
#include <span>
#include <string>

#include "tribound/base/error.h"
#include "tribound/base/types.h"

namespace tribound::problem
{

struct Affine;
struct Enclosure;
class Formula;
enum class Sides;

/// What would be right where the gap or the threshold found there is negative.
[[nodiscard]] std::string nonnegative_hint(const Where& where);

/// A scalar datum: a constant, or a formula in x, y, z. Use of one object by several threads at once is safe.
/// What it returns of a formula is described in formula.h.
class Expression
{
 public:
  /// The constant 0.
  Expression();

  /// The constant `value`, found at `where`.
  explicit Expression(double value, Where where = {});

  /// The formula `text`, found at `where`. Without x, y, z in it, it is folded to a constant.
  /// Throws InputError: a syntax error or an unknown name (with the position in `text`), more than one
  /// result ("1,5"), an assignment, a constant that is not finite.
  Expression(std::string text, Where where);

  /// The value at `x` (z = 0 in 2D). Throws InputError naming the key and the point if it is not finite.
  template <int dim>
  [[nodiscard]] double operator()(const Point<dim>& x) const
  {
    if (!formula_) return value_;
    return evaluate({x.data(), dim});
  }

  /// The values at all points, x[i*dim + k]. Throws as the evaluation at a point does.
  void evaluate(std::span<const double> points, int dim, std::span<double> values) const;

  /// Total degree of a polynomial, 0 for a constant, otherwise Formula::not_polynomial.
  [[nodiscard]] int degree() const;
  /// Where it may jump or kink: Formula::switches.
  [[nodiscard]] std::span<const Affine> switches() const;
  /// Values and derivatives over the convex hull of `vertices`: Formula::enclose.
  void enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients) const;
  void enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients,
               Sides sides) const;
  /// All values within `radius` of `x` in every coordinate.
  [[nodiscard]] Enclosure around(std::span<const double> x, double radius) const;

  /// Whether the value is the same everywhere (a number, or a formula without x, y, z).
  [[nodiscard]] bool is_constant() const { return !formula_; }
  /// Whether it is the constant 0.
  [[nodiscard]] bool is_zero() const { return !formula_ && value_ == 0.0; }
  /// Whether the formula names z.
  [[nodiscard]] bool uses_z() const;
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  [[nodiscard]] double evaluate(std::span<const double> x) const;
  [[noreturn]] void fail(double value, std::span<const double> x) const;

  double value_ = 0.0;
  std::shared_ptr<const Formula> formula_;  ///< null for a constant
  Where where_;
};

}  // namespace tribound::problem
