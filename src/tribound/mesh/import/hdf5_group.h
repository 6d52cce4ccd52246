#pragma once

/// @file hdf5_group.h
/// Groups and arrays of an HDF5 file, for reading.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tribound::mesh
{

/// All members throw InputError with the file and what they look for.
class Hdf5Group
{
 public:
  explicit Hdf5Group(const std::filesystem::path& file);

  [[nodiscard]] bool has(const std::string& name) const;
  /// What the group has, in the order of the names.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] Hdf5Group group(const std::string& name) const;
  /// An attribute that is an integer; nothing if there is none with the name.
  [[nodiscard]] std::optional<std::int64_t> attribute(const std::string& name) const;
  /// The same of a number with a fraction.
  [[nodiscard]] std::optional<double> real(const std::string& name) const;

  /// An attribute that is a text of fixed length; nothing if there is none with the name.
  [[nodiscard]] std::optional<std::string> text(const std::string& name) const;

  /// All numbers of an array.
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& name) const;
  /// The bytes of an array of characters, or of arrays of them.
  [[nodiscard]] std::string bytes(const std::string& name) const;

 private:
  using Id = std::int64_t;  ///< HDF5's hid_t
  using Handle = std::shared_ptr<Id>;

  Hdf5Group(std::string file, std::string path, Handle id)
      : file_(std::move(file)), path_(std::move(path)), id_(std::move(id))
  {
  }
  [[noreturn]] void fail(const std::string& name) const;
  template <class T>
  [[nodiscard]] std::optional<T> read_attribute(const std::string& name) const;
  template <class T>
  [[nodiscard]] std::vector<T> read(const std::string& name) const;

  std::string file_;
  std::string path_;
  Handle id_;
};

}  // namespace tribound::mesh
