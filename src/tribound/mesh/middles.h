#pragma once

/// @file middles.h
/// The vertices that bisection makes.

#include <utility>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::mesh
{

/// The middles of edges, found by their ends. Each edge is in the list of its end with the larger number.
/// That is the newer end of an edge that bisection makes, so that the lists stay short.
class Middles
{
 public:
  explicit Middles(Index n_vertices) : first_(n_vertices, -1), n_vertices_(n_vertices) {}

  /// The vertex in the middle of the edge, or -1 when it is whole.
  [[nodiscard]] Index find(Index a, Index b) const
  {
    if (a < b) std::swap(a, b);
    Index middle = first_[a];
    while (middle >= 0 && edges_[middle - n_vertices_].lower_end != b)
      middle = edges_[middle - n_vertices_].next;
    return middle;
  }

  /// Gives the edge a middle: the vertex with the next number.
  Index add(Index a, Index b)
  {
    if (a < b) std::swap(a, b);
    const auto middle = static_cast<Index>(first_.size());
    edges_.push_back({b, first_[a]});
    first_[a] = middle;
    first_.push_back(-1);
    return middle;
  }

 private:
  struct Edge
  {
    Index lower_end;
    Index next;  ///< middle of the next edge with the same larger end, or -1
  };

  std::vector<Index> first_;  ///< per vertex: middle of an edge whose larger end it is, or -1
  std::vector<Edge> edges_;   ///< by number of the middle
  Index n_vertices_;          ///< without the middles
};

}  // namespace tribound::mesh
