#include "tribound/mesh/bodies.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "tribound/base/ghost_update.h"
#include "tribound/base/sorted.h"
#include "tribound/mesh/partition.h"

namespace tribound::mesh
{

namespace
{

/// The values of all ranks, each once, in ascending order.
std::vector<std::int64_t> united(const Ranks& ranks, std::vector<std::int64_t> values)
{
  values = ranks.gather<std::int64_t>(values);
  ranks.copy_from_first(values);
  sort_and_unite(values);
  return values;
}

/// Per local part, the lowest root of the cells of its body: found locally, then again and again as long as
/// ghosts lower it from other ranks.
template <int dim>
std::vector<std::int64_t> lowest_roots(const Partition<dim>& partition, std::span<const int> part,
                                       int n_parts)
{
  const GhostUpdate update = cell_update(partition);
  std::vector<std::int64_t> lowest(n_parts, std::numeric_limits<std::int64_t>::max());
  std::vector<std::int64_t> of_cell;
  for (const CellName& name : partition.names) of_cell.push_back(name.root);
  for (bool changed = true; changed;)
  {
    changed = false;
    for (std::size_t c = 0; c < of_cell.size(); ++c)
    {
      changed = changed || of_cell[c] < lowest[part[c]];
      lowest[part[c]] = std::min(lowest[part[c]], of_cell[c]);
    }
    for (std::size_t c = 0; c < of_cell.size(); ++c) of_cell[c] = lowest[part[c]];
    changed = partition.ranks.any(changed);
    update(std::span(of_cell));
  }
  return lowest;
}

}  // namespace

template <int dim>
Bodies number_bodies(const Mesh<dim>& mesh)
{
  const bool is_known = mesh.partition() && !mesh.partition()->bodies.empty();
  Bodies bodies{is_known ? mesh.partition()->bodies : connected_parts(mesh.topology())};
  bodies.n = bodies.of_cell.empty() ? 0 : std::ranges::max(bodies.of_cell) + 1;
  if (is_known || !mesh.partition()) return bodies;
  const std::vector<std::int64_t> lowest = lowest_roots(*mesh.partition(), bodies.of_cell, bodies.n);
  const std::vector<std::int64_t> all = united(mesh.ranks(), lowest);
  for (int& body : bodies.of_cell)
    body = static_cast<int>(std::ranges::lower_bound(all, lowest[body]) - all.begin());
  bodies.n = static_cast<int>(all.size());
  return bodies;
}

template Bodies number_bodies(const Mesh<2>&);
template Bodies number_bodies(const Mesh<3>&);

}  // namespace tribound::mesh
