#include "tribound/problem/field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "tribound/problem/formula.h"

namespace tribound::problem
{

Field::Field() = default;

Field::Field(double value, Where where) : value_(value), where_(std::move(where)) {}

Field::Field(FieldFunction function, Where where)
    : function_(std::make_shared<const FieldFunction>(std::move(function))), where_(std::move(where))
{
  assert(function_->values);
}

Field::Field(std::string text, Where where) : Field(std::move(text), std::move(where), {}) {}

Field::Field(std::string text, Where where, std::string name)
    : Field(std::move(text), std::move(where), std::move(name), 1)
{
}

Field::Field(std::string text, Where where, std::string name, double t)
    : where_(std::move(where)), name_(std::move(name))
{
  formula_ = std::make_shared<const Formula>(std::move(text), where_, t);
  if (formula_->uses_time()) in_time_ = std::make_shared<const std::string>(formula_->text());
  if (formula_->uses(0) || formula_->uses(1) || formula_->uses(2)) return;
  value_ = evaluate({});
  formula_.reset();
}

Field Field::at(double t) const
{
  if (function_ && function_->at) return Field(function_->at(t), where_);
  return in_time_ ? Field(*in_time_, where_, name_, t) : *this;
}

bool Field::uses_z() const
{
  return formula_ && formula_->uses(2);
}

int Field::degree() const
{
  if (function_) return function_->degree;
  return formula_ ? formula_->degree() : 0;
}

std::span<const Affine> Field::switches() const
{
  if (!formula_) return {};
  return formula_->switches();
}

double Field::evaluate(std::span<const double> x) const
{
  double value = 0;
  if (function_)
    function_->values(x, static_cast<int>(x.size()), {&value, 1});
  else
    value = (*formula_)(x);
  if (!std::isfinite(value)) fail(value, x);
  return value;
}

void Field::evaluate(std::span<const double> points, int dim, std::span<double> values) const
{
  if (is_constant())
  {
    std::ranges::fill(values, value_);
    return;
  }
  if (function_)
    function_->values(points, dim, values);
  else
    formula_->evaluate(points, dim, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) fail(values[i], points.subspan(i * dim, dim));
}

void Field::enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients) const
{
  enclose(vertices, dim, coefficients, Sides::inside);
}

void Field::enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients,
                    Sides sides) const
{
  if (formula_) return formula_->enclose(vertices, dim, coefficients, sides);
  if (function_)
  {
    std::ranges::fill(coefficients, Enclosure{});
    if (function_->enclose) function_->enclose(vertices, dim, coefficients);
    return;
  }
  for (Enclosure& coefficient : coefficients)
    coefficient = &coefficient == coefficients.data() ? Enclosure{value_, value_} : Enclosure{0.0, 0.0};
}

Enclosure Field::around(std::span<const double> x, double radius) const
{
  if (is_constant()) return {value_, value_};
  if (function_) return around_within_simplex(x, radius);
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
  std::ranges::transform(x, lower.begin(), [&](double coordinate) { return coordinate - radius; });
  std::ranges::transform(x, upper.begin(), [&](double coordinate) { return coordinate + radius; });
  return formula_->enclose_box(std::span(lower).first(x.size()), std::span(upper).first(x.size()));
}

/// Over a simplex that contains the box: x - r (1, ..., 1) and, from there, 2 dim r along each axis.
Enclosure Field::around_within_simplex(std::span<const double> x, double radius) const
{
  const std::size_t dim = x.size();
  std::vector<double> vertices;
  for (std::size_t v = 0; v <= dim; ++v)
    for (std::size_t d = 0; d < dim; ++d)
      vertices.push_back(x[d] - radius + (v == d + 1 ? 2 * static_cast<double>(dim) * radius : 0));
  std::array<Enclosure, 1> values;
  enclose(vertices, static_cast<int>(dim), values);
  return values[0];
}

void Field::fail(double value, std::span<const double> x) const
{
  const bool undefined = std::isnan(value);
  throw InputError(where_,
                   fmt::format("{} is {}{}",
                               !name_.empty() ? name_
                               : formula_     ? fmt::format("the formula \"{}\"", formula_->text())
                                              : "the function",
                               undefined ? "undefined (nan)" : fmt::format("{}", value),
                               x.empty() ? "" : fmt::format(" at the point ({:.9g})", fmt::join(x, ", "))),
                   !name_.empty()
                       ? "every direction is the nearest there: it is the centre of a surface, or on its axis"
                   : undefined ? "keep it defined, such as sqrt(max(x, 0)) for sqrt(x)"
                               : "keep it finite, such as 1/max(x, 1e-12) for 1/x");
}

std::string words(const Field& field, const std::string& unit)
{
  return field.is_constant() ? fmt::format("{:.6g}{}", field.constant(), unit) : "varies";
}

}  // namespace tribound::problem
