#include "tribound/mesh/import/vtk_file.h"

#include <fmt/format.h>

namespace tribound::mesh
{

namespace
{

/// "n, node, ..., n, node, ..." of the formats before 5.0.
void separate(const VtkPiece& piece, std::span<const std::int64_t> numbers, VtkCells& cells)
{
  std::size_t i = 0;
  cells.nodes.reserve(numbers.size());
  for (std::size_t c = 0; c < piece.n_cells; ++c)
  {
    const std::int64_t n = i < numbers.size() ? numbers[i++] : -1;
    if (n < 0 || n > std::ssize(numbers) - static_cast<std::int64_t>(i))
      throw InputError(piece.where, fmt::format("the nodes of cell {} are missing", c),
                       "CELLS has the number of nodes of each cell, and their numbers");
    const auto nodes = numbers.subspan(i, n);
    cells.nodes.insert(cells.nodes.end(), nodes.begin(), nodes.end());
    cells.begin.push_back(std::ssize(cells.nodes));
    i += n;
  }
}

void check(const VtkPiece& piece, const VtkCells& cells)
{
  for (std::size_t c = 0; c < piece.n_cells; ++c)
  {
    if (cells.begin[c + 1] < cells.begin[c])
      throw InputError(piece.where, fmt::format("the nodes of cell {} end before they begin", c),
                       "the file is damaged: write it again");
    for (std::int64_t i = cells.begin[c]; i < cells.begin[c + 1]; ++i)
      if (cells.nodes[i] < 0 || cells.nodes[i] >= static_cast<std::int64_t>(piece.n_points))
        throw InputError(piece.where,
                         fmt::format("node {} of cell {} does not exist: there are {} points", cells.nodes[i],
                                     c, piece.n_points),
                         "nodes and cells are counted from 0");
  }
}

}  // namespace

VtkFile open_vtk(const std::filesystem::path& path)
{
  VtkFile file;
  if (path.extension() == ".vtk")
    open_vtk_legacy(path, file);
  else
    open_vtk_xml(path, file);
  return file;
}

VtkCells cells_of(const VtkPiece& piece)
{
  VtkCells cells{values_of<std::int64_t>(piece.types, piece.n_cells, piece.where), {0}, {}};
  cells.begin.reserve(piece.n_cells + 1);
  if (piece.offsets.type == VtkType::other)
    separate(piece, values_of<std::int64_t>(piece.connectivity, piece.n_connectivity, piece.where), cells);
  else
  {
    const std::size_t first = piece.begins_with_zero ? 1 : 0;
    const auto offsets = values_of<std::int64_t>(piece.offsets, piece.n_cells + first, piece.where);
    cells.begin.insert(cells.begin.end(), offsets.begin() + static_cast<std::ptrdiff_t>(first),
                       offsets.end());
    const std::int64_t n = cells.begin.back();
    if (n < 0 || (first == 1 && offsets.front() != 0))
      throw InputError(piece.where, "the offsets of the cells are wrong",
                       "the file is damaged: write it again");
    for (const std::int64_t offset : offsets)
      if (offset < 0 || offset > n)
        throw InputError(piece.where,
                         fmt::format("the offset {} of a cell is beyond the last one, {}", offset, n),
                         "the file is damaged: write it again");
    cells.nodes = values_of<std::int64_t>(piece.connectivity, n, piece.where);
  }
  check(piece, cells);
  return cells;
}

}  // namespace tribound::mesh
