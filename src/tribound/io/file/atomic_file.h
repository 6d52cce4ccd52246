#pragma once

/// @file atomic_file.h
/// Output files that exist completely or not at all.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tribound::io
{

/// A result file that cannot be written: full disk, no permission. Exit code 2: the computed results so far
/// are valid.
class WriteError : public std::runtime_error
{
 public:
  WriteError(const std::filesystem::path& path, std::string problem, std::string hint);

  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  std::string problem_;
  std::string hint_;
};

/// Advice on an error number of the system.
[[nodiscard]] std::string hint_for_writing(int error);

/// The name of a file in progress: unique among the processes that may write to the directory.
[[nodiscard]] std::filesystem::path temporary_name(const std::filesystem::path& path, int process);

/// A file written under a temporary name next to its final one and renamed by commit(). Without commit() the
/// temporary file is removed, and an older file with the final name stays as it was.
/// Every function throws WriteError naming the file and the system's reason (disk full, no permission).
class AtomicFile
{
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }

  /// Number of bytes written so far: the position of the next write().
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Replaces bytes already written, from `position` on; the next write() still goes to the end.
  void overwrite(std::uint64_t position, std::span<const std::byte> bytes);

  /// Flushes, closes and renames; nothing may be written afterwards.
  void commit();
  /// Passes everything written so far to the system, which may find the disk full. Throws WriteError.
  void flush();

 private:
  [[noreturn]] void fail(int error) const;

  struct Close
  {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t position_ = 0;
};

/// Writes `text` to the file at `path`, completely or not at all. Throws WriteError.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Removes unfinished files of killed programs from the directory.
void remove_unfinished(const std::filesystem::path& directory);

/// The text of a file; empty where it cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

}  // namespace tribound::io
