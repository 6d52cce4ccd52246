#include "tribound/mesh/import/hdf5_group.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "tribound/base/error.h"

namespace tribound::mesh
{

namespace
{

/// An identifier that is released with its last copy; empty if it is none.
std::shared_ptr<std::int64_t> make_handle(hid_t id, herr_t (*close)(hid_t))
{
  if (id < 0) return {};
  return {new std::int64_t(id), [close](const std::int64_t* p)
          {
            close(*p);
            delete p;
          }};
}

/// The numbers of an array, if its file can hold so many: a damaged one may promise any number.
std::optional<std::size_t> size_of_set(hid_t set, std::size_t bytes_per_number)
{
  constexpr std::size_t most_per_byte = 1032;  // of compressed arrays
  const auto space = make_handle(H5Dget_space(set), H5Sclose);
  if (!space) return {};
  const hssize_t n = H5Sget_simple_extent_npoints(*space);
  if (n < 0 || static_cast<hsize_t>(n) > most_per_byte * H5Dget_storage_size(set) / bytes_per_number)
    return {};
  return static_cast<std::size_t>(n);
}

herr_t append_name(hid_t, const char* name, const H5L_info_t*, void* names)
{
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

Hdf5Group::Hdf5Group(const std::filesystem::path& file) : file_(file.string())
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are reported by exceptions
  id_ = make_handle(H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!id_) throw InputError({.file = file_}, "is no HDF5 file, or cut off", "save the mesh again");
}

void Hdf5Group::fail(const std::string& name) const
{
  throw InputError({.file = file_}, fmt::format("{}/{} is missing, or cannot be read", path_, name),
                   "the file is damaged, or not of the format: save the mesh again");
}

bool Hdf5Group::has(const std::string& name) const
{
  return H5Lexists(*id_, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Group::names() const
{
  std::vector<std::string> names;
  if (H5Literate(*id_, H5_INDEX_NAME, H5_ITER_INC, nullptr, append_name, &names) < 0) fail("...");
  return names;
}

Hdf5Group Hdf5Group::group(const std::string& name) const
{
  Handle id = has(name) ? make_handle(H5Gopen2(*id_, name.c_str(), H5P_DEFAULT), H5Gclose) : Handle{};
  if (!id) fail(name);
  return {file_, path_ + "/" + name, std::move(id)};
}

template <class T>
std::optional<T> Hdf5Group::read_attribute(const std::string& name) const
{
  constexpr bool is_real = std::is_same_v<T, double>;
  if (H5Aexists(*id_, name.c_str()) <= 0) return {};
  const auto attribute = make_handle(H5Aopen(*id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  const auto space = attribute ? make_handle(H5Aget_space(*attribute), H5Sclose) : Handle{};
  const auto type = attribute ? make_handle(H5Aget_type(*attribute), H5Tclose) : Handle{};
  T value = 0;
  if (!space || !type || H5Sget_simple_extent_npoints(*space) != 1 ||
      H5Tget_class(*type) != (is_real ? H5T_FLOAT : H5T_INTEGER) ||
      H5Aread(*attribute, is_real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, &value) < 0)
    fail(name);
  return value;
}

std::optional<std::int64_t> Hdf5Group::attribute(const std::string& name) const
{
  return read_attribute<std::int64_t>(name);
}

std::optional<double> Hdf5Group::real(const std::string& name) const
{
  return read_attribute<double>(name);
}

std::optional<std::string> Hdf5Group::text(const std::string& name) const
{
  if (H5Aexists(*id_, name.c_str()) <= 0) return {};
  const auto attribute = make_handle(H5Aopen(*id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  const auto space = attribute ? make_handle(H5Aget_space(*attribute), H5Sclose) : Handle{};
  const auto type = attribute ? make_handle(H5Aget_type(*attribute), H5Tclose) : Handle{};
  if (!space || !type || H5Sget_simple_extent_npoints(*space) != 1 || H5Tget_class(*type) != H5T_STRING ||
      H5Tis_variable_str(*type) != 0)
    fail(name);
  std::string value(H5Tget_size(*type), '\0');
  if (H5Aread(*attribute, *type, value.data()) < 0) fail(name);
  value.resize(std::min(value.find('\0'), value.size()));
  return value;
}

template <class T>
std::vector<T> Hdf5Group::read(const std::string& name) const
{
  constexpr bool is_real = std::is_same_v<T, double>;
  const auto set = has(name) ? make_handle(H5Dopen2(*id_, name.c_str(), H5P_DEFAULT), H5Dclose) : Handle{};
  const auto type = set ? make_handle(H5Dget_type(*set), H5Tclose) : Handle{};
  const std::size_t bytes = type ? H5Tget_size(*type) : 0;
  if (bytes == 0 || H5Tget_class(*type) != (is_real ? H5T_FLOAT : H5T_INTEGER)) fail(name);
  const auto n = size_of_set(*set, bytes);
  if (!n) fail(name);
  std::vector<T> values(*n);
  if (!values.empty() && H5Dread(*set, is_real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, H5S_ALL, H5S_ALL,
                                 H5P_DEFAULT, values.data()) < 0)
    fail(name);
  return values;
}

std::vector<double> Hdf5Group::numbers(const std::string& name) const
{
  return read<double>(name);
}

std::vector<std::int64_t> Hdf5Group::integers(const std::string& name) const
{
  return read<std::int64_t>(name);
}

std::string Hdf5Group::bytes(const std::string& name) const
{
  const auto set = has(name) ? make_handle(H5Dopen2(*id_, name.c_str(), H5P_DEFAULT), H5Dclose) : Handle{};
  const auto type = set ? make_handle(H5Dget_type(*set), H5Tclose) : Handle{};
  const std::size_t size = type ? H5Tget_size(*type) : 0;
  if (size == 0 || H5Tdetect_class(*type, H5T_VLEN) > 0 || H5Tis_variable_str(*type) > 0 ||
      H5Tdetect_class(*type, H5T_REFERENCE) > 0)
    fail(name);
  const auto n = size_of_set(*set, size);
  if (!n) fail(name);
  std::string bytes(*n * size, '\0');
  if (!bytes.empty() && H5Dread(*set, *type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) fail(name);
  return bytes;
}

}  // namespace tribound::mesh
