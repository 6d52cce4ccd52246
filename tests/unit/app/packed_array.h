#pragma once

/// @file packed_array.h
/// Reads what app/page/packed_array.h writes, as the page does.

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tribound::test
{

inline std::vector<unsigned char> from_base64(const std::string& text)
{
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int n_bits = 0;
  for (const char c : text.substr(0, text.find('=')))
  {
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    n_bits += 6;
    if (n_bits < 8) continue;
    n_bits -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> n_bits & 255U));
  }
  return bytes;
}

/// The numbers of a packed array.
inline std::vector<double> unpack(const nlohmann::json& packed)
{
  const std::size_t count = packed["count"];
  const std::size_t width = packed["width"];
  const std::vector<unsigned char> compressed = from_base64(packed["data"].get<std::string>());
  std::vector<unsigned char> bytes(count * width + 1);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, compressed.data(), compressed.size()), Z_OK);
  EXPECT_EQ(size, count * width);
  const std::size_t stride = packed["stride"];
  std::vector<double> codes;
  for (std::size_t i = 0; i < count; ++i)
  {
    double code = 0;
    for (std::size_t byte = 0; byte < width; ++byte)
      code += std::ldexp(bytes[byte * count + i], static_cast<int>(8 * byte));
    const double difference = std::fmod(code, 2) == 0 ? code / 2 : -(code + 1) / 2;
    codes.push_back(difference + (i < stride ? 0 : codes[i - stride]));
  }
  if (!packed.contains("step")) return codes;
  const double offset = packed["offset"];
  const double step = packed["step"];
  const bool logarithmic = packed.value("log", false);
  std::vector<double> values;
  for (const double code : codes)
    if (logarithmic)
      values.push_back(code == 0 ? 0 : std::pow(10, offset + step * (code - 1)));
    else
      values.push_back(offset + step * code);
  return values;
}

/// The text of pack_text().
inline std::string unpack_text(const nlohmann::json& packed)
{
  const std::vector<unsigned char> compressed = from_base64(packed["text"].get<std::string>());
  std::vector<unsigned char> bytes(1 << 20);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, compressed.data(), compressed.size()), Z_OK);
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace tribound::test
