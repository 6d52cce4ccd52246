#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <type_traits>

#include "tribound/base/error.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

namespace
{

/// The local vertices of each local facet.
template <int dim>
constexpr auto local_facets = []
{
  std::array<Index, dim + 1> cell{};
  for (int i = 0; i <= dim; ++i) cell[i] = i;
  std::array<std::array<Index, dim>, dim + 1> facets{};
  for (int i = 0; i <= dim; ++i) facets[i] = facet_vertices(cell, i);
  return facets;
}();

/// An entity as one cell sees it: its vertices but the lowest, and its place in the cell.
template <int n_corners>
struct Slot
{
  using Key = std::conditional_t<n_corners == 2, std::uint32_t, std::uint64_t>;
  Key others;           ///< the second and the third vertex in ascending order, packed
  std::uint32_t index;  ///< cell * n_local + local number
};

template <std::size_t n_corners>
std::array<Index, n_corners> sorted(std::array<Index, n_corners> v)
{
  if (v[0] > v[1]) std::swap(v[0], v[1]);
  if constexpr (n_corners == 3)
  {
    if (v[1] > v[2]) std::swap(v[1], v[2]);
    if (v[0] > v[1]) std::swap(v[0], v[1]);
  }
  return v;
}

/// The vertices of a local entity of a cell, ascending.
template <std::size_t n_corners, std::size_t n>
std::array<Index, n_corners> corners(const std::array<Index, n>& cell,
                                     const std::array<int, n_corners>& local)
{
  std::array<Index, n_corners> v;
  for (std::size_t k = 0; k < n_corners; ++k) v[k] = cell[local[k]];
  return sorted(v);
}

template <int n_corners>
std::array<Index, n_corners> unpack(Index lowest, typename Slot<n_corners>::Key others)
{
  if constexpr (n_corners == 2)
    return {lowest, static_cast<Index>(others)};
  else
    return {lowest, static_cast<Index>(others >> 32), static_cast<Index>(others & 0xffffffffU)};
}

/// offsets[v + 1] - offsets[v] = how often `visit` reports v.
template <class Visit>
std::vector<Index> count_offsets(Index n, const Visit& visit)
{
  std::vector<Index> offsets(static_cast<std::size_t>(n) + 1, 0);
  visit([&](Index v) { ++offsets[v + 1]; });
  for (Index v = 0; v < n; ++v) offsets[v + 1] += offsets[v];
  return offsets;
}

/// Numbers the distinct entities of all cells in lexicographic order of their vertices: a counting sort by
/// the lowest vertex, then a sort of the few entities that share it.
template <int n_corners, std::size_t n_local, std::size_t n>
void number_entities(Index n_vertices, std::span<const std::array<Index, n>> cells,
                     const std::array<std::array<int, n_corners>, n_local>& local,
                     std::vector<std::array<Index, n_corners>>& entities,
                     std::vector<std::array<Index, n_local>>& cell_entities)
{
  const std::vector<Index> begin = count_offsets(n_vertices,
                                                 [&](const auto& count)
                                                 {
                                                   for (const auto& cell : cells)
                                                     for (const auto& l : local) count(corners(cell, l)[0]);
                                                 });

  std::vector<Slot<n_corners>> slots(cells.size() * n_local);
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  std::uint32_t index = 0;
  for (const auto& cell : cells)
    for (const auto& l : local)
    {
      const auto v = corners(cell, l);
      Slot<n_corners>& slot = slots[next[v[0]]++];
      if constexpr (n_corners == 2)
        slot.others = static_cast<std::uint32_t>(v[1]);
      else
        slot.others = static_cast<std::uint64_t>(v[1]) << 32 | static_cast<std::uint64_t>(v[2]);
      slot.index = index++;
    }

  entities.clear();
  entities.reserve(slots.size() / 2 + n_vertices);
  cell_entities.resize(cells.size());
  for (Index v = 0; v < n_vertices; ++v)
  {
    const auto first = slots.begin() + begin[v];
    const auto last = slots.begin() + begin[v + 1];
    std::sort(first, last, [](const auto& a, const auto& b) { return a.others < b.others; });
    for (auto slot = first; slot != last; ++slot)
    {
      if (slot == first || slot->others != (slot - 1)->others)
        entities.push_back(unpack<n_corners>(v, slot->others));
      cell_entities[slot->index / n_local][slot->index % n_local] = static_cast<Index>(entities.size()) - 1;
    }
  }
}

/// The one or two cells of each facet, in ascending order.
template <int dim>
std::vector<std::array<Index, 2>> cells_of_facets(std::size_t n_facets,
                                                  std::span<const std::array<Index, dim + 1>> cell_facets)
{
  std::vector<std::array<Index, 2>> facet_cells(n_facets, {-1, -1});
  for (std::size_t c = 0; c < cell_facets.size(); ++c)
    for (const Index f : cell_facets[c])
    {
      auto& [first, second] = facet_cells[f];
      if (first < 0)
        first = static_cast<Index>(c);
      else if (second < 0)
        second = static_cast<Index>(c);
    }
  return facet_cells;
}

}  // namespace

