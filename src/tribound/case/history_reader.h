#pragma once

/// @file history_reader.h
/// [history]: the load steps of a case.

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// [history].
[[nodiscard]] const Table& history_table();

/// Reads [history] of a case whose contacts are read already, and how its steps are solved unless [newton]
/// says otherwise. An interface alone is a history of one step.
void read_load_steps(const TableReader& root, Config& config);

/// Throws InputError for what does not go with load steps, once all of the case is read.
void check_load_steps(const TableReader& root, Config& config);

}  // namespace tribound::case_file
