#pragma once

/// @file box.h
/// Structured meshes of a rectangle or a cuboid.

#include <cstdint>
#include <optional>
#include <vector>

#include "tribound/mesh/mesh.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// Throws InputError for a box that is not of 2 or 3 dimensions, has no volume or no cells, or more of them
/// than ranks can share.
void require_valid(const BoxMesh& box);

/// Vertex (i, j) has number j (nx+1) + i; square (i, j) is cut from lower left to upper right into
/// (v00, v10, v11), (v00, v11, v01). A cube is cut into 6 Kuhn tetrahedra around its diagonal v000 - v111.
/// Boundary names: left right bottom top, in 3D also back (z = lower) and front (z = upper). Region: "box".
/// Throws as require_valid() does, and where an Index cannot number the edges of all cells.
template <int dim>
[[nodiscard]] MeshData<dim> box_mesh(const BoxMesh& box);

/// Boxes of one dimension, one after the other. Throws as box_mesh() does, and for boxes of different
/// dimensions.
template <int dim>
[[nodiscard]] MeshData<dim> box_meshes(const Boxes& boxes);

/// The names of a box. Throws as require_valid() does.
template <int dim>
[[nodiscard]] MeshLabels box_labels(const BoxMesh& box);

/// The names of several boxes, each with its own. Throws as box_meshes() does.
template <int dim>
[[nodiscard]] MeshLabels box_labels(const Boxes& boxes);

/// The number of cells of a box or of several.
[[nodiscard]] std::int64_t n_box_cells(const BoxMesh& box);
[[nodiscard]] std::int64_t n_box_cells(const Boxes& boxes);
/// Nothing for a file.
[[nodiscard]] std::optional<std::int64_t> n_box_cells(const MeshSource& source);

/// A box with the same sides and half as many cells in each direction, halved again until there are at most
/// `most_cells`.
[[nodiscard]] BoxMesh coarser_box(BoxMesh box, std::int64_t most_cells);
/// Each with its share of `most_cells`.
[[nodiscard]] Boxes coarser_box(Boxes boxes, std::int64_t most_cells);
/// A file stays as it is.
[[nodiscard]] MeshSource coarser_box(MeshSource source, std::int64_t most_cells);

/// The cells number first, ..., last - 1, as first_records() gives them, made without the others.
template <int dim>
[[nodiscard]] std::vector<CellRecord<dim>> box_records(const BoxMesh& box, std::int64_t first,
                                                       std::int64_t last);
template <int dim>
[[nodiscard]] std::vector<CellRecord<dim>> box_records(const Boxes& boxes, std::int64_t first,
                                                       std::int64_t last);

}  // namespace tribound::mesh
