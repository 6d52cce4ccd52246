#pragma once

/// @file method_reader.h
/// Reads how a case is solved and what is written: [nitsche], [newton], [regularisation], [adapt], [certify],
/// [solver], [study] and [output].

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// The value of `output.checkpoint`.
void convert(const Node& node, const Value& value, Checkpoints& target);

/// These keys of a case.
[[nodiscard]] std::vector<Key> method_keys();

/// Reads them. The degree and the output directory of the case are already known.
void read_method(const TableReader& root, Config& config);

}  // namespace tribound::case_file
