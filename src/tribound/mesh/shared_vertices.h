#pragma once

/// @file shared_vertices.h
/// What bisection on several ranks has to communicate: edges halved on the common surface of their cells.

#include <array>
#include <functional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tribound/mesh/partition.h"
#include "tribound/mesh/twin_facets.h"

namespace tribound::mesh
{

/// The names of the vertices of a part and of the middles that bisection adds, and the other ranks that have
/// them. A middle is on the ranks that have both ends; they know of it, or are told. The owner of a ghost
/// with one of the twins counts as having its vertices.
template <int dim>
class SharedVertices
{
 public:
  SharedVertices(const Partition<dim>& partition, std::span<const TwinFacets<dim>> twins);

  [[nodiscard]] const VertexName<dim>& name(Index v) const { return names_[v]; }
  /// The next vertex is the middle of a and b. `is_news`: the other ranks that have it do not know of it.
  void add_middle(Index a, Index b, bool is_news);
  /// Tells the other ranks of the middles that are news, and calls halve(a, b) for each edge that they have
  /// halved. False if no rank had any. All ranks call it together.
  bool exchange(const std::function<void(Index, Index)>& halve);

 private:
  [[nodiscard]] std::span<const int> sharers_of(Index v) const;

  Ranks ranks_;
  std::vector<VertexName<dim>> names_;
  std::unordered_map<Index, std::vector<int>> sharers_;                 ///< of those that have any, ascending
  std::unordered_map<VertexName<dim>, Index, VertexHash<dim>> shared_;  ///< these and those of twins, by name
  std::vector<std::array<Index, 3>> news_;                              ///< ends of an edge, its middle
};

}  // namespace tribound::mesh
