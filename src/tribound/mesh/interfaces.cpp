#include "tribound/mesh/interfaces.h"

#include <algorithm>

namespace tribound::mesh
{

template <int dim>
Interfaces<dim>::Interfaces(const MeshData<dim>& data, const Topology<dim>& topology) : topology_(topology)
{
  if (data.interfaces.empty()) return;
  std::vector<Side> of_group(data.boundary_names.size());
  for (std::size_t k = 0; k < data.interfaces.size(); ++k)
    for (int side = 0; side < 2; ++side)
      for (const std::string& name : data.interfaces[k].sides[side])
        if (const auto it = std::ranges::find(data.boundary_names, name); it != data.boundary_names.end())
          of_group[it - data.boundary_names.begin()] = {static_cast<int>(k), side};

  sides_.resize(topology.facets.size());
  body_of_cell_ = connected_parts(topology);
  std::vector<std::array<std::set<int>, 2>> bodies(data.interfaces.size());
  for (const TaggedFacet<dim>& tagged : data.facets)
  {
    const Index f = topology.facet(tagged.vertices);
    const Side& side = of_group[tagged.tag];
    if (f < 0 || topology.facet_cells[f][1] >= 0 || side.interface < 0) continue;
    sides_[f] = side;
    bodies[side.interface][side.side].insert(body(f));
    for (const Index v : tagged.vertices) corner_facets_.emplace_back(v, f);
  }
  std::ranges::sort(corner_facets_);
  for (const auto& [first, second] : bodies)
    for (const int a : first)
      for (const int b : second)
      {
        joined_.emplace(a, b);
        joined_.emplace(b, a);
      }
}

template <int dim>
bool Interfaces<dim>::are_opposite(Index f, Index g) const
{
  return !empty() && sides_[f].interface >= 0 && sides_[f].interface == sides_[g].interface &&
         sides_[f].side != sides_[g].side;
}

template <int dim>
bool Interfaces<dim>::may_cross(Index f, Index g) const
{
  if (empty()) return false;
  return are_opposite(f, g) || (body(f) != body(g) && joined_.contains({body(f), body(g)}));
}

template <int dim>
bool Interfaces<dim>::is_of_slit(Index f) const
{
  return !empty() && sides_[f].interface >= 0 && joined_.contains({body(f), body(f)});
}

template <int dim>
bool Interfaces<dim>::may_touch(Index v, Index f, std::span<const Index> touched) const
{
  if (empty()) return false;
  const std::span own(std::ranges::lower_bound(corner_facets_, std::pair(v, Index{0})),
                      std::ranges::lower_bound(corner_facets_, std::pair(v + 1, Index{0})));
  return std::ranges::any_of(own,
                             [&](const auto& entry)
                             {
                               const Index h = entry.second;
                               const auto is_partner = [&](Index g) {
                                 return body(g) == body(f) && sides_[g].interface >= 0 &&
                                        (body(g) != body(h) || are_opposite(g, h));
                               };
                               return (body(f) != body(h) && joined_.contains({body(f), body(h)})) ||
                                      std::ranges::any_of(touched, is_partner);
                             });
}

template class Interfaces<2>;
template class Interfaces<3>;

}  // namespace tribound::mesh
