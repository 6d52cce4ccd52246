#pragma once

/// @file verify.h
/// The steps of the verification of a mesh, in the order in which Mesh's constructor takes them: each relies
/// on what the steps before have verified. All throw InputError naming the place with its coordinates.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/mesh/interfaces.h"
#include "tribound/mesh/mesh.h"
#include "tribound/mesh/outer_facets.h"
#include "tribound/mesh/partition.h"

namespace tribound::mesh
{

/// There are cells; the arrays match; vertex, region and group numbers are in range; coordinates are finite.
template <int dim>
void check_arrays(const MeshData<dim>& data);

struct ShapeFault
{
  std::string problem;  ///< "is inverted: ..."
  std::string hint;
};

/// Why a cell with these corners has no usable reference map; nothing if it has one: det J > 1e-12 h_T^dim,
/// and the powers of h_T are numbers.
template <int dim>
[[nodiscard]] std::optional<ShapeFault> shape_fault(const std::array<Point<dim>, dim + 1>& corners);

/// No cell has a shape_fault().
template <int dim>
void check_shapes(const MeshData<dim>& data);

/// No facet has more than two cells, no cell appears twice, and the two cells of a facet lie on its two
/// sides.
template <int dim>
void check_facets(const MeshData<dim>& data, const Topology<dim>& topology);

/// The cells meet in whole facets. Except on interfaces, no vertex and, in 3D, no face centre lies on a facet
/// of the topological boundary that it does not belong to, and no two boundary vertices are at one place. No
/// two facets overlap unless they are opposite there. Only facets with one cell are looked at, because a
/// hanging vertex leaves such facets on both sides.
template <int dim>
void check_conformity(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                      const Interfaces<dim>& interfaces);

/// No two cells overlap, except those of bodies that an interface joins: the boundary does not cross itself,
/// and no part of it lies inside other cells. O(n log n) in the facets of the boundary.
template <int dim>
void check_overlap(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                   const Interfaces<dim>& interfaces);

/// The facets with one cell, in the order of their numbers, with the tags of data.facets. Every tagged facet
/// must be one of them, in only one group.
template <int dim>
[[nodiscard]] std::vector<BoundaryFacet> find_boundary(const MeshData<dim>& data,
                                                       const Topology<dim>& topology);

/// The same for a part of a mesh, by the tags of its cells, those of the first `n_owned` cells first. Inner
/// facets with a vertex that has its patch here must have two cells, and boundary facets one: else the mesh
/// does not conform, or a ghost is missing.
template <int dim>
[[nodiscard]] std::vector<BoundaryFacet> find_boundary(const MeshData<dim>& data,
                                                       const Topology<dim>& topology,
                                                       std::span<const CellRecord<dim>> cells, Index n_owned,
                                                       std::span<const char> has_patch);

/// Every vertex has cells, and they are connected through facets that contain the vertex. If `which` is not
/// empty, only vertices where it is not 0 are looked at.
template <int dim>
void check_vertices(const MeshData<dim>& data, const Topology<dim>& topology,
                    std::span<const char> which = {});

}  // namespace tribound::mesh
