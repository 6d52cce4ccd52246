#pragma once

/// @file imported_mesh.h
/// A mesh as a file has it, before it is made simplicial. Readers of all formats fill it.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/mesh/import/element_type.h"

namespace tribound::mesh
{

/// Elements of one type, in one orientation: if all are inverted, they are turned.
struct ElementBlock
{
  ElementType type;
  std::vector<Index> nodes{};           ///< places in ImportedMesh::nodes, type.n_nodes per element
  std::vector<std::int64_t> numbers{};  ///< the element numbers of the file, for messages

  [[nodiscard]] std::size_t size() const { return nodes.size() / type.n_nodes; }
  [[nodiscard]] std::span<const Index> element(std::size_t e) const
  {
    return std::span(nodes).subspan(e * type.n_nodes, type.n_nodes);
  }
};

struct CellSet
{
  std::string name;
  std::vector<Index> cells{};  ///< counted through all blocks of cells
};

struct FacetSet
{
  std::string name;
  std::vector<ElementBlock> facets{};
};

/// A set whose outer facets become a boundary: those all of whose nodes are in it.
struct NodeSet
{
  std::string name;
  std::vector<Index> nodes{};
  bool has_facets = false;  ///< it is an error if it has none; else it is left out
};

struct ImportedMesh
{
  Where source{};
  std::vector<Point<3>> nodes{};
  std::vector<std::int64_t> node_numbers{};  ///< of the file, for messages
  std::vector<ElementBlock> cells{};         ///< all of one dimension, 2 or 3
  std::vector<CellSet> cell_sets{};          ///< the regions: every cell is in one; none: one region "domain"
  std::vector<FacetSet> facet_sets{};        ///< boundaries, and facets inside which may become joints
  std::vector<NodeSet> node_sets{};
};

/// Whether the elements are of several orders.
[[nodiscard]] inline bool has_several_orders(std::span<const ElementBlock> blocks)
{
  return std::ranges::any_of(blocks, [&](const ElementBlock& block)
                             { return order_of(block.type) != order_of(blocks.front().type); });
}

}  // namespace tribound::mesh
