#pragma once

/// @file geometry_reader.h
/// Reads the obstacles and shapes of contacts.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/geometry.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// `obstacle`, `shape` and `normal` of the contact of a boundary; `shape` and `normal` of a slider, of a
/// pair.
[[nodiscard]] std::vector<Key> obstacle_geometry_keys();
[[nodiscard]] std::vector<Key> slider_geometry_keys();
[[nodiscard]] std::vector<Key> pair_geometry_keys();

/// Reads these keys.
[[nodiscard]] GeometryConfig read_obstacle_geometry(const TableReader& table);
[[nodiscard]] GeometryConfig read_slider_geometry(const TableReader& table);
[[nodiscard]] GeometryConfig read_pair_geometry(const TableReader& table);

/// Throws for unknown names, and for obstacles and shapes that are not used.
void check_surfaces(const Config& config);

}  // namespace tribound::case_file
