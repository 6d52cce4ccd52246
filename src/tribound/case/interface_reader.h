#pragma once

/// @file interface_reader.h
/// Interfaces with a memory, as the case file has them.

#include <optional>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// `interface = { law = ... }`, with the given keys beside its own.
[[nodiscard]] Table interface_table(const std::vector<Key>& others = {});

/// The contact that an interface table describes, with `gap` as it is before the table is read.
[[nodiscard]] problem::Contact read_interface(const TableReader& table, std::optional<problem::Field> gap);

}  // namespace tribound::case_file
