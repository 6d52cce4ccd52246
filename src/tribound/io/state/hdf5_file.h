#pragma once

/// @file hdf5_file.h
/// Arrays in an HDF5 file, whose rows are distributed over the ranks.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "tribound/base/ranks.h"

namespace tribound::io
{

/// A file open for writing, under a temporary name until commit(), or for reading. All ranks call every
/// member together. Rows are numbered in the order of the ranks. All members throw WriteError, or InputError
/// when reading, on all ranks.
class Hdf5File
{
 public:
  enum class Mode
  {
    write,
    read
  };

  Hdf5File(std::filesystem::path path, Mode mode, const Ranks& ranks);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// `values`: the rows of this rank, `width` numbers each.
  template <class T>
  requires std::is_arithmetic_v<T>
  void write(const std::string& name, std::span<const T> values, int width)
  {
    write_bytes(name, type<T>(), values.data(), values.size() / width, width);
  }
  /// The rows of this rank; numbers of rows per rank differ by at most one.
  template <class T>
  requires std::is_arithmetic_v<T>
  [[nodiscard]] std::vector<T> read(const std::string& name, int width)
  {
    std::vector<T> values(n_own_rows(name, width) * width);
    read_bytes(name, type<T>(), values.data(), values.size() / width, width);
    return values;
  }
  /// Writes a text of the first rank; reading returns it on all ranks.
  void write_text(const std::string& name, const std::string& text);
  [[nodiscard]] std::string read_text(const std::string& name);

  /// Throws on all ranks if `good` is false on any: the file cannot be opened, written, read.
  void require(bool good, const std::string& doing) const;

  /// Closes the file, waits until it is on disk and renames it.
  void commit();

 private:
  using Id = std::int64_t;  ///< HDF5's hid_t

  enum class Type
  {
    int32,
    int64,
    uint64,
    float64,
    character
  };
  template <class T>
  static constexpr Type type()
  {
    if constexpr (std::is_same_v<T, double>) return Type::float64;
    if constexpr (std::is_same_v<T, std::int32_t>) return Type::int32;
    if constexpr (std::is_same_v<T, std::int64_t>) return Type::int64;
    if constexpr (std::is_same_v<T, std::uint64_t>) return Type::uint64;
    if constexpr (std::is_same_v<T, char>) return Type::character;
  }

  [[nodiscard]] std::uint64_t n_own_rows(const std::string& name, int width);
  void write_bytes(const std::string& name, Type type, const void* values, std::uint64_t n_rows, int width);
  void read_bytes(const std::string& name, Type type, void* values, std::uint64_t n_rows, int width);

  std::filesystem::path path_;
  std::filesystem::path actual_;  ///< the temporary name when writing
  Mode mode_;
  Ranks ranks_;
  Id file_ = -1;
  bool is_temporary_ = false;
};

}  // namespace tribound::io
