#pragma once

/// @file vtk_array.h
/// The arrays of a VTK file, decoded when they are wanted.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/base/error.h"

namespace tribound::mesh
{

enum class VtkType : char
{
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  other  ///< texts and bits
};

/// Bytes per number; 0 for VtkType::other.
[[nodiscard]] std::size_t size_of(VtkType type);
[[nodiscard]] inline bool is_integer(VtkType type)
{
  return type < VtkType::float32;
}

/// How numbers stand in a file.
struct VtkCoding
{
  enum class Format : char
  {
    text,
    base64,
    raw
  };

  Format format = Format::text;
  std::size_t header_size = 0;  ///< bytes of each count before the data; 0: there are none
  bool is_swapped = false;      ///< the order of bytes is not that of this machine
  bool is_compressed = false;   ///< by blocks in zlib's format
};

struct VtkArray
{
  std::string name{};
  VtkType type = VtkType::other;
  std::size_t n_components = 1;
  VtkCoding coding{};
  std::string_view data{};                     ///< begins with the array; may go on behind it
  std::vector<std::string> component_names{};  ///< one for each, or none
};

/// The array with the name; nullptr if there is none.
[[nodiscard]] const VtkArray* find(std::span<const VtkArray> arrays, std::string_view name);

/// Its `n` numbers; T is double or std::int64_t. Throws InputError if it has fewer or more, if they cannot be
/// decoded, and if integers are wanted where there are others. Takes no more memory than its data can hold.
template <class T>
[[nodiscard]] std::vector<T> values_of(const VtkArray& array, std::size_t n, const Where& where);

}  // namespace tribound::mesh
