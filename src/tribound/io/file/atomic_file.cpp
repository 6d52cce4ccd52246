#include "tribound/io/file/atomic_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace tribound::io
{

namespace
{

constexpr std::size_t buffer_size = 1 << 20;

std::string reason(int error)
{
  return std::generic_category().message(error);
}

/// Whether the name is ".NAME.PID.part", a file that AtomicFile has not finished.
bool is_unfinished(std::string_view name)
{
  constexpr std::string_view ending = ".part";
  if (!name.starts_with('.') || !name.ends_with(ending)) return false;
  name.remove_suffix(ending.size());
  const std::string_view number = name.substr(name.rfind('.') + 1);
  return number.size() + 1 < name.size() && !number.empty() &&
         std::ranges::all_of(number, [](char c) { return '0' <= c && c <= '9'; });
}

}  // namespace

std::filesystem::path temporary_name(const std::filesystem::path& path, int process)
{
  std::filesystem::path name = path;
  name.replace_filename("." + path.filename().string() + "." + std::to_string(process) + ".part");
  return name;
}

WriteError::WriteError(const std::filesystem::path& path, std::string problem, std::string hint)
    : std::runtime_error(path.string() + ": " + problem + "\n  hint: " + hint),
      problem_(std::move(problem)),
      hint_(std::move(hint))
{
}

std::string hint_for_writing(int error)
{
  switch (error)
  {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space, or choose another output.directory";
    case ENOENT:
      return "create the directory first, or choose another output.directory";
    default:
      return "choose an output.directory that you may write to";
  }
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(temporary_name(path_, ::getpid())),
      file_(std::fopen(temporary_.c_str(), "wb"))
{
  if (!file_) fail(errno);
  std::setvbuf(file_.get(), nullptr, _IOFBF, buffer_size);
}

AtomicFile::~AtomicFile()
{
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::span<const std::byte> bytes)
{
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail(errno);
  position_ += bytes.size();
}

void AtomicFile::overwrite(std::uint64_t position, std::span<const std::byte> bytes)
{
  if (::fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0) fail(errno);
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail(errno);
  if (::fseeko(file_.get(), 0, SEEK_END) != 0) fail(errno);
}

void AtomicFile::flush()
{
  if (std::fflush(file_.get()) != 0) fail(errno);
}

void AtomicFile::commit()
{
  flush();
  // fclose reports errors of delayed writing, which occur on network file systems.
  const int closed = std::fclose(file_.release());
  const int error = errno;
  std::error_code renamed;
  if (closed == 0) std::filesystem::rename(temporary_, path_, renamed);
  if (closed == 0 && !renamed) return;

  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  fail(closed == 0 ? renamed.value() : error);
}

void AtomicFile::fail(int error) const
{
  throw WriteError(path_, "cannot write this file: " + reason(error), hint_for_writing(error));
}

void write_file(const std::filesystem::path& path, std::string_view text)
{
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void remove_unfinished(const std::filesystem::path& directory)
{
  std::error_code ignored;
  std::vector<std::filesystem::path> unfinished;
  for (const auto& entry : std::filesystem::directory_iterator(directory, ignored))
    if (is_unfinished(entry.path().filename().string())) unfinished.push_back(entry.path());
  for (const std::filesystem::path& file : unfinished) std::filesystem::remove(file, ignored);
}

std::string read_text(const std::filesystem::path& path)
{
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

}  // namespace tribound::io
