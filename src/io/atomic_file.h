#pragma once

/// @file atomic_file.h
/// Output files that exist completely or not at all.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace tribound
{

/// A file written under a temporary name beside its final one and renamed by commit(). Without commit() the
/// temporary file is removed and an older file of the final name stays as it was.
/// Every function throws InputError naming the file and the system's reason (disk full, no permission).
class AtomicFile
{
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }

  /// Number of bytes written so far, which is where the next write() goes.
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Replaces bytes already written, from `position` on; the next write() still goes to the end.
  void overwrite(std::uint64_t position, std::span<const std::byte> bytes);

  /// Flushes, closes and renames; nothing may be written afterwards.
  void commit();
  /// Hands all that has been written to the system, which may find the disk full. Throws InputError.
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

/// Writes `text` to the file at `path`, completely or not at all. Throws InputError.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Creates the directory with its parents and verifies that files can be written there, so that a long run
/// does not fail at its end. Throws InputError naming the directory and the system's reason.
void prepare_output_directory(const std::filesystem::path& directory);

}  // namespace tribound
