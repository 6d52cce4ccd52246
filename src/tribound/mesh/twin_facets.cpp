#include "tribound/mesh/twin_facets.h"

#include <algorithm>
#include <cstddef>

#include "tribound/mesh/marked_cell.h"

namespace tribound::mesh
{

namespace
{

/// The marked edge of one of the twins, as positions in its vertices, ascending.
template <int dim>
std::array<std::ptrdiff_t, 2> marked_positions(const Mesh<dim>& mesh, const TwinFacets<dim>& twins, int which)
{
  const MarkedCell<dim> cell =
      marked_cell<dim>(mesh.vertices(), mesh.cells(), mesh.bisection_types(), twins.cells[which]);
  const std::array<Index, dim>& vertices = twins.vertices[which];
  int local = 0;
  while (std::ranges::find(vertices, cell.vertices[local]) != vertices.end()) ++local;
  const std::array<Index, dim> facet = marked_facet<dim>(cell, local);
  std::array<std::ptrdiff_t, 2> positions{};
  for (int end = 0; end < 2; ++end)
    positions[end] = std::ranges::find(vertices, facet[end]) - vertices.begin();
  std::ranges::sort(positions);
  return positions;
}

}  // namespace

template <int dim>
OppositeEdges<dim>::OppositeEdges(const Mesh<dim>& mesh, std::span<const TwinFacets<dim>> twins)
{
  for (std::size_t k = 0; k < twins.size(); ++k)
  {
    if (marked_positions(mesh, twins[k], 0) != marked_positions(mesh, twins[k], 1)) continue;
    const auto& [first, second] = twins[k].vertices;
    for (int i = 0; i < dim; ++i) link(first[i], 2 * static_cast<int>(k), second[i]);
  }
}

template <int dim>
std::vector<typename OppositeEdges<dim>::Edge> OppositeEdges<dim>::of(Index a, Index b) const
{
  std::vector<Edge> result;
  const auto at_a = at_.find(a);
  const auto at_b = at_.find(b);
  if (at_a == at_.end() || at_b == at_.end()) return result;
  for (const Opposite& to_a : at_a->second)
    for (const Opposite& to_b : at_b->second)
      if (to_a.side == to_b.side) result.push_back({to_a.vertex, to_b.vertex, to_a.side});
  return result;
}

template <int dim>
void OppositeEdges<dim>::link(Index middle, int side, Index opposite)
{
  add(middle, {side, opposite});
  add(opposite, {side ^ 1, middle});
}

template <int dim>
void OppositeEdges<dim>::add(Index vertex, const Opposite& opposite)
{
  std::vector<Opposite>& there = at_[vertex];
  if (std::ranges::find(there, opposite) == there.end()) there.push_back(opposite);
}

template class OppositeEdges<2>;
template class OppositeEdges<3>;

}  // namespace tribound::mesh
