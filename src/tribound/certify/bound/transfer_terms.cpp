#include "tribound/certify/bound/transfer_terms.h"

#include <algorithm>
#include <array>
#include <utility>

#include "tribound/contact/pairing/polygon.h"

namespace tribound::certify
{

namespace
{

/// The parts of a facet that one slave facet covers; they do not overlap.
template <int dim>
struct Covered
{
  std::size_t slave;  ///< number of the facet
  std::vector<TractionPiece<dim>> pieces;
};

/// The centre of a boundary facet, for sorting: the order of numbers differs between ranks.
template <int dim>
std::array<double, dim> place(const mesh::Mesh<dim>& mesh, std::size_t number)
{
  const mesh::BoundaryFacet& facet = mesh.boundary()[number];
  const Point<dim> centre =
      mesh::facet_map(mesh, facet.cell, facet.local)(Point<dim - 1>::Constant(1.0 / dim));
  std::array<double, dim> coordinates;
  std::ranges::copy(centre, coordinates.begin());
  return coordinates;
}

bool overlap(const Covered<3>& a, const Covered<3>& b)
{
  return std::ranges::any_of(a.pieces,
                             [&](const TractionPiece<3>& x)
                             {
                               return std::ranges::any_of(b.pieces, [&](const TractionPiece<3>& y)
                                                          { return contact::overlap<3>(x.part, y.part); });
                             });
}

/// Where slaves are concave, the images of their facets along the normals may overlap.
template <int dim>
std::vector<std::vector<TractionPiece<dim>>> grouped(std::vector<Covered<dim>>&& covered)
{
  std::vector<std::vector<Covered<dim>>> groups;
  for (Covered<dim>& next : covered)
  {
    auto group = groups.begin();
    if constexpr (dim == 3)
      group = std::ranges::find_if(groups,
                                   [&](const std::vector<Covered<3>>& others) {
                                     return std::ranges::none_of(others, [&](const Covered<3>& other)
                                                                 { return overlap(other, next); });
                                   });
    if (group == groups.end()) group = groups.emplace(groups.end());
    group->push_back(std::move(next));
  }
  std::vector<std::vector<TractionPiece<dim>>> result;
  for (std::vector<Covered<dim>>& group : groups)
  {
    auto& pieces = result.emplace_back();
    for (Covered<dim>& part : group) std::ranges::move(part.pieces, std::back_inserter(pieces));
  }
  return result;
}

}  // namespace

template <int dim>
std::map<Index, std::vector<FacetTransfer<dim>>> facet_transfers(const contact::NitscheForm<dim>& form,
                                                                 const ContactTerms<dim>& terms,
                                                                 std::span<const Point<dim>> t)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::map<std::size_t, std::vector<Covered<dim>>> of_facet;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    if (!segment.master) continue;
    const auto n = static_cast<std::size_t>(form.n_segment_points());
    const std::vector<Point<dim>> q_k = terms.project_plainly(t.subspan(k * n, n));
    segment.for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          if (side.facet.cell >= mesh.n_owned_cells()) return;
          const double measure = mesh::facet_geometry(mesh, side.facet.cell, side.facet.local).measure *
                                 fem::fraction<dim - 1>(*side.part);
          TractionPiece<dim> piece{*side.part, q_k};
          for (Point<dim>& coefficient : piece.coefficients)
            coefficient *= side.sign * segment.measure / measure;
          std::vector<Covered<dim>>& covered = of_facet[side.number];
          if (covered.empty() || covered.back().slave != segment.slave.number)
            covered.push_back({segment.slave.number, {}});
          covered.back().pieces.push_back(std::move(piece));
        });
  }
  std::map<Index, std::vector<FacetTransfer<dim>>> result;
  for (auto& [number, covered] : of_facet)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    std::ranges::sort(covered, {}, [&](const Covered<dim>& part) { return place(mesh, part.slave); });
    result[facet.cell].push_back({facet, grouped(std::move(covered))});
  }
  return result;
}

template std::map<Index, std::vector<FacetTransfer<2>>> facet_transfers(const contact::NitscheForm<2>&,
                                                                        const ContactTerms<2>&,
                                                                        std::span<const Point<2>>);
template std::map<Index, std::vector<FacetTransfer<3>>> facet_transfers(const contact::NitscheForm<3>&,
                                                                        const ContactTerms<3>&,
                                                                        std::span<const Point<3>>);

}  // namespace tribound::certify
