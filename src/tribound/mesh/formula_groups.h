#pragma once

/// @file formula_groups.h
/// Regions and boundaries given by formulas of the place.

#include <span>
#include <string>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// A new group of cells, or of facets: those where `condition` is not 0.
struct FormulaGroup
{
  std::string name;
  std::string condition;          ///< formula of x, y, z; for facets also of the outward normal nx, ny, nz
  Where where{};                  ///< of the condition, for messages
  std::vector<std::string> of{};  ///< the groups it is taken from; empty: see add_groups()
  bool is_region = false;
};

/// Throws InputError at `where` if the condition is no formula.
void check_condition(const FormulaGroup& group);

/// Makes the groups of a mesh that is not verified yet. A facet belongs to one if all its vertices and its
/// centre satisfy the condition, a cell if its centre does. They are taken from the groups `of`, which keep
/// the rest, and are gone if nothing is left; without `of` facets from the outer ones in no group, cells from
/// the only region.
///
/// Throws InputError at `where`: an unknown group, a name that the mesh has, no facet or cell that belongs to
/// the group, one that belongs to two, a formula that has no value there; and as check_arrays().
template <int dim>
void add_groups(MeshData<dim>& data, std::span<const FormulaGroup> groups);

}  // namespace tribound::mesh
