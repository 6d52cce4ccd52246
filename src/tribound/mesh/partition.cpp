#include "tribound/mesh/partition.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "tribound/base/sorted.h"

namespace tribound::mesh
{

namespace
{

/// Numbers the vertices of the cells in ascending order of (morton_key, name).
template <int dim>
std::vector<VertexName<dim>> number_vertices(const Cube<dim>& cube, std::span<const CellRecord<dim>> cells,
                                             std::vector<Cell<dim>>& corners)
{
  std::unordered_map<VertexName<dim>, Index, VertexHash<dim>> first_number;
  first_number.reserve(cells.size());
  std::vector<std::pair<std::uint64_t, VertexName<dim>>> found;
  corners.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int i = 0; i <= dim; ++i)
    {
      const VertexName<dim>& name = cells[c].vertices[i];
      const auto [entry, is_new] = first_number.try_emplace(name, static_cast<Index>(found.size()));
      if (is_new) found.emplace_back(morton_key<dim>(cube, name.point()), name);
      corners[c][i] = entry->second;
    }

  std::vector<Index> order(found.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(
      order, {}, [&](Index v) -> const auto& { return found[v]; });
  std::vector<Index> number(found.size());
  std::vector<VertexName<dim>> vertices;
  vertices.reserve(found.size());
  for (const Index v : order)
  {
    number[v] = static_cast<Index>(vertices.size());
    vertices.push_back(found[v].second);
  }
  for (Cell<dim>& cell : corners)
    for (Index& v : cell) v = number[v];
  return vertices;
}

/// The vertices that may have cells on other ranks: those of inner facets with one cell here.
template <int dim>
std::vector<Index> outer_vertices(std::span<const CellRecord<dim>> cells, const Topology<dim>& topology)
{
  std::vector<Index> vertices;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int i = 0; i <= dim; ++i)
    {
      const Index facet = topology.cell_facets[c][i];
      if (cells[c].tags[i] == facet_inside && topology.facet_cells[facet][1] < 0)
        vertices.insert(vertices.end(), topology.facets[facet].begin(), topology.facets[facet].end());
    }
  sort_and_unite(vertices);
  return vertices;
}

/// Per vertex the ranks that ask for it, this one included. One rank, chosen by the hash of the vertex,
/// answers for it, and all ranks that have it report to that rank.
template <int dim>
std::vector<std::vector<int>> asking_ranks(const Ranks& ranks, std::span<const VertexName<dim>> vertices)
{
  const auto clerk = [&](const VertexName<dim>& name) { return static_cast<int>(hash(name) % ranks.size()); };
  std::vector<std::vector<VertexName<dim>>> asked(ranks.size());
  for (const VertexName<dim>& name : vertices) asked[clerk(name)].push_back(name);
  const std::vector<std::vector<VertexName<dim>>> heard = ranks.send(asked);

  std::unordered_map<VertexName<dim>, std::vector<int>, VertexHash<dim>> askers;
  for (int r = 0; r < ranks.size(); ++r)
    for (const VertexName<dim>& name : heard[r]) askers[name].push_back(r);
  std::vector<std::vector<int>> answers(ranks.size());  // per vertex: how many, and who
  for (int r = 0; r < ranks.size(); ++r)
    for (const VertexName<dim>& name : heard[r])
    {
      const std::vector<int>& who = askers[name];
      answers[r].push_back(static_cast<int>(who.size()));
      answers[r].insert(answers[r].end(), who.begin(), who.end());
    }
  const std::vector<std::vector<int>> told = ranks.send(answers);

  std::vector<std::size_t> next(ranks.size(), 0);
  std::vector<std::vector<int>> result;
  result.reserve(vertices.size());
  for (const VertexName<dim>& name : vertices)
  {
    const int from = clerk(name);
    const auto answer = told[from].begin() + static_cast<std::ptrdiff_t>(next[from]);
    result.emplace_back(answer + 1, answer + 1 + *answer);
    next[from] += 1 + *answer;
  }
  return result;
}

/// The cells of other ranks around the vertices of the own ones.
template <int dim>
std::vector<Ghost<dim>> find_ghosts(const Ranks& ranks, const Cube<dim>& cube,
                                    std::span<const CellRecord<dim>> owned)
{
  std::vector<Cell<dim>> corners;
  const std::vector<VertexName<dim>> names = number_vertices<dim>(cube, owned, corners);
  const Topology<dim> topology = build_topology<dim>(static_cast<Index>(names.size()), corners);
  const std::vector<Index> outer = outer_vertices<dim>(owned, topology);
  std::vector<VertexName<dim>> outer_names;
  outer_names.reserve(outer.size());
  for (const Index v : outer) outer_names.push_back(names[v]);
  const std::vector<std::vector<int>> askers = asking_ranks<dim>(ranks, outer_names);

  std::vector<std::vector<Index>> wanted(ranks.size());
  for (std::size_t k = 0; k < outer.size(); ++k)
    for (const int r : askers[k])
      if (r != ranks.rank())
        wanted[r].insert(wanted[r].end(),
                         topology.vertex_cells.begin() + topology.vertex_cells_begin[outer[k]],
                         topology.vertex_cells.begin() + topology.vertex_cells_begin[outer[k] + 1]);
  std::vector<std::vector<CellRecord<dim>>> out(ranks.size());
  for (int r = 0; r < ranks.size(); ++r)
  {
    sort_and_unite(wanted[r]);
    for (const Index c : wanted[r]) out[r].push_back(owned[c]);
  }
  std::vector<Ghost<dim>> ghosts;
  const std::vector<std::vector<CellRecord<dim>>> in = ranks.send(out);
  for (int r = 0; r < ranks.size(); ++r)
    for (const CellRecord<dim>& cell : in[r])
      if (r != ranks.rank()) ghosts.push_back({cell, r});
  return ghosts;
}

/// Sets has_patch and sharers.
template <int dim>
void set_sharers(std::span<const Cell<dim>> corners, Partition<dim>& partition)
{
  const std::size_t n_vertices = partition.vertices.size();
  partition.has_patch.assign(n_vertices, 0);
  for (Index c = 0; c < partition.n_owned_cells; ++c)
    for (const Index v : corners[c]) partition.has_patch[v] = 1;

  std::vector<std::pair<Index, int>> shared;  // vertex, rank
  for (std::size_t g = 0; g < partition.ghost_owners.size(); ++g)
    for (const Index v : corners[partition.n_owned_cells + g])
      if (partition.has_patch[v] != 0) shared.emplace_back(v, partition.ghost_owners[g]);
  sort_and_unite(shared);
  partition.sharers_begin.assign(n_vertices + 1, 0);
  for (const auto& [v, rank] : shared)
  {
    ++partition.sharers_begin[v + 1];
    partition.sharers.push_back(rank);
  }
  std::inclusive_scan(partition.sharers_begin.begin(), partition.sharers_begin.end(),
                      partition.sharers_begin.begin());
}

/// The vertices of all ranks; each is counted by the lowest rank that has it.
template <int dim>
std::int64_t count_vertices(const Partition<dim>& partition)
{
  std::int64_t n_counted_here = 0;
  for (Index v = 0; v < static_cast<Index>(partition.vertices.size()); ++v)
  {
    const std::span<const int> others = partition.sharers_of(v);
    if (partition.has_patch[v] != 0 && (others.empty() || partition.ranks.rank() < others.front()))
      ++n_counted_here;
  }
  return partition.ranks.sum(n_counted_here);
}

/// `owned`: the own cells in ascending order.
template <int dim>
MeshPart<dim> make_part(const Ranks& ranks, const Cube<dim>& cube, std::vector<CellRecord<dim>> owned,
                        std::vector<Ghost<dim>> ghosts)
{
  std::ranges::sort(
      ghosts, {}, [](const Ghost<dim>& ghost) -> const auto& { return ghost.cell.name; });
  MeshPart<dim> part;
  Partition<dim>& partition = part.partition;
  partition.ranks = ranks;
  partition.cube = cube;
  partition.n_owned_cells = static_cast<Index>(owned.size());
  part.cells = std::move(owned);
  for (const Ghost<dim>& ghost : ghosts)
  {
    part.cells.push_back(ghost.cell);
    partition.ghost_owners.push_back(ghost.owner);
  }
  for (const CellRecord<dim>& cell : part.cells) partition.names.push_back(cell.name);
  partition.vertices = number_vertices<dim>(cube, part.cells, part.corners);
  set_sharers<dim>(part.corners, partition);
  return part;
}

}  // namespace

