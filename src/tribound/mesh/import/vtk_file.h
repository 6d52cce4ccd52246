#pragma once

/// @file vtk_file.h
/// Unstructured grids in VTK's formats: which arrays a file has.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/mesh/import/vtk_array.h"

namespace tribound::mesh
{

/// A part of a grid with points and cells of its own.
struct VtkPiece
{
  Where where{};
  std::size_t n_points = 0;
  std::size_t n_cells = 0;
  VtkArray points{};
  VtkArray types{};
  VtkArray connectivity{};
  VtkArray offsets{};  ///< of type `other`: in `connectivity` each cell begins with its number of nodes
  bool begins_with_zero = false;   ///< whether the offsets also have the beginning of the first cell
  std::size_t n_connectivity = 0;  ///< numbers of `connectivity` where there are no offsets
  bool has_old_hexahedra = false;  ///< of order 2, with the last two edges of VTK 8
  std::vector<VtkArray> point_data{};
  std::vector<VtkArray> cell_data{};
};

struct VtkFile
{
  std::vector<std::unique_ptr<std::string>> contents{};  ///< what the arrays point to
  std::vector<VtkPiece> pieces{};
};

/// Reads .vtu, .pvtu with its parts, and .vtk of the versions 2.0 to 5.1; no array is decoded. Throws
/// InputError with the file, and the line of a fault in XML.
[[nodiscard]] VtkFile open_vtk(const std::filesystem::path& file);

/// .vtu and .pvtu: appends the pieces.
void open_vtk_xml(const std::filesystem::path& path, VtkFile& file);
/// .vtk: appends its only piece.
void open_vtk_legacy(const std::filesystem::path& path, VtkFile& file);

/// The cells of a piece, whose nodes are counted within it.
struct VtkCells
{
  std::vector<std::int64_t> types;
  std::vector<std::int64_t> begin;  ///< of each cell in `nodes`, and the end of all
  std::vector<std::int64_t> nodes;
};

/// Throws InputError unless the nodes are those of the piece; cells are counted from 0.
[[nodiscard]] VtkCells cells_of(const VtkPiece& piece);

}  // namespace tribound::mesh
