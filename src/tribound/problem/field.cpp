#include "tribound/problem/field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tribound/problem/formula.h"

namespace tribound::problem
{

std::string nonnegative_hint(const Where& where)
{
  const std::string cut = "a formula that changes sign can be cut off: \"max(0, ...)\"";
  if (!where.key.ends_with("gap")) return "0 or more; " + cut;
  return "0 or more; for an interference (a press fit) mesh the body clear of the obstacle and press it on "
         "by a "
         "prescribed displacement; " +
         cut;
}

Expression::Expression() = default;

Expression::Expression(double value, Where where) : value_(value), where_(std::move(where)) {}

Expression::Expression(std::string text, Where where) : where_(std::move(where))
{
  formula_ = std::make_shared<const Formula>(std::move(text), where_);
  if (formula_->uses(0) || formula_->uses(1) || formula_->uses(2)) return;
  value_ = evaluate({});
  formula_.reset();
}

bool Expression::uses_z() const
{
  return formula_ && formula_->uses(2);
}

int Expression::degree() const
{
  return formula_ ? formula_->degree() : 0;
}

std::span<const Affine> Expression::switches() const
{
  if (!formula_) return {};
  return formula_->switches();
}

double Expression::evaluate(std::span<const double> x) const
{
  const double value = (*formula_)(x);
  if (!std::isfinite(value)) fail(value, x);
  return value;
}

void Expression::evaluate(std::span<const double> points, int dim, std::span<double> values) const
{
  if (!formula_)
  {
    std::ranges::fill(values, value_);
    return;
  }
  formula_->evaluate(points, dim, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) fail(values[i], points.subspan(i * dim, dim));
}

void Expression::enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients) const
{
  enclose(vertices, dim, coefficients, Sides::inside);
}

void Expression::enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients,
                         Sides sides) const
{
  if (formula_) return formula_->enclose(vertices, dim, coefficients, sides);
  for (Enclosure& coefficient : coefficients)
    coefficient = &coefficient == coefficients.data() ? Enclosure{value_, value_} : Enclosure{0.0, 0.0};
}

Enclosure Expression::around(std::span<const double> x, double radius) const
{
  if (!formula_) return {value_, value_};
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
  std::ranges::transform(x, lower.begin(), [&](double coordinate) { return coordinate - radius; });
  std::ranges::transform(x, upper.begin(), [&](double coordinate) { return coordinate + radius; });
  return formula_->enclose_box(std::span(lower).first(x.size()), std::span(upper).first(x.size()));
}

void Expression::fail(double value, std::span<const double> x) const
{
  const bool undefined = std::isnan(value);
  throw InputError(where_,
                   fmt::format("the formula \"{}\" is {}{}", formula_->text(),
                               undefined ? "undefined (nan)" : fmt::format("{}", value),
                               x.empty() ? "" : fmt::format(" at the point ({:.9g})", fmt::join(x, ", "))),
                   undefined ? "keep it defined, such as sqrt(max(x, 0)) for sqrt(x)"
                             : "keep it finite, such as 1/max(x, 1e-12) for 1/x");
}

}  // namespace tribound::problem
