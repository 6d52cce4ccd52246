#include "tribound/certify/bound/friedrichs_pairs.h"

#include <algorithm>
#include <map>

#include "tribound/certify/bound/constants.h"
#include "tribound/contact/pairing/polygon.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// The segments on one side of a facet.
template <int dim>
struct OnFacet
{
  mesh::BoundaryFacet facet;
  std::vector<fem::Part<dim - 1>> parts;
  double most = 0;  ///< the largest s_k / h_k
};

/// An upper bound of the number of parts that have a point in common.
template <int dim>
int multiplicity(const std::vector<fem::Part<dim - 1>>& parts)
{
  int most = 1;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    int around = 1;
    for (std::size_t j = 0; j < parts.size(); ++j)
      if (i != j && contact::overlap<dim>(parts[i], parts[j])) ++around;
    most = std::max(most, around);
  }
  return most;
}

}  // namespace

template <int dim>
PairTerms pair_terms(const mesh::Mesh<dim>& mesh, std::span<const contact::ContactSegment<dim>> segments,
                     double facet_scale)
{
  const auto& cell_facets = mesh.topology().cell_facets;
  PairTerms terms;
  std::map<std::size_t, OnFacet<dim>> facets;
  for (const contact::ContactSegment<dim>& segment : segments)
  {
    if (!segment.master) continue;
    const double h = facet_scale * segment.h;
    segment.for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          OnFacet<dim>& on_facet = facets[side.number];
          on_facet.facet = side.facet;
          on_facet.parts.push_back(*side.part);
          on_facet.most =
              std::max(on_facet.most, segment.measure / contact::simplex_map(mesh, side).measure / h);
        });
    terms.couplings.push_back({cell_facets[segment.slave.facet.cell][segment.slave.facet.local],
                               cell_facets[segment.master->facet.cell][segment.master->facet.local],
                               segment.measure / (2 * h)});
  }

  std::vector<double> spent(mesh.n_cells(), 0.0);  // over 2 t
  for (const auto& [number, on_facet] : facets)
  {
    const auto [cell, local, tag] = on_facet.facet;
    const double c =
        trace_constant<dim>(mesh::cell_diameter(mesh, cell), mesh::facet_geometry(mesh, cell, local).measure,
                            mesh::cell_map(mesh, cell).measure());
    spent[cell] += c * c * multiplicity<dim>(on_facet.parts) * on_facet.most;
  }
  const double t = std::min(1.0, 1 / (4 * std::ranges::max(spent)));
  for (const double d : spent) terms.cells.push_back(1 - 2 * t * d);
  for (PairTerms::Coupling& coupling : terms.couplings) coupling.weight *= t;
  return terms;
}

template PairTerms pair_terms(const mesh::Mesh<2>&, std::span<const contact::ContactSegment<2>>, double);
template PairTerms pair_terms(const mesh::Mesh<3>&, std::span<const contact::ContactSegment<3>>, double);

}  // namespace tribound::certify
