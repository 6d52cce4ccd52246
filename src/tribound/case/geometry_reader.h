#pragma once

/// @file geometry_reader.h
/// What contacts say of obstacles and shapes.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/geometry.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// `obstacle`, `shape` and `normal` of the contact of a boundary; `shape` and `normal` of a pair.
[[nodiscard]] std::vector<Key> obstacle_geometry_keys();
[[nodiscard]] std::vector<Key> pair_geometry_keys();

/// What these keys say.
[[nodiscard]] GeometryConfig read_obstacle_geometry(const TableReader& table);
[[nodiscard]] GeometryConfig read_pair_geometry(const TableReader& table);

/// Throws for names that there are not, and for obstacles and shapes that nothing uses.
void check_surfaces(const Config& config);

}  // namespace tribound::case_file
