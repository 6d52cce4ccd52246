#include "tribound/case/deck/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tribound::case_file
{

void Course::add(double t, double value)
{
  if (!points_.empty() && points_.back().t == t && points_.back().value == value) return;
  // The middle one of three on a line is left out.
  if (points_.size() > 1)
  {
    const Point& a = points_[points_.size() - 2];
    Point& b = points_.back();
    const bool is_between = a.t < b.t && b.t < t;
    if (is_between && std::abs((value - a.value) * (b.t - a.t) - (b.value - a.value) * (t - a.t)) <=
                          1e-13 * (t - a.t) * (std::abs(a.value) + std::abs(value)))
    {
      b = {t, value};
      return;
    }
  }
  points_.push_back({t, value});
}

bool Course::is_constant() const
{
  return std::ranges::all_of(points_, [&](const Point& p) { return p.value == points_[0].value; });
}

bool Course::operator==(const Course& other) const
{
  return std::ranges::equal(points_, other.points_,
                            [](const Point& a, const Point& b) { return a.t == b.t && a.value == b.value; });
}

namespace
{

/// The first value, and for every slope and jump a term.
std::string formula_of(const std::vector<Course::Point>& points, double factor)
{
  std::string text = points[0].value == 0 ? "" : fmt::format("{}", factor * points[0].value);
  const auto add = [&](double coefficient, const std::string& function)
  {
    if (coefficient == 0) return;
    text += fmt::format("{}{}*{}", text.empty() || coefficient < 0 ? "" : "+", coefficient, function);
  };
  const double end = points.back().t;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    const auto& [a, from] = points[i - 1];
    const auto& [b, to] = points[i];
    if (a == b)
    {
      add(factor * (to - from), fmt::format("(t > {})", a));
      continue;
    }
    const std::string since = a == 0 ? "t" : fmt::format("(t - {})", a);
    const std::string until = b == end ? since : fmt::format("min({}, {})", since, b - a);
    add(factor * (to - from) / (b - a), a == 0 ? until : fmt::format("max(0, {})", until));
  }
  return text;
}

}  // namespace

Node Course::datum(double factor, bool only_last) const
{
  if (only_last || is_constant() || factor == 0) return {factor * last() + 0.0, {}};
  return {formula_of(points_, factor), {}};
}

std::string as_factor(const Node& datum)
{
  const double* number = std::get_if<double>(&datum.value);
  return number != nullptr ? fmt::format("{}", *number)
                           : fmt::format("({})", std::get<std::string>(datum.value));
}

Node sum_of(const std::vector<std::pair<double, const Course*>>& terms, bool only_last)
{
  double number = 0;
  std::string formula;
  for (const auto& [factor, course] : terms)
  {
    const Node node = course->datum(factor, only_last);
    if (const double* value = std::get_if<double>(&node.value))
      number += *value;
    else
      formula += fmt::format("{}({})", formula.empty() ? "" : " + ", std::get<std::string>(node.value));
  }
  if (formula.empty()) return {number, {}};
  if (terms.size() == 1) return terms[0].second->datum(terms[0].first, only_last);
  return {number == 0 ? formula : fmt::format("{} + {}", formula, number), {}};
}

}  // namespace tribound::case_file
