#pragma once

/// @file interfaces.h
/// Where the boundaries of bodies may touch and overlap: the two sides of a declared interface.

#include <set>
#include <span>
#include <utility>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// The interfaces of a mesh that is not verified yet. Facets are those of the topology with one cell; bodies
/// are the parts of the mesh connected through facets.
template <int dim>
class Interfaces
{
 public:
  Interfaces(const MeshData<dim>& data, const Topology<dim>& topology);

  [[nodiscard]] bool empty() const { return sides_.empty(); }
  /// Whether two facets are on opposite sides of one interface.
  [[nodiscard]] bool are_opposite(Index f, Index g) const;
  /// Whether one may cross the other: they are opposite, or belong to two bodies that an interface joins.
  [[nodiscard]] bool may_cross(Index f, Index g) const;
  /// Whether both sides of the facet's interface are on its body, so that it is a slit.
  [[nodiscard]] bool is_of_slit(Index f) const;
  /// Whether vertex v may lie on facet f, one of those that it lies on without being a corner. v must have a
  /// facet in an interface. f must belong to another body joined by that interface, or to a body with a facet
  /// among `touched` that is in an interface and of another body or opposite. So several bodies may meet in a
  /// point.
  [[nodiscard]] bool may_touch(Index v, Index f, std::span<const Index> touched) const;

 private:
  /// A side of an interface, -1 for none.
  struct Side
  {
    int interface = -1;
    int side = -1;
  };

  [[nodiscard]] int body(Index f) const { return body_of_cell_[topology_.facet_cells[f][0]]; }

  const Topology<dim>& topology_;
  std::vector<Side> sides_;                             ///< per facet; empty without interfaces
  std::vector<int> body_of_cell_;                       ///< the same
  std::vector<std::pair<Index, Index>> corner_facets_;  ///< vertex, facet in an interface; sorted
  std::set<std::pair<int, int>> joined_;                ///< bodies
};

}  // namespace tribound::mesh
