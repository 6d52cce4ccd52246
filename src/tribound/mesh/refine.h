#pragma once

/// @file refine.h
/// Uniform (red) refinement: every cell is cut at the middles of its edges.

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// A mesh refined uniformly. Child i of cell c has number 2^dim c + i after each refinement; its first dim +
/// 1 children are at the vertices of the cell, in their order, the others in the middle.
template <int dim>
struct Refined
{
  Mesh<dim> mesh;
  int times;  ///< refinements between the original mesh and this one

  /// The cell of the original mesh that contains `cell`.
  [[nodiscard]] Index ancestor(Index cell) const { return cell >> (dim * times); }
};

/// Numbers of the entities of a mesh.
struct EntityCounts
{
  double vertices = 0;
  double edges = 0;
  double facets = 0;
  double cells = 0;
};

/// The numbers after `times` refinements, without refining.
template <int dim>
[[nodiscard]] EntityCounts count_after_refinement(const Mesh<dim>& mesh, int times);

/// Cuts every triangle into 4 similar ones, every tetrahedron into 4 similar ones at its vertices and 4
/// around the shortest diagonal of the octahedron that remains [Zhang95]; the tests watch the angles over
/// four levels. Regions, boundary tags and names are inherited; the vertices keep their numbers, the middle
/// of edge e becomes vertex n_vertices + e. Conforming, because a facet is cut the same way from both sides.
/// times >= 1. Throws InputError when the cells outgrow 32-bit numbers.
template <int dim>
[[nodiscard]] Refined<dim> refine_uniformly(const Mesh<dim>& mesh, int times = 1);

}  // namespace tribound::mesh
