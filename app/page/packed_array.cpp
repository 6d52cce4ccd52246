#include "app/page/packed_array.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tribound/io/file/deflate.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

namespace
{

/// Compressed, in base64.
std::string deflated(std::span<const unsigned char> bytes)
{
  thread_local const io::Deflate deflate(io::Deflate::fastest);  // there are many small arrays
  thread_local std::vector<std::byte> compressed;
  compressed.resize(std::max(compressed.size(), deflate.bound(bytes.size())));
  return base64(deflate(std::as_bytes(bytes), compressed));
}

/// The bytes of the numbers by significance, compressed, in base64.
std::string packed_bytes(std::span<const std::uint32_t> numbers, int width)
{
  const std::size_t n = numbers.size();
  std::vector<unsigned char> bytes(n * width);
  for (int byte = 0; byte < width; ++byte)
    for (std::size_t i = 0; i < n; ++i)
      bytes[n * byte + i] = static_cast<unsigned char>(numbers[i] >> (8 * byte));
  return deflated(bytes);
}

/// Each number as its difference from the one `stride` positions before.
io::Json packed(std::span<const std::uint32_t> numbers, std::size_t stride)
{
  std::vector<std::uint32_t> codes(numbers.size());
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    const auto difference = static_cast<std::int32_t>(numbers[i] - (i < stride ? 0 : numbers[i - stride]));
    // 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
    codes[i] = 2 * static_cast<std::uint32_t>(difference) ^ static_cast<std::uint32_t>(difference >> 31);
    used |= codes[i];
  }
  int width = 1;
  while (width < 4 && used >> (8 * width) != 0) ++width;
  return {
      {"count", codes.size()}, {"width", width}, {"stride", stride}, {"data", packed_bytes(codes, width)}};
}

/// x >= 0 rounded, halves up.
std::uint32_t nearest(double x)
{
  return static_cast<std::uint32_t>(std::floor(x + 0.5));
}

/// 2^bits - 1.
double largest_code(int bits)
{
  return std::ldexp(1.0, bits) - 1.0;
}

}  // namespace

std::string base64(std::span<const std::byte> bytes)
{
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  const auto encode = [&](std::size_t i, std::uint32_t group, std::size_t n)
  {
    for (std::size_t j = 0; j <= n; ++j) text[i / 3 * 4 + j] = digits[group >> (18 - 6 * j) & 63U];
  };
  const auto at = [&](std::size_t i, int shift) { return std::to_integer<std::uint32_t>(bytes[i]) << shift; };
  const std::size_t rest = bytes.size() % 3;
  const std::size_t whole = bytes.size() - rest;
  for (std::size_t i = 0; i < whole; i += 3) encode(i, at(i, 16) | at(i + 1, 8) | at(i + 2, 0), 3);
  if (rest > 0) encode(whole, at(whole, 16) | (rest > 1 ? at(whole + 1, 8) : 0U), rest);
  return text;
}

io::Json pack_linear(std::span<const double> values, int bits, std::size_t stride)
{
  assert(bits >= 1 && bits <= 31);
  const auto range =
      values.empty() ? std::ranges::minmax_result<double>{0.0, 0.0} : std::ranges::minmax(values);
  const double low = range.min;
  const double step = (range.max - low) / largest_code(bits);
  std::vector<std::uint32_t> codes(values.size());
  if (step > 0.0)
    std::ranges::transform(values, codes.begin(), [&](double x) { return nearest((x - low) / step); });
  io::Json result = packed(codes, stride);
  result.update({{"offset", low}, {"step", step}});
  return result;
}

double largest(std::span<const double> values)
{
  double result = 0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

io::Json pack_values(std::vector<double> values, double scale, int bits)
{
  constexpr double round_off = 1e-10;
  for (double& value : values)
    if (std::abs(value) <= round_off * scale) value = 0;
  return pack_linear(values, bits);
}

io::Json pack_logarithmic(std::span<const double> values, int bits, double decades)
{
  const double largest = values.empty() ? 0.0 : std::ranges::max(values);
  const double top = largest > 0.0 ? std::log10(largest) : 0.0;
  std::vector<double> exponents(values.size());
  constexpr double of_zero = -std::numeric_limits<double>::infinity();
  std::ranges::transform(values, exponents.begin(),
                         [](double value) { return value > 0.0 ? std::log10(value) : of_zero; });
  double bottom = top;
  for (const double exponent : exponents)
    if (exponent >= top - decades) bottom = std::min(bottom, exponent);
  const double step = top > bottom ? (top - bottom) / (largest_code(bits) - 1.0) : 1.0;
  std::vector<std::uint32_t> codes(values.size());
  std::ranges::transform(exponents, codes.begin(),
                         [&](double exponent)
                         { return exponent < bottom ? 0U : 1U + nearest((exponent - bottom) / step); });
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
