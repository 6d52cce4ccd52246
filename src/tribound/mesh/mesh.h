#pragma once

/// @file mesh.h
/// Simplicial meshes in flat arrays.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/base/ranks.h"
#include "tribound/base/types.h"
#include "tribound/mesh/seams.h"

namespace tribound::mesh
{

/// Vertex numbers of a cell, positively oriented. Local facet i is opposite to local vertex i; its vertices
/// are the others in ascending local order.
template <int dim>
using Cell = std::array<Index, dim + 1>;

/// A facet named by its vertices, in a group, as a reader finds it.
template <int dim>
struct TaggedFacet
{
  std::array<Index, dim> vertices;
  int tag;  ///< position in MeshData::boundary_names
};

/// A node inside an edge of a facet, as a reader of a second-order mesh finds it.
template <int dim>
struct EdgeNode
{
  std::array<Index, 2> ends;  ///< vertices
  Point<dim> position;
};

struct QuadraticFacets;

/// A facet of the boundary of Omega.
struct BoundaryFacet
{
  Index cell;
  int local;  ///< local facet of the cell
  int tag;    ///< position in Mesh::boundary_names(), or -1 for a facet in no group
};

/// The meshes that bisect() has passed through. Each has the vertices of the one before, with their numbers,
/// followed by middles of edges.
struct Ancestry
{
  std::vector<Index> n_vertices;                   ///< of the meshes before this one, the original one first
  std::vector<std::array<Index, 2>> halved_edges;  ///< ends, per vertex after those of the original mesh
};

/// What the parts of a mesh share with each other and with the meshes made from it.
struct MeshLabels
{
  std::vector<std::string> region_names{};
  std::vector<std::string> boundary_names{};
  Where source{};  ///< for messages
  std::vector<Interface> interfaces{};
  /// Of the first mesh, see mesh/quadratic_facets.h: all its facets, and those of second order.
  std::shared_ptr<const QuadraticFacets> quadratic_facets{};
};

/// What a reader delivers, not yet verified. Messages about it count cells and vertices from 0.
template <int dim>
struct MeshData : MeshLabels
{
  std::vector<Point<dim>> vertices{};
  std::vector<Cell<dim>> cells{};
  std::vector<int> regions{};  ///< per cell: position in region_names
  std::vector<TaggedFacet<dim>> facets{};
  std::vector<EdgeNode<dim>> edge_nodes{};  ///< of `facets`; empty for a mesh of order 1
  /// Per cell: how bisect() continues with it, see mesh/marked_cell.h. Empty for a mesh that does not come
  /// from bisect(), which then starts from the longest edges.
  std::vector<std::uint8_t> bisection_types{};
  Ancestry ancestry{};  ///< empty for a mesh that does not come from bisect()
};

/// The vertices of a local facet, by numbers or names: those of the cell except number `local`, in ascending
/// local order.
template <class Vertex, std::size_t n>
[[nodiscard]] constexpr std::array<Vertex, n - 1> facet_vertices(const std::array<Vertex, n>& cell, int local)
{
  std::array<Vertex, n - 1> vertices{};
  for (std::size_t j = 0; j < n - 1; ++j) vertices[j] = cell[j < static_cast<std::size_t>(local) ? j : j + 1];
  return vertices;
}

/// Facets, edges and vertex -> cell incidence of a mesh. The vertices of a facet and of an edge ascend, and
/// facets and edges are numbered in the lexicographic order of their vertices.
template <int dim>
struct Topology
{
  static constexpr int n_cell_edges = dim * (dim + 1) / 2;

  std::vector<std::array<Index, dim>> facets;           ///< vertices
  std::vector<std::array<Index, 2>> facet_cells;        ///< second is -1 on the boundary
  std::vector<std::array<Index, dim + 1>> cell_facets;  ///< [cell][local facet]
  std::vector<std::array<Index, 2>> edges;              ///< vertices; in 2D the facets again
  /// [cell][local edge]; local edges join local vertices (0,1) (0,2) (1,2) in 2D and
  /// (0,1) (0,2) (0,3) (1,2) (1,3) (2,3) in 3D.
  std::vector<std::array<Index, n_cell_edges>> cell_edges;
  std::vector<Index> vertex_cells_begin;  ///< CSR offsets, size n_vertices + 1
  std::vector<Index> vertex_cells;        ///< cells around each vertex, ascending

