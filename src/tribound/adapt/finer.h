#pragma once

/// @file finer.h
/// A bisected mesh, whole or distributed, and the transfer of functions to it.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tribound/fem/space.h"
#include "tribound/mesh/cut_facets.h"
#include "tribound/mesh/mesh.h"
#include "tribound/mesh/share_out.h"
#include "tribound/mesh/twin_facets.h"

namespace tribound::adapt
{

/// How cells are bisected or cut, and where they go.
template <int dim>
struct Refinement
{
  /// 2D: cells are cut in fans here (mesh/cut_facets.h), and none is bisected.
  std::optional<std::span<const mesh::FacetCuts>> cuts{};
  std::span<const mesh::TwinFacets<dim>> twins{};  ///< of contact::twin_facets(); they remain twins
  int times = dim;
  mesh::Move move = mesh::Move::where_unbalanced;
};

/// The next mesh, and how functions are transferred to it. Refers to the original space and values.
template <int dim>
struct Finer
{
  std::int64_t n_cells;                   ///< of all ranks
  std::function<mesh::Mesh<dim>()> mesh;  ///< makes the mesh, once
  /// Transfers the functions to a space on the mesh.
  std::function<std::vector<std::vector<double>>(const fem::LagrangeSpace<dim>&)> carry;
  /// Per own cell, where cells do not migrate: the own cell of the previous mesh that contains it.
  std::span<const Index> parent;
};

/// The mesh of `space` with the marked cells bisected (mesh/bisect.h), or with cells cut, and functions of
/// the space, such as u. On a distributed mesh all ranks call this and the members of the result together;
/// cells take the values at their nodes with them. Throws InputError as bisect() and balance() do.
template <int dim>
[[nodiscard]] Finer<dim> finer_mesh(const fem::LagrangeSpace<dim>& space,
                                    std::vector<std::span<const double>> functions,
                                    std::span<const Index> marked, const Refinement<dim>& refinement = {});

}  // namespace tribound::adapt
