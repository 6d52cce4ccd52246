#pragma once

/// @file bisect.h
/// Local refinement by bisection: newest vertex in 2D, Arnold, Mukherjee and Pouly in 3D.

#include <span>
#include <vector>

#include "tribound/mesh/mesh.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/twin_facets.h"

namespace tribound::mesh
{

template <int dim>
struct Bisected
{
  Mesh<dim> mesh;
  std::vector<Index> parent;  ///< per cell of `mesh`: the cell of the original mesh that contains it
};

/// The coarsest conforming mesh, among those that these bisections can reach, in which every cell inside a
/// marked one results from at least `times` bisections of it. With times = dim, every edge of a marked cell
/// is halved. All cells of the mesh may be marked, in any order and more than once.
///
/// Regions, boundary tags and names are inherited. The vertices keep their numbers, and the descendants of a
/// cell follow each other in the order of the cells. Whatever was marked and however often this is repeated,
/// the cells belong to a number of similarity classes that depends on the initial mesh alone [AMP00]. Edges
/// of equal length are told apart by their coordinates: how the cells are cut depends neither on the
/// numbering nor on the order of `marked`.
///
/// `twins` stay twins: what is halved on one of them is halved on the other, too (mesh/twin_facets.h).
///
/// Throws InputError when the cells outgrow 32-bit numbers.
template <int dim>
[[nodiscard]] Bisected<dim> bisect(const Mesh<dim>& mesh, std::span<const Index> marked, int times = dim,
                                   std::span<const TwinFacets<dim>> twins = {});

/// The own cells of a rank in the bisected mesh, by their names in ascending order.
template <int dim>
struct BisectedPart
{
  std::vector<CellRecord<dim>> cells;
  std::vector<Index> parent;  ///< per cell: the own cell of the original mesh that contains it
};

/// The same for a mesh that is shared out between ranks. Each marks some of its own cells and knows the twins
/// of facets of own cells, which may be ghosts'. All call it together; the cells of all ranks are those of
/// bisect(), to the bit. Ghosts come from with_ghosts(), on this rank or wherever the cells are sent. Throws
/// InputError, on all ranks, when cells outgrow 32-bit numbers or CellName::max_depth.
template <int dim>
[[nodiscard]] BisectedPart<dim> bisect_part(const Mesh<dim>& mesh, std::span<const Index> marked,
                                            int times = dim, std::span<const TwinFacets<dim>> twins = {});

}  // namespace tribound::mesh
