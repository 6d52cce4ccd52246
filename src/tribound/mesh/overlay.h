#pragma once

/// @file overlay.h
/// The common refinement of two meshes that come from one by bisection.

#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// A cell of each of two meshes; the smaller one lies in the other.
struct CellPair
{
  Index a;
  Index b;
};

/// The cells of the common refinement of two meshes, each as the two cells that overlap there, of which it is
/// the smaller one. Both meshes come from the same mesh by bisect(), in any number of steps.
///
/// Bisection cuts a cell in one way only, whichever step asks for it, and puts the descendants of a cell in
/// its place. So both meshes list the leaves of subtrees of one forest in the order of that forest, and are
/// merged like sorted lists. O(n). Throws std::invalid_argument when two cells in the same place overlap
/// otherwise, as in other meshes.
template <int dim>
[[nodiscard]] std::vector<CellPair> overlay(const Mesh<dim>& a, const Mesh<dim>& b);

}  // namespace tribound::mesh
