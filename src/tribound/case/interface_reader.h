#pragma once

/// @file interface_reader.h
/// Reads interfaces with history.

#include <optional>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// `interface = { law = ... }`, with the given keys in addition to its own.
[[nodiscard]] Table interface_table(const std::vector<Key>& others = {});

/// The contact described by an interface table, with `gap` as it is before the table is read.
[[nodiscard]] problem::Contact read_interface(const TableReader& table, std::optional<problem::Field> gap);

}  // namespace tribound::case_file