template <int dim>
Topology<dim> build_topology(Index n_vertices, std::span<const Cell<dim>> cells)
{
  constexpr std::size_t most = std::numeric_limits<Index>::max() / Topology<dim>::n_cell_edges;
  if (cells.size() > most)
    throw SolveError(
        fmt::format("a process has {} cells, at most {} can be numbered with 32 bits: take more "
                    "processes or lower adapt.max_cells",
                    cells.size(), most));
  Topology<dim> topology;
  number_entities<dim>(n_vertices, cells, local_facets<dim>, topology.facets, topology.cell_facets);
  topology.facet_cells = cells_of_facets<dim>(topology.facets.size(), topology.cell_facets);
  if constexpr (dim == 2)
  {
    topology.edges = topology.facets;
    topology.cell_edges.reserve(cells.size());
    for (const auto& [f0, f1, f2] : topology.cell_facets) topology.cell_edges.push_back({f2, f1, f0});
  }
  else
    number_entities<2>(n_vertices, cells, local_edges<dim>, topology.edges, topology.cell_edges);

  topology.vertex_cells_begin = count_offsets(n_vertices,
                                              [&](const auto& count)
                                              {
                                                for (const auto& cell : cells)
                                                  for (const Index v : cell) count(v);
                                              });
  std::vector<Index> next(topology.vertex_cells_begin.begin(), topology.vertex_cells_begin.end() - 1);
  topology.vertex_cells.resize(cells.size() * (dim + 1));
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const Index v : cells[c]) topology.vertex_cells[next[v]++] = static_cast<Index>(c);
  return topology;
}

template <int dim>
std::vector<int> connected_parts(const Topology<dim>& topology)
{
  std::vector<int> label(topology.cell_facets.size(), -1);
  int n_parts = 0;
  for (std::size_t seed = 0; seed < label.size(); ++seed)
  {
    if (label[seed] >= 0) continue;
    std::vector<Index> front{static_cast<Index>(seed)};
    label[seed] = n_parts;
    while (!front.empty())
    {
      const Index cell = front.back();
      front.pop_back();
      for (const Index facet : topology.cell_facets[cell])
        for (const Index next : topology.facet_cells[facet])
        {
          if (next < 0 || label[next] >= 0) continue;
          label[next] = n_parts;
          front.push_back(next);
        }
    }
    ++n_parts;
  }
  return label;
}

template Topology<2> build_topology<2>(Index, std::span<const Cell<2>>);
template Topology<3> build_topology<3>(Index, std::span<const Cell<3>>);
template std::vector<int> connected_parts(const Topology<2>&);
template std::vector<int> connected_parts(const Topology<3>&);

}  // namespace tribound::mesh
