#pragma once

/// @file field.h
/// The data of a problem: scalar functions of position, each a number, a formula or a function of a program.

#include <functional>
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

/// What to do about a negative value where none is allowed.
inline constexpr const char* nonnegative_hint =
    "0 or more; a formula that changes sign can be cut off: \"max(0, ...)\"";

/// A function given by a program, at many points at once.
struct FieldFunction
{
  /// values[i] = f(x[i*dim], ..., x[i*dim + dim - 1]). Called by several threads at once.
  std::function<void(std::span<const double> x, int dim, std::span<double> values)> values;
  /// Its total degree if it is a polynomial.
  int degree = not_polynomial;
  /// Values and derivatives over simplices, as Formula::enclose gives them. If this is empty and the function
  /// is no polynomial, its values between the points of evaluation are unknown: the certificate then says
  /// that this is not covered.
  std::function<void(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients)> enclose =
      {};
  /// The function at the load factor t, if it varies with t; it is then given for t = 1.
  std::function<FieldFunction(double t)> at = {};

  static constexpr int not_polynomial = 1'000'000;
};

/// A scalar datum. Several threads may use one object at once; copies are cheap. Its results for a formula
/// are described in formula.h.
class Field
{
 public:
  /// The constant 0.
  Field();

  /// The constant `value`, found at `where`.
  Field(double value, Where where = {});

  /// The function; `where` stands for it in messages.
  explicit Field(FieldFunction function, Where where = {.file = {}, .key = "a function of the program"});

  /// The formula `text` for t = 1, found at `where`. If it names none of x, y, z, it is folded to a constant.
  /// Throws InputError: a syntax error or an unknown name (with the position in `text`), more than one result
  /// ("1,5"), an assignment, a constant that is not finite.
  Field(std::string text, Where where);
  /// The same; messages about its values call it `name`.
  Field(std::string text, Where where, std::string name);

  /// The same datum at the load factor t. Throws InputError if it is then a constant that is not finite.
  [[nodiscard]] Field at(double t) const;
  /// Whether it varies with t: a formula that names t, or a function with FieldFunction::at.
  [[nodiscard]] bool uses_time() const { return in_time_ != nullptr || (function_ && function_->at); }

  /// The value at `x` (z = 0 in 2D). Throws InputError naming the key and the point if it is not finite.
  template <int dim>
  [[nodiscard]] double operator()(const Point<dim>& x) const
  {
    if (is_constant()) return value_;
    return evaluate({x.data(), dim});
  }

  /// The values at all points, x[i*dim + k]. Throws as the evaluation at a point does.
  void evaluate(std::span<const double> points, int dim, std::span<double> values) const;
  template <int dim>
  void evaluate(std::span<const Point<dim>> points, std::span<double> values) const
  {
    if (!points.empty()) evaluate({points.front().data(), dim * points.size()}, dim, values);
  }

  /// Total degree of a polynomial, 0 for a constant, otherwise FieldFunction::not_polynomial.
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
  [[nodiscard]] bool is_constant() const { return !formula_ && !function_; }
  /// The value of a constant.
  [[nodiscard]] double constant() const { return value_; }
  /// Whether it is the constant 0.
  [[nodiscard]] bool is_zero() const { return is_constant() && value_ == 0.0; }
  /// Whether enclose() knows anything: true for all but functions without FieldFunction::enclose.
  [[nodiscard]] bool is_enclosed() const { return !function_ || function_->enclose; }
  /// Whether it is a formula that names z.
  [[nodiscard]] bool uses_z() const;
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  Field(std::string text, Where where, std::string name, double t);
  [[nodiscard]] double evaluate(std::span<const double> x) const;
  [[nodiscard]] Enclosure around_within_simplex(std::span<const double> x, double radius) const;
  [[noreturn]] void fail(double value, std::span<const double> x) const;

  double value_ = 0.0;
  std::shared_ptr<const Formula> formula_;         ///< or null
  std::shared_ptr<const FieldFunction> function_;  ///< or null
  std::shared_ptr<const std::string> in_time_;     ///< the formula where it names t; else null
  Where where_;
  std::string name_;  ///< for messages; empty: the formula itself
};

/// The value of a constant, followed by `unit`; "varies" otherwise.
[[nodiscard]] std::string words(const Field& field, const std::string& unit = {});

}  // namespace tribound::problem
