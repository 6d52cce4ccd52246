#pragma once

/// @file water_reader.h
/// Water in the joint of an interface, as the case file has it.

#include "tribound/case/table_reader.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// `water` of an interface.
[[nodiscard]] const Table& water_table();

/// Reads `water`, `heel` and `toe` of an interface table. Throws InputError for keys that do not go together,
/// a line without length, levels that vary in space and drains outside the line.
void read_water(const TableReader& interface, problem::Contact& contact);

}  // namespace tribound::case_file
