#pragma once

/// @file region_reader.h
/// [material] and [load], of the whole body or by region.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

[[nodiscard]] const Table& material_table();
[[nodiscard]] const Table& load_table();

/// Reads E, nu, plane, directly or in [material.<region>]; `plane` given directly is the default of the
/// regions.
[[nodiscard]] std::vector<MaterialConfig> read_materials(const Node& table);

/// Reads body, directly or in [load.<region>].
[[nodiscard]] std::vector<LoadConfig> read_loads(const Node& table);

}  // namespace tribound::case_file
