#pragma once

/// @file physics.h
/// The tables [boundary] and [[contact]] of a case file.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/keys.h"
#include "tribound/case/node.h"

namespace tribound::case_file
{

/// [boundary], one [[contact]].
[[nodiscard]] const Table& boundaries_table();
[[nodiscard]] const Table& pair_table();

/// One table for each boundary.
[[nodiscard]] std::vector<BoundaryConfig> read_boundaries(const Node& table);

/// One entry for each [[contact]].
[[nodiscard]] std::vector<ContactConfig> read_contacts(const Node& array);

}  // namespace tribound::case_file
