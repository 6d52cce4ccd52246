#pragma once

/// @file quantity_reader.h
/// [[quantity]]: numbers requested with error bars, and their use in the case.

#include <span>
#include <string>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/node.h"
#include "tribound/case/table_reader.h"
#include "tribound/problem/quantity.h"

namespace tribound::case_file
{

/// One [[quantity]].
[[nodiscard]] const Table& quantity_table();

/// One entry for each [[quantity]].
[[nodiscard]] std::vector<QuantityConfig> read_quantities(const Node& array);

/// Sets certify.energy, if not given, to what [adapt] requires. Throws InputError where the given value is
/// insufficient, and for a goal that is not a quantity of the case.
void check_error_bars(const TableReader& root, Config& config);

/// The quantities of the case, for its problem on a mesh with these names of boundaries. Throws InputError as
/// problem::boundary_number() does, and for vectors of wrong length.
template <int dim>
[[nodiscard]] std::vector<problem::Quantity<dim>> resolve_quantities(
    const Config& config, const problem::Problem<dim>& problem, std::span<const std::string> boundary_names);

}  // namespace tribound::case_file
