#pragma once

/// @file sha256.h
/// Names for contents.

#include <string>
#include <string_view>

namespace tribound
{

/// SHA-256 (FIPS 180-4) of the bytes, as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace tribound
