#pragma once

/// @file partition.h
/// How a mesh is shared out between ranks: every rank has its own cells and, as ghosts, one layer of
/// other ranks' cells around them and whatever else it needs.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tribound/base/ghost_update.h"
#include "tribound/base/ranks.h"
#include "tribound/mesh/cell_name.h"
#include "tribound/mesh/curve.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// What a facet of a cell is: the position of its group in MeshData::boundary_names, or one of these.
enum FacetTag : std::int32_t
{
  facet_inside = -2,    ///< between two cells
  facet_ungrouped = -1  ///< of the boundary, in no group
};

/// A FacetTag per local facet.
template <int dim>
using CellTags = std::array<std::int32_t, dim + 1>;

/// The tags of all cells. `boundary`: as find_boundary() gives it.
template <int dim>
[[nodiscard]] std::vector<CellTags<dim>> cell_tags(std::size_t n_cells,
                                                   std::span<const BoundaryFacet> boundary);

/// A cell as it is sent between ranks. The order of its vertices is part of it.
template <int dim>
struct CellRecord
{
  CellName name;
  std::array<VertexName<dim>, dim + 1> vertices;
  CellTags<dim> tags;  ///< of the facet opposite to each vertex
  std::int32_t region;
  std::int32_t bisection_type;

  friend bool operator==(const CellRecord&, const CellRecord&) = default;
};

/// The cells of a first mesh as bisect() orders their vertices, so that they are bisected the same way
/// whichever rank has them. `boundary`: as find_boundary() gives it.
template <int dim>
[[nodiscard]] std::vector<CellRecord<dim>> first_records(const MeshData<dim>& data,
                                                         std::span<const BoundaryFacet> boundary);
/// The records of the cells number first, ..., last - 1.
template <int dim>
[[nodiscard]] std::vector<CellRecord<dim>> first_records(const Mesh<dim>& mesh, Index first, Index last);

/// A cell of another rank.
template <int dim>
struct Ghost
{
  CellRecord<dim> cell;
  int owner;
};

/// What a rank knows of how the mesh is shared out. Its own cells come first, in ascending order of their
/// names, then ghosts likewise: every cell of other ranks that shares a vertex with one of its own, and those
/// that with_more_ghosts() has added. The vertices are in ascending order of (morton_key, name), which is the
/// same on all ranks.
template <int dim>
struct Partition
{
  Ranks ranks;
  Cube<dim> cube;  ///< around the first mesh
  Index n_owned_cells = 0;
  std::vector<CellName> names;            ///< per cell
  std::vector<int> ghost_owners;          ///< per ghost cell
  std::vector<VertexName<dim>> vertices;  ///< per vertex
  /// Per vertex, whether it has an own cell: then all its cells are here. Not for cells that are picked out
  /// of a mesh.
  std::vector<char> has_patch;
  std::vector<std::int32_t> sharers_begin;  ///< per vertex, into `sharers`; one more at the end
  std::vector<int> sharers;     ///< other ranks with own cells around a vertex that has a patch, ascending
  std::int64_t n_cells = 0;     ///< of the whole mesh
  std::int64_t n_vertices = 0;  ///< of the whole mesh
  std::vector<int> bodies;      ///< per cell, if cells are picked out: as number_bodies() numbers them

  [[nodiscard]] std::span<const int> sharers_of(Index v) const
  {
    return std::span(sharers).subspan(sharers_begin[v], sharers_begin[v + 1] - sharers_begin[v]);
  }
};

/// The part of a mesh that a rank has.
template <int dim>
struct MeshPart
{
  std::vector<CellRecord<dim>> cells;  ///< its own and ghosts, as Partition orders them
  std::vector<Cell<dim>> corners;      ///< their vertices, local numbers
  Partition<dim> partition;
};

/// The part of a rank that owns the cells `owned`, in any order, with its ghosts. All ranks call it together.
/// Cells around a vertex are connected through inner facets that contain it. Ranks exchange only what
/// lies along their common surface.
template <int dim>
[[nodiscard]] MeshPart<dim> with_ghosts(const Ranks& ranks, const Cube<dim>& cube,
                                        std::vector<CellRecord<dim>> owned);

/// The same part with other ghosts, which include those of with_ghosts(); own cells ascend. Ranks may call it
/// alone.
template <int dim>
[[nodiscard]] MeshPart<dim> with_these_ghosts(const Partition<dim>& before,
                                              std::vector<CellRecord<dim>> owned,
                                              std::vector<Ghost<dim>> ghosts);

/// The rank of each cell such that all ranks have the same weight: stretches of the curve along which `keys`
/// ascend. Nothing of the size of the mesh is exchanged, and the new rank of a cell does not depend on its
/// present one.
[[nodiscard]] std::vector<int> balanced_ranks(const Ranks& ranks, std::span<const std::uint64_t> keys,
                                              std::span<const std::int64_t> weights);

/// hilbert_key() of the centres.
template <int dim>
[[nodiscard]] std::vector<std::uint64_t> centre_keys(const Cube<dim>& cube,
                                                     std::span<const CellRecord<dim>> cells);

/// Updates values of ghost cells from their owners.
template <int dim>
[[nodiscard]] GhostUpdate cell_update(const Partition<dim>& partition);

}  // namespace tribound::mesh
