#pragma once

/// @file choices.h
/// What the options of a mesh change in what a file says.

#include <span>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// Makes one node of nodes that are at most `distance` apart and have elements of one region; those of
/// different regions stay apart. `notes` gets how many. Throws InputError for an element that two of its
/// nodes become one of.
void merge_nodes(ImportedMesh& mesh, double distance, std::vector<std::string>& notes);

/// Leaves out the sets of facets and of nodes that are not among `names`. Throws InputError for a name that
/// no set has, and later for a chosen set of nodes without a facet.
void choose_boundaries(ImportedMesh& mesh, std::span<const std::string> names);

}  // namespace tribound::mesh
