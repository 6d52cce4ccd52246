#pragma once

/// @file output_directory.h
/// The output directory: one program at a time writes to it, and its contents belong to one run.

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace tribound::io
{

/// Subdirectory of the output directory: for the files of the current pass over load steps, after the first
/// pass, and of load steps that are not yet in the certificate.
inline constexpr const char* unfinished_pass = "unfinished_pass";
inline constexpr const char* unfinished_steps = "unfinished_steps";

/// A directory that belongs to this process until destroyed.
class OutputDirectory
{
 public:
  /// Creates the directory with its parents, and verifies that files can be written there, so that a long run
  /// does not fail at its end. Locks it and removes the temporary files of killed programs. Throws InputError
  /// naming the directory and the system's reason, or the process that is writing there.
  explicit OutputDirectory(const std::filesystem::path& path);
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

 private:
  std::filesystem::path lock_file_;
  int lock_ = -1;  ///< -1 where the file system has no locks
};

/// Throws the same InputError as OutputDirectory for a directory that cannot be written to. Leaves everything
/// as it was.
void try_output_directory(const std::filesystem::path& path);

/// Removes the named files of an earlier run, in this order; missing ones are no error. Throws InputError
/// when a file cannot be removed.
void remove_results(const std::filesystem::path& directory, std::initializer_list<std::string_view> names);

}  // namespace tribound::io
