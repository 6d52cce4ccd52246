#include "app/page/packed_array.h"
#include "tribound/io/file/json.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <new>
#include <vector>

namespace tribound::app
{

namespace
{

/// A tenth more than at zlib's default in a third of the time (bench/README.md).
constexpr int compression_level = Z_BEST_SPEED;

/// Compressed, in base64.
std::string deflated(std::span<const unsigned char> bytes)
{
  // Most arrays are small: zlib would clear more memory than they have bytes.
  const int window_bits = std::clamp(static_cast<int>(std::bit_width(bytes.size())), 9, MAX_WBITS);
  z_stream stream{};
  if (deflateInit2(&stream, compression_level, Z_DEFLATED, window_bits, window_bits - 7,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::vector<unsigned char> compressed(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<Bytef*>(bytes.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = compressed.data();
  stream.avail_out = static_cast<uInt>(compressed.size());
  [[maybe_unused]] const int end = deflate(&stream, Z_FINISH);
  assert(end == Z_STREAM_END);  // there is room for deflateBound()
  deflateEnd(&stream);
  return base64(std::span(compressed).first(stream.total_out));
}

/// The bytes of the numbers by significance, compressed, in base64.
std::string packed_bytes(std::span<const std::uint32_t> numbers, int width)
{
  std::vector<unsigned char> bytes;
  bytes.reserve(numbers.size() * width);
  for (int byte = 0; byte < width; ++byte)
    for (const std::uint32_t number : numbers)
      bytes.push_back(static_cast<unsigned char>(number >> (8 * byte)));
  return deflated(bytes);
}

/// Each number as its difference from the one `stride` places before.
io::Json packed(std::span<const std::uint32_t> numbers, std::size_t stride)
{
  std::vector<std::uint32_t> codes;
  codes.reserve(numbers.size());
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    const std::int64_t difference = std::int64_t{numbers[i]} - (i < stride ? 0 : numbers[i - stride]);
    // 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
    codes.push_back(static_cast<std::uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference));
    used |= codes.back();
  }
  int width = 1;
  while (width < 4 && used >> (8 * width) != 0) ++width;
  return {
      {"count", codes.size()}, {"width", width}, {"stride", stride}, {"data", packed_bytes(codes, width)}};
}

/// 2^bits - 1.
double largest_code(int bits)
{
  return std::ldexp(1.0, bits) - 1.0;
}

}  // namespace

std::string base64(std::span<const unsigned char> bytes)
{
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3)
  {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = group << 8 | (j < n ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= n ? digits[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

io::Json pack_linear(std::span<const double> values, int bits, std::size_t stride)
{
  assert(bits >= 1 && bits <= 31);
  const auto [low, high] =
      values.empty() ? std::ranges::minmax_result<double>{0.0, 0.0} : std::ranges::minmax(values);
  const double step = (high - low) / largest_code(bits);
  std::vector<std::uint32_t> codes;
  codes.reserve(values.size());
  for (const double value : values)
    codes.push_back(step > 0.0 ? static_cast<std::uint32_t>(std::round((value - low) / step)) : 0U);
  io::Json result = packed(codes, stride);
  result.update({{"offset", low}, {"step", step}});
  return result;
}

io::Json pack_logarithmic(std::span<const double> values, int bits, double decades)
{
  const double largest = values.empty() ? 0.0 : std::ranges::max(values);
  const double top = largest > 0.0 ? std::log10(largest) : 0.0;
  double bottom = top;
  for (const double value : values)
    if (value > 0.0) bottom = std::min(bottom, std::max(std::log10(value), top - decades));
  const double step = top > bottom ? (top - bottom) / (largest_code(bits) - 1.0) : 1.0;
  std::vector<std::uint32_t> codes;
  codes.reserve(values.size());
  for (const double value : values)
  {
    const double place = value > 0.0 ? std::round((std::log10(value) - bottom) / step) : -1.0;
    codes.push_back(place < 0.0 ? 0U : 1U + static_cast<std::uint32_t>(place));
  }
  io::Json result = packed(codes, 1);
  result.update({{"offset", bottom}, {"step", step}, {"log", true}});
  return result;
}

io::Json pack_integers(std::span<const Index> values, std::size_t stride)
{
  return packed(std::vector<std::uint32_t>(values.begin(), values.end()), stride);
}

io::Json pack_text(std::string_view text)
{
  const std::vector<unsigned char> bytes(text.begin(), text.end());
  return {{"text", deflated(bytes)}};
}

}  // namespace tribound::app
