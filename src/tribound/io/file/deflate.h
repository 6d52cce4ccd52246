#pragma once

/// @file deflate.h
/// Compression in zlib's format, RFC 1950, by libdeflate.

#include <cstddef>
#include <memory>
#include <span>

struct libdeflate_compressor;

namespace tribound::io
{

/// Not thread-safe.
class Deflate
{
 public:
  static constexpr int stored = 0;
  static constexpr int fastest = 1;

  /// The level is libdeflate's, from stored = 0 to 12.
  explicit Deflate(int level);

  /// The maximal number of bytes of n bytes after compression.
  [[nodiscard]] std::size_t bound(std::size_t n) const;
  /// Fills `result`, which has room for bound(bytes.size()), and returns the used part.
  std::span<const std::byte> operator()(std::span<const std::byte> bytes, std::span<std::byte> result) const;

 private:
  struct Free
  {
    void operator()(libdeflate_compressor* compressor) const;
  };
  std::unique_ptr<libdeflate_compressor, Free> compressor_;
};

}  // namespace tribound::io
