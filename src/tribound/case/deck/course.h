#pragma once

/// @file course.h
/// A load of a deck as it follows the time of the steps.

#include <string>
#include <utility>
#include <vector>

#include "tribound/case/node.h"

namespace tribound::case_file
{

/// A piecewise linear function of t; two points at one t are a jump.
class Course
{
 public:
  struct Point
  {
    double t;
    double value;
  };

  /// t must not decrease.
  void add(double t, double value);
  [[nodiscard]] double last() const { return points_.empty() ? 0.0 : points_.back().value; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] bool is_constant() const;
  [[nodiscard]] bool operator==(const Course& other) const;

  /// factor times the function, as a datum of a case: a number if it is constant, or if only the last value
  /// counts; else a formula of t.
  [[nodiscard]] Node datum(double factor, bool only_last) const;

 private:
  std::vector<Point> points_{};
};

/// A datum as a factor of a formula.
[[nodiscard]] std::string as_factor(const Node& datum);

/// The sum of several, each with its factor; 0 without any.
[[nodiscard]] Node sum_of(const std::vector<std::pair<double, const Course*>>& terms, bool only_last);

}  // namespace tribound::case_file
