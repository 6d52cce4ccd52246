#pragma once

/// @file twin_facets.h
/// Matching facets of two bodies, and how bisection keeps them matching.

#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Two facets of the boundary that lie opposite one another corner by corner.
template <int dim>
struct TwinFacets
{
  std::array<Index, 2> cells;
  std::array<std::array<Index, dim>, 2> vertices;  ///< number i of one opposite number i of the other
};

/// The edges opposite to edges of twins while these are bisected. In 3D only twins count whose marked edges
/// are opposite to one another (mesh/marked_cell.h): both are then cut the same way as long as the same edges
/// are halved.
template <int dim>
class OppositeEdges
{
 public:
  /// The edge between the same vertices of the other facet.
  struct Edge
  {
    Index a, b;
    int side;  ///< twice the number of the twins, one more for edges of the second facet
  };

  OppositeEdges(const Mesh<dim>& mesh, std::span<const TwinFacets<dim>> twins);

  /// The edges opposite to that between a and b, over the twins that have both ends.
  [[nodiscard]] std::vector<Edge> of(Index a, Index b) const;
  /// Declares two middles opposite: that of an edge of this side and that of the opposite edge.
  void link(Index middle, int side, Index opposite);

 private:
  struct Opposite
  {
    int side;
    Index vertex;

    friend bool operator==(const Opposite&, const Opposite&) = default;
  };

  void add(Index vertex, const Opposite& opposite);

  std::unordered_map<Index, std::vector<Opposite>> at_;  ///< by vertex
};

}  // namespace tribound::mesh
