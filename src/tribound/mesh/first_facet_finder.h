#pragma once

/// @file first_facet_finder.h
/// Locates facets of a mesh in those of the first mesh.

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/first_facets.h"

namespace tribound::mesh
{

/// Finds facets of later meshes in those of the first one.
template <int dim>
class FirstFacetFinder
{
 public:
  /// Searches the groups for which `is_meant(tag)`. Keeps a reference.
  FirstFacetFinder(const FirstFacets& facets, const std::function<bool(int)>& is_meant);

  struct Place
  {
    std::size_t facet;  ///< of FirstFacets
    /// Per vertex of the given facet; 0 and 1 are not rounded.
    std::array<std::array<double, dim>, dim> barycentric;
  };
  /// The facet of this group that contains the facet with these vertices.
  [[nodiscard]] Place operator()(int tag, const std::array<Point<dim>, dim>& vertices) const;

 private:
  const FirstFacets& facets_;
  std::vector<std::size_t> meant_;
  BoxTree<dim> tree_{{}};
};

}  // namespace tribound::mesh
