#pragma once

/// @file geometry_reader.h
/// Obstacles, shapes and what contacts say of them, from the tables of a case.

#include <filesystem>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/geometry.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// The tables of [obstacle] or [shape]; paths lead from `case_directory`.
[[nodiscard]] std::vector<SurfaceConfig> read_obstacles(const Node& node,
                                                        const std::filesystem::path& case_directory);
[[nodiscard]] std::vector<SurfaceConfig> read_shapes(const Node& node,
                                                     const std::filesystem::path& case_directory);

/// `obstacle`, `shape` and `normal` of the contact of a boundary.
[[nodiscard]] GeometryConfig read_obstacle_geometry(const TableReader& table);
/// `shape` and `normal` of a pair.
[[nodiscard]] GeometryConfig read_pair_geometry(const TableReader& table);

/// Throws for names that there are not, and for obstacles and shapes that nothing uses.
void check_surfaces(const Config& config);

}  // namespace tribound::case_file
