#include "tribound/mesh/import/vtk_array.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "tribound/mesh/import/file_text.h"

namespace tribound::mesh
{

namespace
{

[[noreturn]] void fail(const VtkArray& array, const Where& where, const std::string& problem)
{
  throw InputError(where, fmt::format("array \"{}\" {}", array.name, problem),
                   "the file is damaged or cut off: write it again");
}

constexpr std::string_view blanks = " \t\r\n\v\f";

/// -1: not of base64; -2: a blank; -3: '='.
constexpr std::array<signed char, 256> base64_values = []
{
  std::array<signed char, 256> values{};
  values.fill(-1);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < digits.size(); ++i)
    values[static_cast<unsigned char>(digits[i])] = static_cast<signed char>(i);
  for (const char c : blanks) values[static_cast<unsigned char>(c)] = -2;
  values['='] = -3;
  return values;
}();

/// The bytes of an array, one after another.
class VtkBytes
{
 public:
  VtkBytes(const VtkArray& array, const Where& where) : array_(array), where_(where), rest_(array.data) {}

  [[nodiscard]] std::string take(std::size_t n)
  {
    if (n > rest_.size() + decoded_.size()) fail(array_, where_, "ends too early");
    if (array_.coding.format == VtkCoding::Format::raw)
    {
      std::string bytes(rest_.substr(0, n));
      rest_.remove_prefix(n);
      return bytes;
    }
    decoded_.reserve(n + 2);
    while (decoded_.size() < n) decode_four();
    std::string more = decoded_.substr(n);
    decoded_.resize(n);
    std::swap(more, decoded_);
    return more;
  }

  [[nodiscard]] std::uint64_t take_count()
  {
    std::string bytes = take(array_.coding.header_size);
    if (array_.coding.is_swapped) std::ranges::reverse(bytes);
    std::uint64_t count = 0;
    std::memcpy(&count, bytes.data(), bytes.size());  // little-endian
    return count;
  }

 private:
  /// Writers end a header and a block with '=' each: what follows is another text of base64.
  void decode_four()
  {
    std::array<int, 4> digits{};
    int n = 0;
    for (std::size_t i = 0; i < rest_.size() && n < 4; ++i)
    {
      const int value = base64_values[static_cast<unsigned char>(rest_[i])];
      if (value == -1) break;
      if (value != -2) digits[n++] = value;
      if (n == 4) rest_.remove_prefix(i + 1);
    }
    if (n < 4 || digits[0] < 0 || digits[1] < 0 || (digits[2] < 0 && digits[3] >= 0))
      fail(array_, where_, "is not base64, or ends too early");
    decoded_ += static_cast<char>(digits[0] << 2 | digits[1] >> 4);
    if (digits[2] >= 0) decoded_ += static_cast<char>((digits[1] & 15) << 4 | digits[2] >> 2);
    if (digits[3] >= 0) decoded_ += static_cast<char>((digits[2] & 3) << 6 | digits[3]);
  }

  const VtkArray& array_;
  const Where& where_;
  std::string_view rest_;
  std::string decoded_{};
};

/// Blocks of one size, but for the last, each compressed: their number, their size, that of the last (0: as
/// the others), their compressed sizes; then the blocks.
std::string inflated(VtkBytes& bytes, std::size_t n_bytes, const VtkArray& array, const Where& where)
{
  const std::uint64_t n_blocks = bytes.take_count();
  const std::uint64_t block_size = bytes.take_count();
  const std::uint64_t last = bytes.take_count();
  const std::uint64_t last_size = last == 0 ? block_size : last;
  if (n_blocks > array.data.size()) fail(array, where, "ends too early");
  const bool fits = n_blocks == 0 ? n_bytes == 0
                                  : last_size <= n_bytes && block_size > 0 &&
                                        n_blocks - 1 == (n_bytes - last_size) / block_size &&
                                        (n_bytes - last_size) % block_size == 0;
  if (!fits) fail(array, where, fmt::format("does not have {} bytes", n_bytes));
  std::vector<std::uint64_t> sizes(n_blocks);
  for (std::uint64_t& size : sizes) size = bytes.take_count();
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  std::string result(n_bytes, '\0');
  for (std::size_t b = 0; b < sizes.size(); ++b)
  {
    const std::string block = bytes.take(sizes[b]);
    const std::size_t size = b + 1 < sizes.size() ? block_size : last_size;
    if (libdeflate_zlib_decompress(decompressor.get(), block.data(), block.size(),
                                   result.data() + b * block_size, size, nullptr) != LIBDEFLATE_SUCCESS)
      fail(array, where,
           fmt::format("has a compressed block that cannot be read, the {}. of {}", b + 1, sizes.size()));
  }
  return result;
}

std::string bytes_of(const VtkArray& array, std::size_t n_bytes, const Where& where)
{
  VtkBytes bytes(array, where);
  if (array.coding.is_compressed) return inflated(bytes, n_bytes, array, where);
  if (array.coding.header_size > 0)
    if (const std::uint64_t count = bytes.take_count(); count != n_bytes)
      fail(array, where, fmt::format("has {} bytes, not {}", count, n_bytes));
  return bytes.take(n_bytes);
}

/// A number as T; false if it is none.
template <class T, class Stored>
bool convert(Stored stored, T& value)
{
  value = static_cast<T>(0);
  if constexpr (std::is_same_v<T, std::int64_t> && std::is_floating_point_v<Stored>)
  {
    constexpr Stored most = 1e15;
    if (!(std::abs(stored) < most) || stored != std::floor(stored)) return false;
  }
  value = static_cast<T>(stored);
  if constexpr (std::is_same_v<T, std::int64_t>) return std::is_signed_v<Stored> || value >= 0;
  return true;
}

template <class Stored, class T>
std::vector<T> converted(const VtkArray& array, std::string_view bytes, const Where& where)
{
  std::vector<T> values(bytes.size() / sizeof(Stored));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    std::array<char, sizeof(Stored)> one{};
    std::memcpy(one.data(), bytes.data() + i * sizeof(Stored), sizeof(Stored));
    if (array.coding.is_swapped) std::ranges::reverse(one);
    Stored stored;
    std::memcpy(&stored, one.data(), sizeof(Stored));
    if (!convert(stored, values[i]))
      fail(array, where, fmt::format("has the number {} where an integer is needed", stored));
  }
  return values;
}

