#pragma once

/// @file history_reader.h
/// [history]: the load steps of a case.

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// [history].
[[nodiscard]] const Table& history_table();

/// Reads [history] of a case whose contacts have already been read, and how its steps are solved unless
/// [newton] says otherwise. An interface alone implies a history of one step.
void read_load_steps(const TableReader& root, Config& config);

/// Throws InputError for options incompatible with load steps, once the whole case has been read.
void check_load_steps(const TableReader& root, Config& config);

}  // namespace tribound::case_file
