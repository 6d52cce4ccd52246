#pragma once

/// @file vtu_file.h
/// The container of VTK's XML format for unstructured grids: appended raw data in zlib-compressed blocks,
/// UInt64 headers. vtu.h defines the meaning of the arrays.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/deflate.h"

namespace tribound::io
{

/// Writes the numbers of one array: collected into blocks, compressed, written.
class VtuStream
{
 public:
  /// Starts an array of `n_bytes` bytes at the end of `file`.
  VtuStream(AtomicFile& file, std::uint64_t n_bytes);

  template <typename T>
  requires std::is_arithmetic_v<T>
  void put(T value)
  {
    if (used_ == block_.size()) flush();
    std::memcpy(block_.data() + used_, &value, sizeof(T));
    used_ += sizeof(T);
  }

  /// Writes the rest and the sizes of the blocks. The number of bytes must be as announced.
  void close();

 private:
  void flush();

  AtomicFile* file_;
  std::uint64_t header_position_;
  std::vector<std::uint64_t> header_;  ///< number of blocks, block size, size of a last partial block, sizes
  std::vector<std::byte> block_;
  Deflate deflate_;  ///< compresses or stores, as decided with the first block
  std::vector<std::byte> compressed_;
  std::size_t used_ = 0;
  std::size_t n_flushed_ = 0;
};

/// An array of the file; `write` puts n_tuples * n_components numbers of the type into the stream.
struct VtuArray
{
  std::string name;
  std::string type;  ///< VTK's name, such as "Float64"
  int n_components;
  std::uint64_t n_bytes;
  std::function<void(VtuStream&)> write;
};

/// VTK's name of a number type.
template <typename T>
[[nodiscard]] std::string vtu_type()
{
  if constexpr (std::floating_point<T>) return sizeof(T) == 8 ? "Float64" : "Float32";
  if constexpr (std::signed_integral<T>) return "Int" + std::to_string(8 * sizeof(T));
  if constexpr (std::unsigned_integral<T>) return "UInt" + std::to_string(8 * sizeof(T));
}

/// An array whose numbers are produced by `fill(put)`, which calls put(x) for each; they are converted to T.
template <typename T, typename Fill>
[[nodiscard]] VtuArray vtu_array(std::string name, int n_components, std::uint64_t n_tuples, Fill fill)
{
  return {std::move(name), vtu_type<T>(), n_components, n_tuples * n_components * sizeof(T),
          [fill = std::move(fill)](VtuStream& stream)
          { fill([&stream](auto value) { stream.put(static_cast<T>(value)); }); }};
}

/// Writes the components of v, padded with zeros to 3 components.
template <int dim>
void put_vector(const auto& put, const Point<dim>& v)
{
  for (int i = 0; i < 3; ++i) put(i < dim ? v[i] : 0.0);
}

/// Connectivity, offsets and types of cells without shared points: cell c has the points c n_nodes, ..., (c +
/// 1) n_nodes - 1.
[[nodiscard]] std::vector<VtuArray> disjoint_cells(std::uint64_t n_cells, std::uint64_t n_nodes,
                                                   std::uint8_t vtk_type);

/// An unstructured grid. Points have 3 components.
struct VtuGrid
{
  std::uint64_t n_points = 0;
  std::uint64_t n_cells = 0;
  double time = 0.0;                  ///< TimeValue: the level, or the number of the load step
  std::optional<double> load_factor;  ///< field data `t`, where there is one
  std::vector<VtuArray> points;       ///< one array
  std::vector<VtuArray> cells;        ///< connectivity, offsets, types
  std::vector<VtuArray> point_data;   ///< names must be valid in XML attributes
  std::vector<VtuArray> cell_data;
};

/// Writes the grid array by array; needs memory for one block only. Throws WriteError when the file cannot be
/// written.
void write_vtu(const std::filesystem::path& path, const VtuGrid& grid);

/// Writes a list (.pvtu) of the files `pieces` with such grids, by their paths relative to the list. Throws
/// WriteError when the file cannot be written.
void write_vtu_list(const std::filesystem::path& path, const VtuGrid& grid,
                    std::span<const std::string> pieces);

}  // namespace tribound::io
