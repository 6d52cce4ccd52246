#pragma once

/// @file point_grid.h
/// Finds points by their coordinates.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::certify
{

/// Points in the cells of a grid: what is near is in the same cell or in a neighbour of it. Keeps a
/// reference.
template <int dim>
class PointGrid
{
 public:
  PointGrid(std::span<const Point<dim>> points, double tolerance) : points_(points), tolerance_(tolerance)
  {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[key(points[i])].push_back(static_cast<Index>(i));
  }

  /// The points at most as far as the tolerance, ascending.
  [[nodiscard]] std::vector<Index> near(const Point<dim>& x) const
  {
    std::vector<Index> found;
    for_each_neighbour(key(x),
                       [&](const Key& neighbour)
                       {
                         const auto cell = cells_.find(neighbour);
                         if (cell == cells_.end()) return;
                         for (const Index i : cell->second)
                           if ((points_[i] - x).norm() <= tolerance_) found.push_back(i);
                       });
    std::ranges::sort(found);
    return found;
  }

 private:
  using Key = std::array<std::int64_t, dim>;
  struct Hash
  {
    std::size_t operator()(const Key& key) const
    {
      std::size_t hash = 0;
      for (const std::int64_t k : key) hash = 1000003 * hash + static_cast<std::size_t>(k);
      return hash;
    }
  };

  [[nodiscard]] Key key(const Point<dim>& x) const
  {
    Key key;
    for (int d = 0; d < dim; ++d) key[d] = static_cast<std::int64_t>(std::floor(x[d] / (4 * tolerance_)));
    return key;
  }

  template <class Visit>
  static void for_each_neighbour(const Key& centre, const Visit& visit)
  {
    constexpr int n = dim == 2 ? 9 : 27;
    for (int i = 0; i < n; ++i)
    {
      Key key = centre;
      for (int d = 0, rest = i; d < dim; ++d, rest /= 3) key[d] += rest % 3 - 1;
      visit(key);
    }
  }

  std::span<const Point<dim>> points_;
  double tolerance_;
  std::unordered_map<Key, std::vector<Index>, Hash> cells_;
};

}  // namespace tribound::certify