template <class T>
std::vector<T> from_text(const VtkArray& array, std::size_t n, const Where& where)
{
  std::vector<T> values;
  values.reserve(n);
  std::string_view rest = array.data;
  const auto next_field = [&]
  {
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    const std::string_view field = rest.substr(0, rest.find_first_of(blanks));
    rest.remove_prefix(field.size());
    return field;
  };
  while (values.size() < n)
  {
    const std::string_view field = next_field();
    if (field.empty()) fail(array, where, fmt::format("has {} of its {} numbers", values.size(), n));
    T value = 0;
    bool is_good = false;
    if (const auto integer = is_integer(array.type) ? integer_of(field) : std::nullopt)
      is_good = convert(*integer, value);
    else if (const auto number = is_integer(array.type) ? std::nullopt : number_of(field))
      is_good = convert(*number, value);
    if (!is_good)
      fail(array, where,
           fmt::format("has \"{}\" where {} is needed", field.substr(0, 40),
                       std::is_same_v<T, double> ? "a number" : "an integer"));
    values.push_back(value);
  }
  if (!next_field().empty()) fail(array, where, fmt::format("has more than {} numbers", n));
  return values;
}

}  // namespace

std::size_t size_of(VtkType type)
{
  constexpr std::array<std::size_t, 11> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8, 0};
  return sizes[static_cast<std::size_t>(type)];
}

const VtkArray* find(std::span<const VtkArray> arrays, std::string_view name)
{
  const auto found = std::ranges::find(arrays, name, &VtkArray::name);
  return found == arrays.end() ? nullptr : &*found;
}

template <class T>
std::vector<T> values_of(const VtkArray& array, std::size_t n, const Where& where)
{
  constexpr std::size_t most_per_byte = 1032;  // of zlib's format
  const std::size_t size = size_of(array.type);
  if (size == 0) fail(array, where, "has no numbers");
  const bool is_text = array.coding.format == VtkCoding::Format::text;
  if (n > (is_text ? array.data.size() : most_per_byte * array.data.size() / size))
    fail(array, where, fmt::format("has fewer than {} numbers", n));
  if (is_text) return from_text<T>(array, n, where);
  const std::string bytes = bytes_of(array, n * size, where);
  switch (array.type)
  {
    case VtkType::int8:
      return converted<std::int8_t, T>(array, bytes, where);
    case VtkType::uint8:
      return converted<std::uint8_t, T>(array, bytes, where);
    case VtkType::int16:
      return converted<std::int16_t, T>(array, bytes, where);
    case VtkType::uint16:
      return converted<std::uint16_t, T>(array, bytes, where);
    case VtkType::int32:
      return converted<std::int32_t, T>(array, bytes, where);
    case VtkType::uint32:
      return converted<std::uint32_t, T>(array, bytes, where);
    case VtkType::int64:
      return converted<std::int64_t, T>(array, bytes, where);
    case VtkType::uint64:
      return converted<std::uint64_t, T>(array, bytes, where);
    case VtkType::float32:
      return converted<float, T>(array, bytes, where);
    default:
      return converted<double, T>(array, bytes, where);
  }
}

template std::vector<double> values_of(const VtkArray&, std::size_t, const Where&);
template std::vector<std::int64_t> values_of(const VtkArray&, std::size_t, const Where&);

}  // namespace tribound::mesh
