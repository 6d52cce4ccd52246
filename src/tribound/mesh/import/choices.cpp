#include "tribound/mesh/import/choices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "tribound/base/sorted.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/import/cell_sets.h"

namespace tribound::mesh
{

namespace
{

/// The nodes of the cells of each region; of all cells where there are no regions.
std::vector<std::vector<Index>> nodes_of_regions(const ImportedMesh& mesh)
{
  const std::vector<Index> set = set_of_cells(mesh);
  std::vector<std::vector<Index>> nodes(std::max<std::size_t>(mesh.cell_sets.size(), 1));
  std::size_t cell = 0;
  for (const ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e, ++cell)
    {
      std::vector<Index>& of_region = nodes[std::max(set[cell], 0)];
      of_region.insert(of_region.end(), block.element(e).begin(), block.element(e).end());
    }
  for (std::vector<Index>& of_region : nodes) sort_and_unite(of_region);
  return nodes;
}

/// Nodes that have become one.
class Merger
{
 public:
  Merger(const ImportedMesh& mesh, double distance)
      : mesh_(mesh), distance_(distance), parent_(mesh.nodes.size())
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  [[nodiscard]] Index root(Index node)
  {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }

  /// Nodes that are near have near projections, also onto a direction in which few others coincide.
  void merge(std::vector<Index> nodes)
  {
    const Point<3> direction = Point<3>(1, std::sqrt(2.0), std::sqrt(3.0)) / std::sqrt(6.0);
    const auto height = [&](Index node) { return mesh_.nodes[node].dot(direction); };
    std::ranges::sort(nodes, {}, height);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = i + 1;
           j < nodes.size() && height(nodes[j]) - height(nodes[i]) <= 1.001 * distance_; ++j)
        if ((mesh_.nodes[nodes[j]] - mesh_.nodes[nodes[i]]).norm() <= distance_) unite(nodes[i], nodes[j]);
  }

  [[nodiscard]] std::size_t n_merged() const { return n_merged_; }

 private:
  /// The one with the smaller place stays.
  void unite(Index a, Index b)
  {
    const auto [kept, gone] = std::minmax({root(a), root(b)});
    if (kept == gone) return;
    parent_[gone] = kept;
    ++n_merged_;
  }

  const ImportedMesh& mesh_;
  double distance_;
  std::vector<Index> parent_;
  std::size_t n_merged_ = 0;
};

/// No two different nodes of an element have become one.
void check_collapse(const ImportedMesh& mesh, Merger& merger, double distance)
{
  for (const ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e)
    {
      const auto nodes = block.element(e);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          if (nodes[i] != nodes[j] && merger.root(nodes[i]) == merger.root(nodes[j]))
            throw InputError(
                mesh.source,
                fmt::format("merge = {:g} makes one node of two of element {} ({}), {} at {} and {} "
                            "at {}",
                            distance, block.numbers[e], describe(block.type), mesh.node_numbers[nodes[j]],
                            describe(mesh.nodes[nodes[j]]), mesh.node_numbers[nodes[i]],
                            describe(mesh.nodes[nodes[i]])),
                "a distance far below the smallest edge");
    }
}

}  // namespace

void merge_nodes(ImportedMesh& mesh, double distance, std::vector<std::string>& notes)
{
  Merger merger(mesh, distance);
  for (std::vector<Index>& nodes : nodes_of_regions(mesh)) merger.merge(std::move(nodes));
  if (merger.n_merged() == 0) return;
  check_collapse(mesh, merger, distance);
  std::vector<Index> place(mesh.nodes.size(), -1);
  Index n = 0;
  for (Index node = 0; node < static_cast<Index>(place.size()); ++node)
  {
    if (const Index kept = merger.root(node); kept != node)
    {
      place[node] = place[kept];  // the smaller one, which has its place
      continue;
    }
    mesh.nodes[n] = mesh.nodes[node];
    mesh.node_numbers[n] = mesh.node_numbers[node];
    place[node] = n++;
  }
  mesh.nodes.resize(n);
  mesh.node_numbers.resize(n);
  const auto rename = [&](std::vector<Index>& nodes)
  {
    for (Index& node : nodes) node = place[node];
  };
  for (ElementBlock& block : mesh.cells) rename(block.nodes);
  for (FacetSet& set : mesh.facet_sets)
    for (ElementBlock& block : set.facets) rename(block.nodes);
  for (NodeSet& set : mesh.node_sets)
  {
    rename(set.nodes);
    sort_and_unite(set.nodes);
  }
  notes.push_back(fmt::format("{}: {} nodes are merged with others", mesh.source.file, merger.n_merged()));
}

void choose_boundaries(ImportedMesh& mesh, std::span<const std::string> names)
{
  std::vector<std::string> known;
  for (const FacetSet& set : mesh.facet_sets) known.push_back(set.name);
  for (const NodeSet& set : mesh.node_sets) known.push_back(set.name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      throw InputError(mesh.source, fmt::format("there is no set \"{}\" for a boundary", name),
                       fmt::format("the sets are {}", fmt::join(known, ", ")));
  const auto is_left_out = [&](const auto& set) { return std::ranges::find(names, set.name) == names.end(); };
  std::erase_if(mesh.facet_sets, is_left_out);
  std::erase_if(mesh.node_sets, is_left_out);
  for (NodeSet& set : mesh.node_sets) set.has_facets = true;
}

}  // namespace tribound::mesh
