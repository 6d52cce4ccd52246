#pragma once

/// @file deck_faces.h
/// The outer faces of the cells of a deck.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::case_file
{

/// Faces go by their number, in an order that the mesh gives; in 2D they are edges. Keeps a reference.
class DeckFaces
{
 public:
  explicit DeckFaces(const mesh::ImportedMesh& mesh, bool is_axisymmetric = false);

  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  [[nodiscard]] int dim() const { return dim_; }
  /// The mesh is the meridian of bodies of revolution: x is the distance from the axis, y runs along it.
  [[nodiscard]] bool is_axisymmetric() const { return is_axisymmetric_; }
  [[nodiscard]] mesh::FaceNodes nodes(Index face) const { return mesh::nodes_of(mesh_.cells, faces_[face]); }
  [[nodiscard]] const Point<3>& point(Index node) const { return mesh_.nodes[node]; }
  /// Of the element, in the file.
  [[nodiscard]] std::int64_t label(Index face) const
  {
    return mesh_.cells[faces_[face].block].numbers[faces_[face].element];
  }
  [[nodiscard]] Index n_cells() const { return n_cells_; }
  /// Of bodies of revolution.
  [[nodiscard]] bool is_on_axis(Index node) const;
  /// -1 if it is no outer face.
  [[nodiscard]] Index find(const mesh::FaceNodes& face) const;
  /// Those all of whose nodes are among the given ones.
  [[nodiscard]] std::vector<Index> with_all_nodes(std::span<const Index> nodes) const;
  /// The same for many sets, in one pass.
  [[nodiscard]] std::vector<std::vector<Index>> with_all_nodes_of(
      std::span<const std::span<const Index>> sets) const;
  /// Those all of whose nodes that carry a part of a uniform load are among the given ones.
  [[nodiscard]] std::vector<Index> loaded_by(std::span<const Index> nodes) const;
  /// The nodes of these faces, ascending.
  [[nodiscard]] std::vector<Index> nodes_on(std::span<const Index> faces) const;
  /// The integrals of the shape functions over a face, node by node: what a uniform load is at the nodes; of
  /// bodies of revolution over the full circle.
  [[nodiscard]] std::vector<double> weights(Index face) const;
  /// The outward unit normal, at the centre.
  [[nodiscard]] Point<3> normal(Index face) const;
  /// Whether the middle of an edge is off its ends' middle, by a millionth of its length.
  [[nodiscard]] bool is_curved(Index face) const;
  /// Faces that share nodes are in one of the parts.
  [[nodiscard]] std::vector<std::vector<Index>> connected(std::span<const Index> faces) const;
  /// As triangles; in 2D as a segment, whose second end stands twice.
  [[nodiscard]] std::vector<std::array<Point<3>, 3>> triangles(Index face) const;

 private:
  /// Whether a uniform load is not 0 at this node of a face.
  [[nodiscard]] bool carries_load(const mesh::FaceNodes& face, int node) const;

  const mesh::ImportedMesh& mesh_;
  int dim_;
  bool is_axisymmetric_;
  double size_ = 0;  ///< the largest coordinate
  Index n_cells_ = 0;
  std::vector<mesh::CellFace> faces_{};  ///< ascending by key
};

/// The distance of a point from a triangle, which may be a segment.
[[nodiscard]] double distance(const Point<3>& x, const std::array<Point<3>, 3>& triangle);

}  // namespace tribound::case_file
