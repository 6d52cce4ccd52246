#pragma once

/// @file file_text.h
/// Files as text, and the numbers and names in them.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// All bytes of a file. Throws InputError with `where` if it does not exist or cannot be read.
[[nodiscard]] std::string content_of(const std::filesystem::path& file, const Where& where,
                                     const std::string& hint);

/// In small letters (ASCII).
[[nodiscard]] std::string small_letters(std::string_view text);
/// ".step" of "Part.STEP".
[[nodiscard]] std::string suffix_of(const std::filesystem::path& file);

/// Whether a name can be shown: UTF-8 without control characters.
[[nodiscard]] bool is_utf8(std::string_view name);

/// The whole field as a number; nothing if it is none, or so large that sums of some are none.
[[nodiscard]] std::optional<std::int64_t> integer_of(std::string_view field);
/// Also with the exponents of Fortran, "1.5D-3".
[[nodiscard]] std::optional<double> number_of(std::string_view field);

}  // namespace tribound::mesh
