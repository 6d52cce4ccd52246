#pragma once

/// @file mesh_bytes.h
/// Values as a string of bytes, to be passed between processes of the same program.

#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tribound::mesh
{

/// Appends values to a string of bytes.
class ByteWriter
{
 public:
  void put(std::size_t number) { append(&number, sizeof(number)); }
  void put(std::string_view text)
  {
    put(text.size());
    append(text.data(), text.size());
  }
  void put(const std::vector<std::string>& texts)
  {
    put(texts.size());
    for (const std::string& text : texts) put(std::string_view(text));
  }
  /// Plain data: numbers, and arrays of them.
  template <class T>
  void put(const std::vector<T>& values)
  {
    put(values.size());
    append(values.data(), values.size() * sizeof(T));
  }

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }

  std::string bytes_;
};

/// Extracts the values again, in the same order.
class ByteReader
{
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  void get(std::size_t& number) { extract(&number, sizeof(number)); }
  void get(std::string& text)
  {
    text.resize(size());
    extract(text.data(), text.size());
  }
  void get(std::vector<std::string>& texts)
  {
    texts.resize(size());
    for (std::string& text : texts) get(text);
  }
  template <class T>
  void get(std::vector<T>& values)
  {
    values.resize(size());
    extract(static_cast<void*>(values.data()), values.size() * sizeof(T));
  }

 private:
  std::size_t size()
  {
    std::size_t n = 0;
    get(n);
    return n;
  }
  void extract(void* to, std::size_t n)
  {
    if (n > 0) std::memcpy(to, bytes_.data(), n);
    bytes_.remove_prefix(n);
  }

  std::string_view bytes_;
};

}  // namespace tribound::mesh
