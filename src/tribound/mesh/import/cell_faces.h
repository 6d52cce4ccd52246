#pragma once

/// @file cell_faces.h
/// The faces of the cells of an imported mesh, found by their corners.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// The corners of a face in ascending order, behind -1 where it has fewer than four.
using FaceKey = std::array<Index, 4>;

[[nodiscard]] FaceKey key_of(std::span<const Index> corners);

/// A face of a cell; an edge in 2D.
struct CellFace
{
  FaceKey key;
  int block;
  Index element;
  int face;
};

/// The nodes of a face, as an element of its own.
struct FaceNodes
{
  ElementType type;
  std::array<Index, max_face_nodes> nodes;

  [[nodiscard]] std::span<const Index> span() const& { return std::span(nodes).first(type.n_nodes); }
  void span() const&& = delete;  ///< would outlive the nodes
};

[[nodiscard]] FaceNodes nodes_of(std::span<const ElementBlock> cells, const CellFace& face);

/// Appends it to the block of its type.
void append(std::vector<ElementBlock>& facets, const FaceNodes& face, std::int64_t number);

class CellFaces
{
 public:
  /// Only faces all of whose corners are marked.
  CellFaces(std::span<const ElementBlock> cells, std::span<const char> is_marked);

  [[nodiscard]] bool contains(const FaceKey& key) const;
  /// Those of one cell, ascending by key.
  [[nodiscard]] std::vector<CellFace> outer() const;

 private:
  std::vector<CellFace> faces_;  ///< ascending by key
};

/// Those whose corners are nodes of the facets.
[[nodiscard]] CellFaces faces_beside(std::span<const ElementBlock> cells, std::size_t n_nodes,
                                     std::span<const ElementBlock> facets);

/// The first facet that is no face of a cell; nothing if all are.
struct FacetPlace
{
  std::size_t block;
  std::size_t element;
};
[[nodiscard]] std::optional<FacetPlace> first_without_cell(std::span<const ElementBlock> cells,
                                                           std::size_t n_nodes,
                                                           std::span<const ElementBlock> facets);

}  // namespace tribound::mesh
