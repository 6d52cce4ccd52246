#pragma once

/// @file packed_array.h
/// Numbers as short text for the report page: quantised, zlib-compressed, base64. Each function returns an
/// object that report/src/arrays.js reads: `count`, `width` (bytes per number), `data` (base64 of the
/// compressed bytes: all lowest bytes first, then all second ones, ..., since similar neighbouring bytes
/// compress better), and the parameters that convert the stored integer q into the number.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/io/file/json_forward.h"

namespace tribound::app
{

/// Base64 of RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// value = offset + step q, with q of `bits` bits (at most 31): the error is at most (max - min) / 2^(bits +
/// 1). `stride`, here and below: each q is stored as its difference from the one so many positions before.
[[nodiscard]] io::Json pack_linear(std::span<const double> values, int bits, std::size_t stride = 1);

/// The same with values at rounding level relative to `scale` replaced by 0.
[[nodiscard]] io::Json pack_values(std::vector<double> values, double scale, int bits);

/// The largest absolute value, 0 if there are no values.
[[nodiscard]] double largest(std::span<const double> values);

/// value = 10^(offset + step (q - 1)), and 0 for q = 0, for values >= 0 that span decades: those more than
/// `decades` below the largest become 0.
[[nodiscard]] io::Json pack_logarithmic(std::span<const double> values, int bits, double decades);

/// Integers from 0 to 2^31 - 1: vertex numbers of neighbouring cells are close to each other.
[[nodiscard]] io::Json pack_integers(std::span<const Index> values, std::size_t stride = 1);

/// Text, compressed: its bytes in UTF-8.
[[nodiscard]] io::Json pack_text(std::string_view text);

}  // namespace tribound::app