  /// The number of the facet with these vertices, in any order; -1 if there is none.
  [[nodiscard]] Index facet(std::array<Index, dim> vertices) const
  {
    std::ranges::sort(vertices);
    const auto found = std::ranges::lower_bound(facets, vertices);
    return found == facets.end() || *found != vertices ? -1 : static_cast<Index>(found - facets.begin());
  }
  /// The local number of a facet of a cell.
  [[nodiscard]] int local_facet(Index cell, Index facet) const
  {
    const auto& facets_of_cell = cell_facets[cell];
    return static_cast<int>(std::ranges::find(facets_of_cell, facet) - facets_of_cell.begin());
  }
};

/// The vertices of each local edge, see Topology::cell_edges.
template <int dim>
inline constexpr auto local_edges = []
{
  std::array<std::array<int, 2>, dim*(dim + 1) / 2> edges{};
  int k = 0;
  for (int i = 0; i <= dim; ++i)
    for (int j = i + 1; j <= dim; ++j) edges[k++] = {i, j};
  return edges;
}();

template <int dim>
struct MeshPart;
template <int dim>
struct Partition;

/// A conforming simplicial mesh of a polygon or polyhedron, or the part of one that a rank has: its own
/// cells, followed by ghosts, which are cells of other ranks around them or opposite to them. The outer
/// facets of ghosts are not boundary.
template <int dim>
class Mesh
{
 public:
  /// Verifies `data` (see docs/case-format.md, "Mesh") and finds the boundary. Throws InputError: inverted,
  /// degenerate or duplicate cells, unused vertices, a facet shared by more than two cells, hanging nodes,
  /// cells that overlap across a facet, boundaries that touch or cross elsewhere than on
  /// interfaces, tagged facets that are not on the boundary or in two groups, a vertex
  /// whose cells are not connected through facets.
  explicit Mesh(MeshData<dim> data);
  /// Verifies what this rank can see. Throws InputError, on this rank alone.
  Mesh(MeshPart<dim> part, MeshLabels labels);

  [[nodiscard]] Index n_vertices() const { return static_cast<Index>(vertices_.size()); }
  [[nodiscard]] Index n_cells() const { return static_cast<Index>(cells_.size()); }
  [[nodiscard]] const Point<dim>& vertex(Index v) const { return vertices_[v]; }
  [[nodiscard]] const Cell<dim>& cell(Index c) const { return cells_[c]; }
  [[nodiscard]] int region(Index c) const { return regions_[c]; }
  [[nodiscard]] std::span<const Point<dim>> vertices() const { return vertices_; }
  [[nodiscard]] std::span<const Cell<dim>> cells() const { return cells_; }
  [[nodiscard]] std::span<const BoundaryFacet> boundary() const { return boundary_; }
  [[nodiscard]] std::span<const std::string> region_names() const { return labels_.region_names; }
  [[nodiscard]] std::span<const std::string> boundary_names() const { return labels_.boundary_names; }
  [[nodiscard]] const Where& source() const { return labels_.source; }
  /// As in MeshData.
  [[nodiscard]] std::span<const std::uint8_t> bisection_types() const { return bisection_types_; }
  [[nodiscard]] const Ancestry& ancestry() const { return ancestry_; }
  [[nodiscard]] std::span<const Interface> interfaces() const { return labels_.interfaces; }
  /// All labels; a mesh made from this one inherits them.
  [[nodiscard]] const MeshLabels& labels() const { return labels_; }

  [[nodiscard]] const Topology<dim>& topology() const { return *topology_; }

  /// The first cells are those of this rank; on a whole mesh all.
  [[nodiscard]] Index n_owned_cells() const { return n_owned_cells_; }
  /// Whether a vertex has an own cell; all its cells are then here.
  [[nodiscard]] bool has_patch(Index v) const { return has_patch_.empty() || has_patch_[v] != 0; }
  /// How the mesh is shared out; null for a whole mesh.
  [[nodiscard]] const Partition<dim>* partition() const { return partition_.get(); }
  /// Counts for the whole mesh.
  [[nodiscard]] std::int64_t n_global_cells() const;
  [[nodiscard]] std::int64_t n_global_vertices() const;
  /// The ranks that have a part; for a whole mesh this one alone.
  [[nodiscard]] const Ranks& ranks() const { return ranks_; }
  /// The facets of own cells come first in boundary().
  [[nodiscard]] std::size_t n_owned_boundary() const { return n_owned_boundary_; }
  [[nodiscard]] std::span<const BoundaryFacet> owned_boundary() const
  {
    return boundary().first(n_owned_boundary_);
  }
  /// Whether what lies opposite to this rank's part is among the ghosts, see contact::with_partners().
  [[nodiscard]] bool has_partners() const { return has_partners_; }
  void set_has_partners() { has_partners_ = true; }

 private:
  void take(MeshData<dim> data, Topology<dim> topology);

  std::vector<Point<dim>> vertices_;
  std::vector<Cell<dim>> cells_;
  std::vector<int> regions_;
  std::vector<BoundaryFacet> boundary_;
  MeshLabels labels_;
  std::vector<std::uint8_t> bisection_types_;
  Ancestry ancestry_;
  std::unique_ptr<const Topology<dim>> topology_;
  std::shared_ptr<const Partition<dim>> partition_;
  Ranks ranks_;
  Index n_owned_cells_ = 0;
  std::size_t n_owned_boundary_ = 0;
  bool has_partners_ = false;
  std::span<const char> has_patch_;  ///< of the partition
};

/// The numbers in Mesh::boundary() of the facets of the named boundaries, ascending.
template <int dim>
[[nodiscard]] std::vector<std::size_t> facets_named(const Mesh<dim>& mesh,
                                                    std::span<const std::string> names);

/// Facets, edges and incidence by counting sorts, O(n). The cells may be unverified: where more than two
/// share a facet, facet_cells holds the first two.
template <int dim>
[[nodiscard]] Topology<dim> build_topology(Index n_vertices, std::span<const Cell<dim>> cells);

/// For each cell the number of the part connected through facets that it is in; parts are numbered by their
/// first cells.
template <int dim>
[[nodiscard]] std::vector<int> connected_parts(const Topology<dim>& topology);

}  // namespace tribound::mesh
