#pragma once

/// @file dimension.h
/// Checks vectors of a case against the dimension of its mesh.

#include <fmt/format.h>

#include <cstddef>
#include <string_view>

#include "tribound/base/error.h"

namespace tribound::case_file
{

/// The position of a key in a table.
[[nodiscard]] inline Where inside(const Where& table, std::string_view key)
{
  Where where = table;
  where.key += fmt::format(".{}", key);
  return where;
}

/// Throws InputError for a vector that does not have dim components.
template <int dim>
void check_length(std::size_t size, const Where& where)
{
  if (size != dim)
    throw InputError(where, fmt::format("has {} components, but the mesh is {}D", size, dim),
                     fmt::format("give {}", dim));
}

}  // namespace tribound::case_file
