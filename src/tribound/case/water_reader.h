#pragma once

/// @file water_reader.h
/// Reads water in the joint of an interface.

#include "tribound/case/table_reader.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// The table `water` of an interface.
[[nodiscard]] const Table& water_table();

/// Reads `water`, `heel` and `toe` of an interface table. Throws InputError for incompatible keys, a line of
/// zero length, levels that vary in space and drains outside the line.
void read_water(const TableReader& interface, problem::Contact& contact);

}  // namespace tribound::case_file
