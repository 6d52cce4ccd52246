#pragma once

/// @file surface_reader.h
/// [obstacle.NAME] and [shape.NAME].

#include <filesystem>
#include <vector>

#include "tribound/case/geometry.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

/// [obstacle] and [shape].
[[nodiscard]] const Table& obstacles_table();
[[nodiscard]] const Table& shapes_table();

/// The tables of [obstacle] or [shape]; paths are relative to `case_directory`.
[[nodiscard]] std::vector<SurfaceConfig> read_obstacles(const Node& node,
                                                        const std::filesystem::path& case_directory);
[[nodiscard]] std::vector<SurfaceConfig> read_shapes(const Node& node,
                                                     const std::filesystem::path& case_directory);

}  // namespace tribound::case_file
