#pragma once

/// @file physics.h
/// The tables [material], [load], [boundary] and [[contact]] of a case file.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/node.h"

namespace tribound::case_file
{

/// E, nu, plane directly or in [material.<region>]; `plane` given directly is the default of the regions.
[[nodiscard]] std::vector<MaterialConfig> read_materials(const Node& table);

/// body directly or in [load.<region>].
[[nodiscard]] std::vector<LoadConfig> read_loads(const Node& table);

/// One table for each boundary.
[[nodiscard]] std::vector<BoundaryConfig> read_boundaries(const Node& table);

/// One entry for each [[contact]].
[[nodiscard]] std::vector<ContactConfig> read_contacts(const Node& array);

}  // namespace tribound::case_file