template <int dim>
MeshPart<dim> with_ghosts(const Ranks& ranks, const Cube<dim>& cube, std::vector<CellRecord<dim>> owned)
{
  std::ranges::sort(owned, {}, &CellRecord<dim>::name);
  const std::int64_t n_cells = ranks.sum(static_cast<std::int64_t>(owned.size()));
  std::vector<Ghost<dim>> ghosts;
  if (ranks.size() > 1) ghosts = find_ghosts<dim>(ranks, cube, owned);
  MeshPart<dim> part = make_part<dim>(ranks, cube, std::move(owned), std::move(ghosts));
  part.partition.n_cells = n_cells;
  part.partition.n_vertices = count_vertices(part.partition);
  return part;
}

template <int dim>
MeshPart<dim> with_these_ghosts(const Partition<dim>& before, std::vector<CellRecord<dim>> owned,
                                std::vector<Ghost<dim>> ghosts)
{
  MeshPart<dim> part = make_part<dim>(before.ranks, before.cube, std::move(owned), std::move(ghosts));
  part.partition.n_cells = before.n_cells;
  part.partition.n_vertices = before.n_vertices;
  return part;
}

std::vector<int> balanced_ranks(const Ranks& ranks, std::span<const std::uint64_t> keys,
                                std::span<const std::int64_t> weights)
{
  assert(keys.size() == weights.size());
  std::vector<std::pair<std::uint64_t, std::int64_t>> sorted;
  for (std::size_t c = 0; c < keys.size(); ++c) sorted.emplace_back(keys[c], weights[c]);
  std::ranges::sort(sorted);
  std::vector<std::int64_t> weight_before = {0};
  for (const auto& [key, weight] : sorted) weight_before.push_back(weight_before.back() + weight);
  const auto all = static_cast<double>(ranks.sum(weight_before.back()));

  // All cuts at once by bisection: the weight before low[k] is at most the share of the first k + 1 ranks.
  const int n_cuts = ranks.size() - 1;
  std::vector<std::uint64_t> low(n_cuts, 0);
  std::vector<std::int64_t> before(n_cuts);
  for (int bit = 63; bit >= 0 && n_cuts > 0; --bit)
  {
    const std::uint64_t step = std::uint64_t{1} << bit;
    for (int k = 0; k < n_cuts; ++k)
    {
      const auto first =
          std::ranges::lower_bound(sorted, low[k] + step, {}, [](const auto& s) { return s.first; });
      before[k] = weight_before[first - sorted.begin()];
    }
    ranks.sum(std::span(before));
    for (int k = 0; k < n_cuts; ++k)
      if (static_cast<double>(before[k]) <= all * (k + 1) / ranks.size()) low[k] += step;
  }
  std::vector<int> result;
  result.reserve(keys.size());
  for (const std::uint64_t key : keys)
    result.push_back(static_cast<int>(std::ranges::upper_bound(low, key) - low.begin()));
  return result;
}

