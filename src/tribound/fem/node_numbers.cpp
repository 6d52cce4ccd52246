#include "tribound/fem/node_numbers.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "tribound/mesh/partition.h"

namespace tribound::fem
{

namespace
{

constexpr std::int64_t unknown = -1;

/// The nodes for which this rank is the lowest with own cells around them.
template <int dim>
std::vector<Index> find_owned(const mesh::Partition<dim>& partition, Index n_nodes,
                              std::span<const Index> cell_nodes, int n_cell_nodes)
{
  std::vector<int> lowest(n_nodes, std::numeric_limits<int>::max());
  for (std::size_t i = 0; i < cell_nodes.size(); ++i)
  {
    const auto cell = static_cast<Index>(i / n_cell_nodes);
    const Index ghost = cell - partition.n_owned_cells;
    const int rank = ghost < 0 ? partition.ranks.rank() : partition.ghost_owners[ghost];
    lowest[cell_nodes[i]] = std::min(lowest[cell_nodes[i]], rank);
  }
  std::vector<Index> owned;
  for (Index node = 0; node < n_nodes; ++node)
    if (lowest[node] == partition.ranks.rank()) owned.push_back(node);
  return owned;
}

/// Tells the ghost cells the numbers of their nodes. At first the owner of a cell knows the numbers of the
/// nodes that it owns. After one round it knows those of all nodes of its cells, since the owner of each has
/// a cell around it; after the second, ghosts have those of all their nodes.
template <int dim>
void tell_ghosts(const mesh::Partition<dim>& partition, std::span<const Index> cell_nodes, int n_cell_nodes,
                 std::span<std::int64_t> global)
{
  constexpr int rounds = 2;
  const GhostUpdate update = mesh::cell_update(partition);
  std::vector<std::int64_t> in_cells(cell_nodes.size());
  for (int round = 0; round < rounds; ++round)
  {
    std::ranges::transform(cell_nodes, in_cells.begin(), [&](Index node) { return global[node]; });
    update(std::span(in_cells), n_cell_nodes);
    for (std::size_t i = static_cast<std::size_t>(partition.n_owned_cells) * n_cell_nodes;
         i < in_cells.size(); ++i)
      if (in_cells[i] != unknown) global[cell_nodes[i]] = in_cells[i];
  }
}

}  // namespace

template <int dim>
std::shared_ptr<const NodeNumbers> number_nodes(const mesh::Mesh<dim>& mesh, Index n_nodes,
                                                std::span<const Index> cell_nodes, int n_cell_nodes)
{
  if (!mesh.partition()) return nullptr;
  const mesh::Partition<dim>& partition = *mesh.partition();
  const Ranks& ranks = partition.ranks;
  NodeNumbers numbers;
  numbers.ranks = ranks;
  numbers.owned = find_owned(partition, n_nodes, cell_nodes, n_cell_nodes);
  std::vector<std::int64_t> n_of_rank(ranks.size(), 0);
  n_of_rank[ranks.rank()] = static_cast<std::int64_t>(numbers.owned.size());
  ranks.sum(std::span(n_of_rank));
  std::vector<std::int64_t> end(ranks.size());
  std::partial_sum(n_of_rank.begin(), n_of_rank.end(), end.begin());
  numbers.n = end.back();
  numbers.first = end[ranks.rank()] - n_of_rank[ranks.rank()];

  numbers.global.assign(n_nodes, unknown);
  for (std::size_t k = 0; k < numbers.owned.size(); ++k)
    numbers.global[numbers.owned[k]] = numbers.first + static_cast<std::int64_t>(k);
  tell_ghosts(partition, cell_nodes, n_cell_nodes, std::span(numbers.global));

  std::vector<Index> ghosts;
  std::vector<int> owners;
  std::vector<std::int64_t> keys;
  for (Index node = 0; node < n_nodes; ++node)
  {
    const auto owner = std::ranges::upper_bound(end, numbers.global[node]) - end.begin();
    if (owner == ranks.rank()) continue;
    ghosts.push_back(node);
    owners.push_back(static_cast<int>(owner));
    keys.push_back(numbers.global[node]);
  }
  numbers.update = GhostUpdate(ranks, std::span<const Index>(ghosts), std::span<const int>(owners),
                               std::span<const std::int64_t>(keys),
                               [&](std::int64_t global) { return numbers.owned[global - numbers.first]; });
  return std::make_shared<const NodeNumbers>(std::move(numbers));
}

template std::shared_ptr<const NodeNumbers> number_nodes(const mesh::Mesh<2>&, Index, std::span<const Index>,
                                                         int);
template std::shared_ptr<const NodeNumbers> number_nodes(const mesh::Mesh<3>&, Index, std::span<const Index>,
                                                         int);

}  // namespace tribound::fem
