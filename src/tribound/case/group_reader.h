#pragma once

/// @file group_reader.h
/// `where` and `of`: boundaries and regions by formulas.

#include <string>
#include <vector>

#include "tribound/case/keys.h"
#include "tribound/case/node.h"
#include "tribound/mesh/formula_groups.h"

namespace tribound::case_file
{

/// The keys `where` and `of`, in the tables of boundaries and of regions.
[[nodiscard]] std::vector<Key> group_keys();

/// Whether the table of a boundary only says where it is, as for one side of a [[contact]].
[[nodiscard]] bool gives_only_a_group(const Node& table);

/// The groups of [boundary] and [material] in the order of the case; `boundaries` may be null.
[[nodiscard]] std::vector<mesh::FormulaGroup> read_groups(const Node* boundaries, const Node& materials);

}  // namespace tribound::case_file
