#pragma once

/// @file node_sets.h
/// Node sets as boundaries.

#include <set>
#include <span>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// For every node of a cell a node that stands for its body; -1 for other nodes.
[[nodiscard]] std::vector<Index> bodies_of_nodes(const ImportedMesh& mesh);

/// Finds the bodies all of whose nodes are in a set.
class WholeBodies
{
 public:
  explicit WholeBodies(const ImportedMesh& mesh);

  /// As in bodies_of_nodes().
  [[nodiscard]] std::span<const Index> bodies() const { return body_; }
  /// The bodies, each by the node that stands for it; `nodes` without repetitions.
  [[nodiscard]] std::set<Index> within(std::span<const Index> nodes) const;

 private:
  std::vector<Index> body_;
  std::vector<Index> size_;  ///< of a body, at the node that stands for it
};

/// Which of the sets a node is in, at a cost that does not grow with the number of sets.
class SetsOfNodes
{
 public:
  /// Nodes without repetitions in each set.
  SetsOfNodes(std::size_t n_nodes, std::span<const std::span<const Index>> sets);

  [[nodiscard]] bool has(Index node) const { return begin_[node] < begin_[node + 1]; }
  /// The sets that have all of these nodes, ascending.
  [[nodiscard]] std::vector<Index> with_all(std::span<const Index> nodes) const;

 private:
  [[nodiscard]] std::span<const Index> of(Index node) const
  {
    return std::span(sets_).subspan(begin_[node], begin_[node + 1] - begin_[node]);
  }

  std::vector<std::size_t> begin_;
  std::vector<Index> sets_{};  ///< of node n from begin_[n], ascending
};

/// Turns the node sets of a mesh into facet sets: the outer facets of cells all of whose nodes, middles too,
/// are in the set. Left out, with a note: sets without such a facet, sets that have all nodes of a body, and
/// sets with the same facets as a facet set or an earlier node set. Throws InputError for a set without
/// facets that should have some, and for a name that a facet set with other facets has.
void add_node_sets(ImportedMesh& mesh, std::vector<std::string>& notes);

}  // namespace tribound::mesh
