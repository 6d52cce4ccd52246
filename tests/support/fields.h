#pragma once

/// @file fields.h
/// Vectors of degrees of freedom for tests, and linear algebra in plain loops.

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/space.h"

namespace tribound::test
{

/// The nodal interpolant of a vector field.
template <int dim, class Field>
std::vector<double> interpolate(const fem::LagrangeSpace<dim>& space, Field field)
{
  std::vector<double> u;
  for (const Point<dim>& x : space.node_points())
  {
    const Point<dim> value = field(x);
    u.insert(u.end(), value.data(), value.data() + dim);
  }
  return u;
}

/// v with fixed entries set to 0.
inline std::vector<double> free_part(const fem::Constraints& constraints, std::span<const double> v)
{
  std::vector<double> result(v.begin(), v.end());
  for (std::size_t i = 0; i < result.size(); ++i)
    if (constraints.fixed[i]) result[i] = 0;
  return result;
}

/// Uniform in [-size, size], 0 at fixed degrees of freedom.
inline std::vector<double> random_free_vector(const fem::Constraints& constraints, double size, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<double> v(constraints.fixed.size());
  for (double& value : v) value = uniform(random);
  return free_part(constraints, v);
}

/// x + a y.
inline std::vector<double> sum(std::span<const double> x, double a, std::span<const double> y)
{
  std::vector<double> result(x.begin(), x.end());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += a * y[i];
  return result;
}

inline double norm(std::span<const double> v)
{
  double squares = 0;
  for (const double x : v) squares += x * x;
  return std::sqrt(squares);
}

inline double distance(std::span<const double> x, std::span<const double> y)
{
  return norm(sum(x, -1, y));
}

inline algebra::Triplets entries(const algebra::SparseRows& rows)
{
  algebra::Triplets result;
  for (int i = 0; i + 1 < static_cast<int>(rows.begin.size()); ++i)
    for (int k = rows.begin[i]; k < rows.begin[i + 1]; ++k) result.add(i, rows.columns[k], rows.values[k]);
  return result;
}

/// A x.
inline std::vector<double> multiply(const algebra::Triplets& a, std::span<const double> x)
{
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t k = 0; k < a.values.size(); ++k)
    if (a.rows[k] >= 0 && a.cols[k] >= 0) y[a.rows[k]] += a.values[k] * x[a.cols[k]];
  return y;
}

}  // namespace tribound::test
