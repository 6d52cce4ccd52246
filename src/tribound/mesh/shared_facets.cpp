#include "tribound/mesh/shared_facets.h"

#include <algorithm>
#include <span>

#include "tribound/mesh/partition.h"

namespace tribound::mesh
{

namespace
{

/// A facet by the name that ranks share.
struct FacetName
{
  CellName cell;  ///< on the side of the lower rank
  int local;
};

}  // namespace

template <int dim>
SharedFacets shared_facets(const Mesh<dim>& mesh)
{
  const Partition<dim>& partition = *mesh.partition();
  const Topology<dim>& topology = mesh.topology();
  const Index n_owned = mesh.n_owned_cells();
  SharedFacets shared;
  std::vector<Index> received;
  std::vector<int> senders;
  std::vector<FacetName> names;
  std::vector<Index> number(topology.facets.size(), -1);  // in shared.own
  for (Index c = 0; c < n_owned; ++c)
    for (int local = 0; local <= dim; ++local)
    {
      const Index facet = topology.cell_facets[c][local];
      const Index other = topology.facet_cells[facet][topology.facet_cells[facet][0] == c ? 1 : 0];
      if (other < n_owned) continue;  // of the boundary, too
      number[facet] = static_cast<Index>(shared.own.size());
      const int owner = partition.ghost_owners[other - n_owned];
      shared.own.push_back({c, local});
      shared.is_of_lower.push_back(owner < partition.ranks.rank() ? 1 : 0);
      if (shared.is_of_lower.back() == 0) continue;
      received.push_back(number[facet]);
      senders.push_back(owner);
      names.push_back({partition.names[other], topology.local_facet(other, facet)});
    }
  const auto find = [&](const FacetName& name)
  {
    const auto owned = std::span(partition.names).first(n_owned);
    const auto cell = std::ranges::lower_bound(owned, name.cell) - owned.begin();
    return number[topology.cell_facets[cell][name.local]];
  };
  shared.update = GhostUpdate(partition.ranks, std::span<const Index>(received),
                              std::span<const int>(senders), std::span<const FacetName>(names), find);
  return shared;
}

template SharedFacets shared_facets(const Mesh<2>&);
template SharedFacets shared_facets(const Mesh<3>&);

}  // namespace tribound::mesh
