#pragma once

/// @file expression.h
/// A number or a formula in x, y, z from the case file.

#include <memory>
#include <span>
#include <string>

#include "base/error.h"
#include "base/types.h"

namespace tribound
{

/// A scalar datum: a constant, or a formula in x, y, z (muParser syntax; pi and e are constants).
/// Evaluation is not thread-safe on one object; copies are independent.
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

  Expression(const Expression& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(const Expression& other);
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// The value at `x` (z = 0 in 2D). Throws InputError naming the key and the point if it is not finite.
  template <int dim>
  [[nodiscard]] double operator()(const Point<dim>& x) const
  {
    if (!formula_) return value_;
    return evaluate({x.data(), dim});
  }

  /// Whether the value is the same everywhere (a number, or a formula without x, y, z).
  [[nodiscard]] bool is_constant() const { return !formula_; }
  /// Whether it is the constant 0.
  [[nodiscard]] bool is_zero() const { return !formula_ && value_ == 0.0; }
  /// Whether the formula names z.
  [[nodiscard]] bool uses_z() const;
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  struct Formula;
  [[nodiscard]] double evaluate(std::span<const double> x) const;

  double value_ = 0.0;
  std::unique_ptr<Formula> formula_;  ///< null for a constant
  Where where_;
};

}  // namespace tribound
