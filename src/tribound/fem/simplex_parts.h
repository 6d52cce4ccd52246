#pragma once

/// @file simplex_parts.h
/// Parts of the reference simplex, for integrals of functions that are not smooth on the whole of it.

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::fem
{

/// The vertices of a simplex inside the reference simplex.
template <int k>
using Part = std::array<Point<k>, k + 1>;

template <int k>
[[nodiscard]] Part<k> reference_simplex()
{
  Part<k> whole;
  whole[0].setZero();
  for (int i = 1; i <= k; ++i) whole[i] = Point<k>::Unit(i - 1);
  return whole;
}

/// The point of the part with the reference coordinates s in it.
template <int k>
[[nodiscard]] Point<k> point_in(const Part<k>& part, const Point<k>& s)
{
  Point<k> x = part[0];
  for (int i = 0; i < k; ++i) x += s[i] * (part[i + 1] - part[0]);
  return x;
}

/// |part| / |reference simplex|.
template <int k>
[[nodiscard]] double fraction(const Part<k>& part)
{
  Eigen::Matrix<double, k, k> edges;
  for (int i = 0; i < k; ++i) edges.col(i) = part[i + 1] - part[0];
  return std::abs(edges.determinant());
}

/// The two parts on either side of a new vertex x on the edge (i, j).
template <int k>
[[nodiscard]] std::array<Part<k>, 2> split(const Part<k>& part, int i, int j, const Point<k>& x)
{
  std::array<Part<k>, 2> halves{part, part};
  halves[0][j] = x;
  halves[1][i] = x;
  return halves;
}

/// Cuts a part along the zeros of an affine function with the given values at its vertices, into parts on
/// which it has one sign. Values of size `zero` or less count as 0.
template <int k>
void cut(const Part<k>& part, const std::array<double, k + 1>& values, double zero,
         std::vector<Part<k>>& parts)
{
  for (int i = 0; i <= k; ++i)
    for (int j = i + 1; j <= k; ++j)
    {
      if (std::abs(values[i]) <= zero || std::abs(values[j]) <= zero || values[i] * values[j] > 0) continue;
      const double t = values[i] / (values[i] - values[j]);
      const auto halves = split<k>(part, i, j, part[i] + t * (part[j] - part[i]));
      std::array<double, k + 1> first = values;
      std::array<double, k + 1> second = values;
      first[j] = second[i] = 0;
      cut<k>(halves[0], first, zero, parts);
      cut<k>(halves[1], second, zero, parts);
      return;
    }
  parts.push_back(part);
}

}  // namespace tribound::fem
