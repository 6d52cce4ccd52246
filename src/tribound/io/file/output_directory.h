#pragma once

/// @file output_directory.h
/// The directory of results: one program at a time writes to it, and what it holds is of one run.

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace tribound::io
{

/// In the directory of results: the files of a pass over load steps in work, after the first; and of load
/// steps that the certificate does not have yet.
inline constexpr const char* unfinished_pass = "unfinished_pass";
inline constexpr const char* unfinished_steps = "unfinished_steps";

/// A directory that belongs to this process until destroyed.
class OutputDirectory
{
 public:
  /// Creates it with its parents, verifies that files can be written there, so that a long run does not fail
  /// at its end, locks it and removes the temporary files of programs that were killed. Throws InputError
  /// naming the directory and the system's reason, or the process that is writing there.
  explicit OutputDirectory(const std::filesystem::path& path);
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

 private:
  std::filesystem::path lock_file_;
  int lock_ = -1;  ///< -1 where the file system has no locks
};

/// Throws the InputError that OutputDirectory would for a directory that cannot be written to; leaves
/// everything as it was.
void try_output_directory(const std::filesystem::path& path);

/// Removes the named files of an earlier run, in this order; those that do not exist are no error. Throws
/// InputError when one cannot be removed.
void remove_results(const std::filesystem::path& directory, std::initializer_list<std::string_view> names);

}  // namespace tribound::io
