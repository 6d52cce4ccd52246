#include "tribound/io/file/output_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::io
{

namespace
{

constexpr std::string_view lock_name = ".tribound.lock";

Where place(const std::filesystem::path& directory)
{
  return {.file = directory.string(), .key = "output.directory"};
}

/// The directory and those of its parents that do not exist, innermost first.
std::vector<std::filesystem::path> missing_directories(std::filesystem::path directory)
{
  std::vector<std::filesystem::path> missing;
  std::error_code error;
  for (; !directory.empty() && !std::filesystem::exists(directory, error);
       directory = directory.parent_path())
    missing.push_back(directory);
  return missing;
}

void remove_all_of(const std::vector<std::filesystem::path>& directories)
{
  std::error_code ignored;
  for (const std::filesystem::path& directory : directories) std::filesystem::remove(directory, ignored);
}

/// Creates the directory and tries to write a file there, which is then removed. Throws InputError, leaving
/// nothing behind.
void create_and_try(const std::filesystem::path& directory)
{
  std::error_code error;
  if (std::filesystem::exists(directory, error) && !std::filesystem::is_directory(directory, error))
    throw InputError(place(directory), "exists and is not a directory", "choose another output.directory");
  const std::vector<std::filesystem::path> missing = missing_directories(directory);
  std::filesystem::create_directories(directory, error);
  if (error)
  {
    remove_all_of(missing);
    throw InputError(place(directory), "cannot create this directory: " + error.message(),
                     hint_for_writing(error.value()));
  }
  try
  {
    AtomicFile probe(directory / "probe");
    probe.write("probe");
    probe.flush();
  }
  catch (const WriteError& failure)
  {
    remove_all_of(missing);
    throw InputError(place(directory), "cannot write to this directory: " + failure.problem(),
                     failure.hint());
  }
}

std::string host_name()
{
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Whether the open file still has this name.
bool is_current(int file, const std::filesystem::path& path)
{
  struct stat opened
  {
  };
  struct stat named
  {
  };
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

[[noreturn]] void throw_in_use(const std::filesystem::path& directory, const std::filesystem::path& lock_file)
{
  std::string owner;
  std::ifstream file(lock_file);
  std::getline(file, owner);
  throw InputError(place(directory),
                   fmt::format("another run is writing to it{}", owner.empty() ? "" : ": " + owner),
                   "wait for its end, or choose another output.directory");
}

/// A lock file of another user cannot be written to, but it can be locked.
int open_lock(const std::filesystem::path& directory, const std::filesystem::path& lock_file)
{
  int file = ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0 && errno == EACCES) file = ::open(lock_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (file >= 0) return file;
  const int error = errno;
  throw InputError(place(directory), fmt::format("cannot lock this directory: {}", std::strerror(error)),
                   hint_for_writing(error));
}

/// Locks the file and writes the owner into it; -1 where the file system has no locks.
int lock(const std::filesystem::path& directory, const std::filesystem::path& lock_file)
{
  for (;;)
  {
    const int file = open_lock(directory, lock_file);
    if (::flock(file, LOCK_EX | LOCK_NB) != 0)
    {
      const int reason = errno;
      ::close(file);
      if (reason == EWOULDBLOCK) throw_in_use(directory, lock_file);
      return -1;
    }
    if (!is_current(file, lock_file))  // its owner has removed it in the meantime
    {
      ::close(file);
      continue;
    }
    const std::string owner = fmt::format("process {} on {}\n", ::getpid(), host_name());
    // Only for a message: the lock is valid without it.
    (void)!(::ftruncate(file, 0) == 0 && ::write(file, owner.data(), owner.size()) > 0);
    return file;
  }
}

}  // namespace

OutputDirectory::OutputDirectory(const std::filesystem::path& path) : lock_file_(path / lock_name)
{
  create_and_try(path);
  lock_ = lock(path, lock_file_);
  if (lock_ < 0) return;
  for (const std::filesystem::path& folder : {path, path / unfinished_pass, path / unfinished_steps})
    remove_unfinished(folder);
}

OutputDirectory::~OutputDirectory()
{
  if (lock_ < 0) return;
  std::error_code ignored;
  std::filesystem::remove(lock_file_, ignored);
  ::close(lock_);
}

void try_output_directory(const std::filesystem::path& path)
{
  const std::vector<std::filesystem::path> missing = missing_directories(path);
  create_and_try(path);
  remove_all_of(missing);
}

void remove_results(const std::filesystem::path& directory, std::initializer_list<std::string_view> names)
{
  for (const std::string_view name : names)
  {
    const std::filesystem::path file = directory / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) continue;
    std::filesystem::remove(file, error);
    if (error)
      throw InputError({.file = file.string()},
                       "cannot remove this file of an earlier run: " + error.message(),
                       "choose another output.directory, or remove the file");
  }
}

}  // namespace tribound::io
