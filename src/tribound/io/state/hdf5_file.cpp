#include "tribound/io/state/hdf5_file.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <exception>
#include <system_error>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::io
{

namespace
{

/// An HDF5 identifier, released at the end.
class Handle
{
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle()
  {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

using Shape = std::array<hsize_t, 2>;

Handle make_space(const Shape& shape)
{
  return {H5Screate_simple(2, shape.data(), nullptr), H5Sclose};
}

/// Rows first, first + 1, ... of an array.
bool select(const Handle& space, hsize_t first, const Shape& rows)
{
  if (rows[0] == 0) return H5Sselect_none(space.get()) >= 0;
  const Shape begin{first, 0};
  return H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, begin.data(), nullptr, rows.data(), nullptr) >= 0;
}

/// Collective on several ranks.
Handle transfer_properties(const Ranks& ranks)
{
  Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  if (ranks.size() > 1) H5Pset_dxpl_mpio(properties.get(), H5FD_MPIO_COLLECTIVE);
  return {properties.good() ? H5Pcopy(properties.get()) : -1, H5Pclose};
}

}  // namespace

Hdf5File::Hdf5File(std::filesystem::path path, Mode mode, const Ranks& ranks)
    : path_(std::move(path)), actual_(path_), mode_(mode), ranks_(ranks)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are reported by exceptions
  if (mode == Mode::write) actual_ = temporary_name(path_, ranks.on_first([] { return ::getpid(); }));
  is_temporary_ = mode == Mode::write;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (const auto* communicator = static_cast<const MPI_Comm*>(ranks.mpi_communicator()))
    H5Pset_fapl_mpio(access.get(), *communicator, MPI_INFO_NULL);
  file_ = mode == Mode::write ? H5Fcreate(actual_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get())
                              : H5Fopen(actual_.c_str(), H5F_ACC_RDONLY, access.get());
  require(file_ >= 0, "opened");
}

Hdf5File::~Hdf5File()
{
  // With MPI, closing waits for the other ranks, which may not be leaving by an exception.
  if (file_ >= 0 && (ranks_.size() == 1 || std::uncaught_exceptions() == 0)) H5Fclose(file_);
  std::error_code none;
  if (is_temporary_ && ranks_.is_first()) std::filesystem::remove(actual_, none);
}

void Hdf5File::require(bool good, const std::string& doing) const
{
  if (!ranks_.any(!good)) return;
  if (mode_ == Mode::write)
    throw WriteError(path_, "HDF5 says that it cannot be " + doing,
                     "is the disk full, or without permission?");
  throw InputError({.file = path_.string()}, "is no checkpoint, or a damaged one: it cannot be " + doing,
                   "a file that a run with output.checkpoint = true has written");
}

void Hdf5File::write_bytes(const std::string& name, Type type, const void* values, std::uint64_t n_rows,
                           int width)
{
  const std::array<hid_t, 5> types = {H5T_NATIVE_INT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                                      H5T_NATIVE_DOUBLE, H5T_NATIVE_CHAR};
  const auto n = static_cast<std::int64_t>(n_rows);
  const Shape own{n_rows, static_cast<hsize_t>(width)};
  const Shape all{static_cast<hsize_t>(ranks_.sum(n)), own[1]};
  const auto first = static_cast<hsize_t>(ranks_.before(n));
  const Handle space = make_space(all);
  const Handle memory = make_space(own);
  const Handle how = transfer_properties(ranks_);
  const Handle set(H5Dcreate2(file_, name.c_str(), types[static_cast<int>(type)], space.get(), H5P_DEFAULT,
                              H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  const auto write = [&]
  {
    if (all[0] == 0) return true;  // has no space in the file, and ranks cannot write it together
    return select(space, first, own) && select(memory, 0, own) &&
           H5Dwrite(set.get(), types[static_cast<int>(type)], memory.get(), space.get(), how.get(), values) >=
               0;
  };
  require(set.good() && write(), "written");
}

std::uint64_t Hdf5File::n_own_rows(const std::string& name, int width)
{
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(set.good() ? H5Dget_space(set.get()) : -1, H5Sclose);
  Shape all{};
  hsize_t n_bytes = 0;  // of the file: a corrupt number of rows must not cause a huge allocation
  const bool good = H5Fget_filesize(file_, &n_bytes) >= 0 && space.good() &&
                    H5Sget_simple_extent_ndims(space.get()) == 2 &&
                    H5Sget_simple_extent_dims(space.get(), all.data(), nullptr) == 2 &&
                    all[1] == static_cast<hsize_t>(width) && all[0] <= n_bytes / all[1];
  require(good, "read");
  const auto begin = [&](int rank) { return all[0] * rank / ranks_.size(); };
  return begin(ranks_.rank() + 1) - begin(ranks_.rank());
}

void Hdf5File::read_bytes(const std::string& name, Type type, void* values, std::uint64_t n_rows, int width)
{
  const std::array<hid_t, 5> types = {H5T_NATIVE_INT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                                      H5T_NATIVE_DOUBLE, H5T_NATIVE_CHAR};
  const Shape own{n_rows, static_cast<hsize_t>(width)};
  const auto n = static_cast<std::int64_t>(n_rows);
  if (ranks_.sum(n) == 0) return;  // has no space in the file, and ranks cannot read it together
  const auto first = static_cast<hsize_t>(ranks_.before(n));
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(set.good() ? H5Dget_space(set.get()) : -1, H5Sclose);
  const Handle memory = make_space(own);
  const Handle how = transfer_properties(ranks_);
  const bool good =
      space.good() && select(space, first, own) && select(memory, 0, own) &&
      H5Dread(set.get(), types[static_cast<int>(type)], memory.get(), space.get(), how.get(), values) >= 0;
  require(good, "read");
}

void Hdf5File::write_text(const std::string& name, const std::string& text)
{
  const std::span<const char> own = ranks_.is_first() ? std::span<const char>(text) : std::span<const char>();
  write<char>(name, own, 1);
}

std::string Hdf5File::read_text(const std::string& name)
{
  const std::vector<char> own = read<char>(name, 1);
  std::vector<char> all = ranks_.gather<char>(own);
  ranks_.copy_from_first(all);
  return {all.begin(), all.end()};
}

void Hdf5File::commit()
{
  require(H5Fclose(std::exchange(file_, -1)) >= 0, "closed");
  ranks_.on_first(
      [&]
      {
        const int file = ::open(actual_.c_str(), O_RDONLY | O_CLOEXEC);
        const bool is_on_disk = file >= 0 && ::fsync(file) == 0;
        if (file >= 0) ::close(file);
        std::error_code error;
        if (is_on_disk) std::filesystem::rename(actual_, path_, error);
        if (!is_on_disk || error)
          throw WriteError(path_, "cannot be brought to the disk", "is it full, or without permission?");
      });
  is_temporary_ = false;
}

}  // namespace tribound::io
