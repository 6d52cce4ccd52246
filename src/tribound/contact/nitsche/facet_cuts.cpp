#include "tribound/contact/nitsche/facet_cuts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// Relative to a facet; anything shorter is rounding.
constexpr double shortest = 1e-9;

}  // namespace

template <int dim>
bool facets_match(const mesh::Mesh<dim>& mesh, std::span<const ContactSegment<dim>> segments)
{
  return !mesh.ranks().any(!std::ranges::all_of(
      segments, [&](const ContactSegment<dim>& segment) { return is_whole(mesh, segment); }));
}

std::vector<mesh::FacetCuts> facet_cuts(const mesh::Mesh<2>& mesh,
                                        std::span<const ContactSegment<2>> segments)
{
  std::map<std::pair<Index, int>, std::vector<double>> ends;  // by facet
  const auto add = [&](const SegmentSide<2>& side)
  {
    if (!side.part || side.facet.cell >= mesh.n_owned_cells()) return;
    for (const Point<1>& end : *side.part)
      if (end[0] > shortest && end[0] < 1 - shortest)
        ends[{side.facet.cell, side.facet.local}].push_back(end[0]);
  };
  for (const ContactSegment<2>& segment : segments) segment.for_each_side(add);
  std::vector<mesh::FacetCuts> cuts;
  for (auto& [facet, at] : ends)
  {
    std::ranges::sort(at);
    const auto same = [](double a, double b) { return b - a <= shortest; };
    at.erase(std::unique(at.begin(), at.end(), same), at.end());
    cuts.push_back({facet.first, facet.second, std::move(at)});
  }
  return cuts;
}

template <int dim>
void erase_slivers(const mesh::Mesh<dim>& mesh, std::vector<ContactSegment<dim>>& segments)
{
  std::erase_if(segments,
                [&](const ContactSegment<dim>& segment)
                {
                  const mesh::BoundaryFacet& facet = segment.slave.facet;
                  return segment.measure <=
                         shortest * mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
                });
}

template bool facets_match(const mesh::Mesh<2>&, std::span<const ContactSegment<2>>);
template bool facets_match(const mesh::Mesh<3>&, std::span<const ContactSegment<3>>);
template void erase_slivers(const mesh::Mesh<2>&, std::vector<ContactSegment<2>>&);
template void erase_slivers(const mesh::Mesh<3>&, std::vector<ContactSegment<3>>&);

}  // namespace tribound::contact
