#pragma once

/// @file refined_segments.h
/// Contact segments on a refined mesh.

#include <optional>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/refine.h"

namespace tribound::certify
{

/// A part of a contact segment that lies in one facet of the refined mesh on each side.
template <int dim>
struct RefinedSegment
{
  std::size_t whole;                                     ///< number of the segment that contains it
  fem::Part<dim - 1> part;                               ///< its corners in the coordinates of that segment
  double measure;                                        ///< on the slave
  contact::SegmentSide<dim> slave;                       ///< facet of the refined mesh, and the part in it
  std::optional<contact::SegmentSide<dim>> master = {};  ///< the same

  /// |part| / |reference facet|.
  [[nodiscard]] double det() const { return mesh::factorial<dim - 1> * measure; }
  /// Calls visit(side) for the slave, then for the master if there is one.
  template <class Visit>
  void for_each_side(const Visit& visit) const
  {
    visit(slave);
    if (master) visit(*master);
  }
};

/// The segments of a mesh, cut at the facets of its refinement and at their images. Against an obstacle,
/// where segments are whole facets, the parts are facets; between bodies they are simplices. Parts below
/// 1e-14 of a segment are left out.
template <int dim>
[[nodiscard]] std::vector<RefinedSegment<dim>> refined_segments(
    const mesh::Mesh<dim>& mesh, std::span<const contact::ContactSegment<dim>> segments,
    const mesh::Refined<dim>& refined);

}  // namespace tribound::certify
