#include "tribound/io/file/deflate.h"

#include <libdeflate.h>

#include <cassert>
#include <new>

namespace tribound::io
{

Deflate::Deflate(int level) : compressor_(libdeflate_alloc_compressor(level))
{
  if (!compressor_) throw std::bad_alloc();
}

std::size_t Deflate::bound(std::size_t n) const
{
  return libdeflate_zlib_compress_bound(compressor_.get(), n);
}

std::span<const std::byte> Deflate::operator()(std::span<const std::byte> bytes,
                                               std::span<std::byte> result) const
{
  assert(result.size() >= bound(bytes.size()));
  return result.first(
      libdeflate_zlib_compress(compressor_.get(), bytes.data(), bytes.size(), result.data(), result.size()));
}

void Deflate::Free::operator()(libdeflate_compressor* compressor) const
{
  libdeflate_free_compressor(compressor);
}

}  // namespace tribound::io