template <int dim>
std::vector<std::uint64_t> centre_keys(const Cube<dim>& cube, std::span<const CellRecord<dim>> cells)
{
  std::vector<std::uint64_t> keys;
  keys.reserve(cells.size());
  for (const CellRecord<dim>& cell : cells)
  {
    Point<dim> sum = Point<dim>::Zero();
    for (const VertexName<dim>& vertex : cell.vertices) sum += vertex.point();
    keys.push_back(hilbert_key<dim>(cube, sum / (dim + 1)));
  }
  return keys;
}

template <int dim>
GhostUpdate cell_update(const Partition<dim>& partition)
{
  const auto owned = std::span(partition.names).first(partition.n_owned_cells);
  std::vector<Index> ghosts(partition.ghost_owners.size());
  std::iota(ghosts.begin(), ghosts.end(), partition.n_owned_cells);
  return {partition.ranks, ghosts, partition.ghost_owners,
          std::span(partition.names).subspan(partition.n_owned_cells), [owned](const CellName& name) {
            return static_cast<Index>(std::ranges::lower_bound(owned, name) - owned.begin());
          }};
}

template MeshPart<2> with_ghosts(const Ranks&, const Cube<2>&, std::vector<CellRecord<2>>);
template MeshPart<2> with_these_ghosts(const Partition<2>&, std::vector<CellRecord<2>>,
                                       std::vector<Ghost<2>>);
template std::vector<std::uint64_t> centre_keys(const Cube<2>&, std::span<const CellRecord<2>>);
template GhostUpdate cell_update(const Partition<2>&);
template MeshPart<3> with_ghosts(const Ranks&, const Cube<3>&, std::vector<CellRecord<3>>);
template MeshPart<3> with_these_ghosts(const Partition<3>&, std::vector<CellRecord<3>>,
                                       std::vector<Ghost<3>>);
template std::vector<std::uint64_t> centre_keys(const Cube<3>&, std::span<const CellRecord<3>>);
template GhostUpdate cell_update(const Partition<3>&);

}  // namespace tribound::mesh
