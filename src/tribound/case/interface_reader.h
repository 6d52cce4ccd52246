#pragma once

/// @file interface_reader.h
/// Interfaces with a memory, as the case file has them.

#include <initializer_list>
#include <string_view>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// The keys of `interface = { law = ... }`, and the given ones.
[[nodiscard]] std::vector<std::string_view> interface_keys(
    std::initializer_list<std::string_view> others = {});

/// The contact that an interface table describes, with `gap` as it is before the table is read.
[[nodiscard]] problem::Contact read_interface(const TableReader& table, std::optional<problem::Field> gap);

}  // namespace tribound::case_file
