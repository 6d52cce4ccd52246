#pragma once

/// @file box_tree.h
/// Search for the boxes that a line or another box meets.

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "tribound/mesh/geometry.h"

namespace tribound::mesh
{

/// The part of first <= l <= last where from + l direction is in the box; empty if the result descends.
template <int dim>
[[nodiscard]] std::array<double, 2> part_in_box(const BoundingBox<dim>& box, const Point<dim>& from,
                                                const Point<dim>& direction, std::array<double, 2> interval)
{
  auto& [first, last] = interval;
  for (int i = 0; i < dim; ++i)
  {
    if (direction[i] == 0)
    {
      if (from[i] < box.lower[i] || from[i] > box.upper[i]) return {0, -1};
      continue;
    }
    const double a = (box.lower[i] - from[i]) / direction[i];
    const double b = (box.upper[i] - from[i]) / direction[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return interval;
}

/// Whether they have a point in common.
template <int dim>
[[nodiscard]] bool meet(const BoundingBox<dim>& a, const BoundingBox<dim>& b)
{
  return (a.lower.array() <= b.upper.array()).all() && (a.upper.array() >= b.lower.array()).all();
}

/// Square of the distance of x from the box; 0 inside.
template <int dim>
[[nodiscard]] double square_distance(const BoundingBox<dim>& box, const Point<dim>& x)
{
  return (x - x.cwiseMax(box.lower).cwiseMin(box.upper)).squaredNorm();
}

/// A binary tree of boxes: O(n log n) to build; a search descends into the boxes that it accepts.
template <int dim>
class BoxTree
{
 public:
  explicit BoxTree(std::span<const BoundingBox<dim>> boxes) : order_(boxes.size())
  {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (!boxes.empty()) build(boxes, 0, boxes.size());
  }

  /// Calls visit(k) for every given box k in boxes that all satisfy accept(box).
  template <class Accept, class Visit>
  void traverse(const Accept& accept, const Visit& visit) const
  {
    std::vector<std::size_t> open;
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty())
    {
      const std::size_t number = open.back();
      const Node& node = nodes_[number];
      open.pop_back();
      if (!accept(node.box)) continue;
      if (node.second == 0)
        for (std::size_t k = node.begin; k < node.end; ++k) visit(order_[k]);
      else
      {
        open.push_back(number + 1);
        open.push_back(node.second);
      }
    }
  }

 private:
  struct Node
  {
    BoundingBox<dim> box;
    std::size_t begin;
    std::size_t end;
    std::size_t second;  ///< the first child is the next node; 0 for a leaf
  };
  static constexpr std::size_t leaf_size = 8;

  std::size_t build(std::span<const BoundingBox<dim>> boxes, std::size_t begin, std::size_t end)
  {
    const std::size_t number = nodes_.size();
    Node node{{}, begin, end, 0};
    for (std::size_t k = begin; k < end; ++k)
    {
      node.box.add(boxes[order_[k]].lower);
      node.box.add(boxes[order_[k]].upper);
    }
    nodes_.push_back(node);
    if (end - begin <= leaf_size) return number;
    int axis = 0;
    (node.box.upper - node.box.lower).maxCoeff(&axis);
    const auto centre = [&](std::size_t f) { return boxes[f].lower[axis] + boxes[f].upper[axis]; };
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](std::size_t a, std::size_t b) { return centre(a) < centre(b); });
    build(boxes, begin, middle);
    const std::size_t second = build(boxes, middle, end);
    nodes_[number].second = second;
    return number;
  }

  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace tribound::mesh
