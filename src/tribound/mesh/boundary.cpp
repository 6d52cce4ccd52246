#include <fmt/format.h>

#include <algorithm>

#include "tribound/mesh/describe.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

template <int dim>
[[noreturn]] void throw_misplaced(const MeshData<dim>& data, const TaggedFacet<dim>& tagged,
                                  const std::string& problem, const std::string& hint)
{
  throw InputError(data.source,
                   fmt::format("{} of group \"{}\" {}", describe_facet<dim>(data, tagged.vertices),
                               data.boundary_names[tagged.tag], problem),
                   hint);
}

/// The tag of every facet, -1 where there is none.
template <int dim>
std::vector<int> facet_tags(const MeshData<dim>& data, const Topology<dim>& topology)
{
  std::vector<int> tags(topology.facets.size(), -1);
  for (const TaggedFacet<dim>& tagged : data.facets)
  {
    const Index f = topology.facet(tagged.vertices);
    if (f < 0)
      throw_misplaced(data, tagged, fmt::format("is not {} of any cell", dim == 2 ? "an edge" : "a face"),
                      "the boundary must be meshed together with the domain");
    if (topology.facet_cells[f][1] >= 0)
      throw_misplaced(
          data, tagged, "lies inside the domain, between two cells",
          fmt::format("physical groups of {} are boundaries; take the inner ones out of the group",
                      dim == 2 ? "curves" : "surfaces"));
    if (tags[f] >= 0 && tags[f] != tagged.tag)
      throw_misplaced(data, tagged, fmt::format("is also in group \"{}\"", data.boundary_names[tags[f]]),
                      "a facet carries the conditions of one group; take it out of the other");
    tags[f] = tagged.tag;
  }
  return tags;
}

}  // namespace

template <int dim>
std::vector<BoundaryFacet> find_boundary(const MeshData<dim>& data, const Topology<dim>& topology)
{
  const std::vector<int> tags = facet_tags(data, topology);
  std::vector<BoundaryFacet> boundary;
  for (Index f = 0; f < static_cast<Index>(topology.facets.size()); ++f)
  {
    const auto [cell, other] = topology.facet_cells[f];
    if (other >= 0) continue;
    boundary.push_back({cell, topology.local_facet(cell, f), tags[f]});
  }
  return boundary;
}

template <int dim>
std::vector<BoundaryFacet> find_boundary(const MeshData<dim>& data, const Topology<dim>& topology,
                                         std::span<const CellRecord<dim>> cells, Index n_owned,
                                         std::span<const char> has_patch)
{
  constexpr const char* hint = "the cells of the first mesh, or how they were bisected, have been changed";
  std::vector<BoundaryFacet> boundary;
  for (Index f = 0; f < static_cast<Index>(topology.facets.size()); ++f)
  {
    const auto [cell, other] = topology.facet_cells[f];
    const int local = topology.local_facet(cell, f);
    const std::int32_t tag = cells[cell].tags[local];
    const bool is_inside = tag == facet_inside;
    if (!is_inside) boundary.push_back({cell, local, tag});
    if (other >= 0 && (!is_inside || cells[other].tags[topology.local_facet(other, f)] != facet_inside))
      throw InputError(data.source,
                       fmt::format("{} is on the boundary and has two cells",
                                   describe_facet<dim>(data, topology.facets[f])),
                       hint);
    if (other < 0 && is_inside &&
        std::ranges::any_of(topology.facets[f], [&](Index v) { return has_patch[v] != 0; }))
      throw InputError(data.source,
                       fmt::format("{} is inside the domain and has one cell",
                                   describe_facet<dim>(data, topology.facets[f])),
                       hint);
  }
  std::stable_partition(boundary.begin(), boundary.end(),  // clang 14 fails at that of ranges
                        [n_owned](const BoundaryFacet& facet) { return facet.cell < n_owned; });
  return boundary;
}

template std::vector<BoundaryFacet> find_boundary<2>(const MeshData<2>&, const Topology<2>&,
                                                     std::span<const CellRecord<2>>, Index,
                                                     std::span<const char>);
template std::vector<BoundaryFacet> find_boundary<3>(const MeshData<3>&, const Topology<3>&,
                                                     std::span<const CellRecord<3>>, Index,
                                                     std::span<const char>);
template std::vector<BoundaryFacet> find_boundary<2>(const MeshData<2>&, const Topology<2>&);
template std::vector<BoundaryFacet> find_boundary<3>(const MeshData<3>&, const Topology<3>&);

}  // namespace tribound::mesh
