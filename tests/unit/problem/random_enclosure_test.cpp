#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "random_formula.h"
#include "tribound/problem/formula.h"

namespace tribound::random_enclosure_cases
{
namespace
{

const Where in_case_file{"case.toml", "load.body", 3, 1};

using Vertices = std::vector<double>;
using Coordinates = std::array<double, 3>;

std::vector<problem::Enclosure> enclose(const std::string& text, const Vertices& vertices, int dim, int order)
{
  std::vector<problem::Enclosure> coefficients(order + 1);
  problem::Formula(text, in_case_file).enclose(vertices, dim, coefficients);
  return coefficients;
}

/// A simplex with n_vertices vertices near a point of (-1, 1)^dim.
Vertices random_simplex(RandomFormulas& random, int dim, int n_vertices)
{
  const double size = std::exp(random.uniform(std::log(0.02), std::log(0.5)));
  Coordinates centre;
  for (double& coordinate : centre) coordinate = random.uniform(-1, 1);
  Vertices vertices;
  for (int i = 0; i < n_vertices * dim; ++i)
    vertices.push_back(centre[i % dim] + random.uniform(-size, size));
  return vertices;
}

/// A point with random barycentric coordinates, moved towards the centre by `shrink`.
Coordinates random_point(RandomFormulas& random, const Vertices& vertices, int dim, double shrink = 1.0)
{
  const int n = static_cast<int>(vertices.size()) / dim;
  std::vector<double> weights(n);
  double sum = 0.0;
  for (double& weight : weights) sum += weight = -std::log(random.uniform(1e-9, 1));
  Coordinates x{};
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < dim; ++k)
      x[k] += vertices[i * dim + k] * (shrink * weights[i] / sum + (1 - shrink) / n);
  return x;
}

Coordinates centre_of(const Vertices& vertices, int dim)
{
  Coordinates c{};
  for (std::size_t i = 0; i < vertices.size(); ++i)
    c[i % dim] += vertices[i] * dim / static_cast<double>(vertices.size());
  return c;
}

/// Coefficients of a Taylor series, with an estimate of their errors.
struct Series
{
  std::array<long double, 15> value;
  std::array<long double, 15> error;
};

/// Coefficients of the polynomial in t that interpolates f(xi + t d) at t = -7h, ..., 7h (Newton's form);
/// they are those of the Taylor series up to the interpolation error.
std::array<long double, 15> interpolated_series(const FormulaTree& f, const Coordinates& xi,
                                                const Coordinates& d, long double h)
{
  constexpr int n = 15;
  std::array<long double, n> difference;
  const auto node = [](int i) { return static_cast<long double>(i % 2 == 0 ? -i / 2 : (i + 1) / 2); };
  for (int i = 0; i < n; ++i)
  {
    const long double t = h * node(i);
    const long double x[3] = {xi[0] + t * d[0], xi[1] + t * d[1], xi[2] + t * d[2]};
    difference[i] = f.value(x);
  }
  for (int k = 1; k < n; ++k)
    for (int i = n - 1; i >= k; --i)
      difference[i] = (difference[i] - difference[i - 1]) / (node(i) - node(i - k));
  std::array<long double, n> c{};
  for (int i = n - 1; i >= 0; --i)
  {
    for (int k = n - 1; k > 0; --k) c[k] = c[k - 1] - node(i) * c[k];
    c[0] = difference[i] - node(i) * c[0];
  }
  long double power = 1;
  for (long double& coefficient : c)
  {
    coefficient /= power;
    power *= h;
  }
  return c;
}

/// The Taylor series of f(xi + t d) by interpolation; without convergence the error is large or nan.
Series taylor_series(const FormulaTree& f, const Coordinates& xi, const Coordinates& d)
{
  constexpr long double h = 0.1L;
  constexpr long double smaller = 0.08L;
  constexpr long double rounding = 1e-17L;
  Series series = {interpolated_series(f, xi, d, h), {}};
  const auto other = interpolated_series(f, xi, d, smaller);
  long double scale = 0.0;
  for (int n = 0; n < 15; ++n) scale += std::abs(series.value[n]) * std::pow(7 * h, n);
  for (int n = 0; n < 15; ++n)
    series.error[n] = 10 * std::abs(series.value[n] - other[n]) + rounding * scale / std::pow(smaller, n) +
                      std::numeric_limits<double>::min();
  return series;
}

/// Whether `enclosure` holds a value of `formula` within rounding of `x`. Used where rounding decides, as in
/// y == x - (x - y).
bool contains_near(const problem::Enclosure& enclosure, const problem::Formula& formula, const Coordinates& x,
                   int dim)
{
  for (int k = 0; k < dim; ++k)
    for (int i = -8; i <= 8; ++i)
    {
      Coordinates near = x;
      near[k] *= 1 + 3e-16 * i;
      if (enclosure.contains(formula(std::span(near).first(dim)))) return true;
    }
  return false;
}

struct Shape
{
  int dim;
  int n_vertices;
};

class Enclosures : public testing::TestWithParam<Shape>
{
};

TEST_P(Enclosures, HoldTheValues)
{
  const auto [dim, n_vertices] = GetParam();
  RandomFormulas random(10 + n_vertices);
  int n_bounded = 0;
  for (int i = 0; i < 6000; ++i)
  {
    const std::string text = random.text(random.tree(1 + i % 4, false));
    const problem::Formula formula(text, in_case_file);
    const Vertices vertices = random_simplex(random, dim, n_vertices);
    std::array<problem::Enclosure, 3> coefficients;
    formula.enclose(vertices, dim, coefficients);
    if (!coefficients[0].bounded()) continue;
    ++n_bounded;
    for (int j = 0; j < 20; ++j)
    {
      const Coordinates x = random_point(random, vertices, dim);
      const double value = formula(std::span(x).first(dim));
      ASSERT_TRUE(std::isnan(value) || coefficients[0].contains(value) ||
                  contains_near(coefficients[0], formula, x, dim))
          << text << ": " << value << " not in " << coefficients[0].lower << ", " << coefficients[0].upper;
    }
  }
  EXPECT_GT(n_bounded, 3000);
}

TEST_P(Enclosures, HoldTheDerivatives)
{
  const auto [dim, n_vertices] = GetParam();
  constexpr int max_order = 7;
  RandomFormulas random(20 + n_vertices);
  int n_compared = 0;
  for (int i = 0; i < 3000; ++i)
  {
    const FormulaTree tree = random.tree(1 + i % 4, i % 2 == 0);
    const std::string text = random.text(tree);
    const Vertices vertices = random_simplex(random, dim, n_vertices);
    const std::vector<problem::Enclosure> coefficients = enclose(text, vertices, dim, max_order);
    const Coordinates c = centre_of(vertices, dim);
    for (int j = 0; j < 3; ++j)
    {
      const Coordinates xi = random_point(random, vertices, dim, 0.5);
      const Coordinates x = random_point(random, vertices, dim);
      const Coordinates d = {x[0] - c[0], x[1] - c[1], x[2] - c[2]};
      const Series series = taylor_series(tree, xi, d);
      for (int n = 0; n <= max_order && coefficients[n].bounded(); ++n)
      {
        const long double value = series.value[n];
        const long double error = series.error[n];
        if (!(error < 0.01L * std::abs(value))) continue;
        ++n_compared;
        ASSERT_TRUE(coefficients[n].lower <= value + error && value - error <= coefficients[n].upper)
            << text << ": coefficient " << n << " is " << static_cast<double>(value) << ", not in "
            << coefficients[n].lower << ", " << coefficients[n].upper;
      }
    }
  }
  EXPECT_GT(n_compared, 10000);
}

TEST_P(Enclosures, BoundTaylorsRemainder)
{
  const auto [dim, n_vertices] = GetParam();
  constexpr int max_order = 6;
  RandomFormulas random(30 + n_vertices);
  int n_compared = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const FormulaTree tree = random.tree(1 + i % 4, true);
    const Vertices vertices = random_simplex(random, dim, n_vertices);
    const std::vector<problem::Enclosure> coefficients = enclose(random.text(tree), vertices, dim, max_order);
    const Coordinates c = centre_of(vertices, dim);
    const Coordinates x = random_point(random, vertices, dim);
    const Series series = taylor_series(tree, c, {x[0] - c[0], x[1] - c[1], x[2] - c[2]});
    const long double at[3] = {x[0], x[1], x[2]};
    long double remainder = tree.value(at);
    long double error = 1e-17L * std::abs(remainder) + std::numeric_limits<double>::min();
    for (int n = 0; n <= max_order && coefficients[n].bounded() && !std::isnan(error); ++n)
    {
      if (error < 0.1L * std::abs(remainder)) ++n_compared;
      ASSERT_LE(std::abs(remainder), coefficients[n].magnitude() + error)
          << random.text(tree) << " order " << n;
      remainder -= series.value[n];
      error += series.error[n];
    }
  }
  EXPECT_GT(n_compared, 5000);
}

INSTANTIATE_TEST_SUITE_P(Simplices, Enclosures,
                         testing::Values(Shape{2, 2}, Shape{2, 3}, Shape{3, 3}, Shape{3, 4}),
                         [](const auto& shape)
                         {
                           return "of" + std::to_string(shape.param.n_vertices) + "VerticesIn" +
                                  std::to_string(shape.param.dim) + "D";
                         });

}  // namespace
}  // namespace tribound::random_enclosure_cases
