#pragma once

/// @file temporary_directory.h

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace tribound
{

/// Makes a directory of our own where temporary files belong; empty if that fails.
[[nodiscard]] inline std::filesystem::path make_temporary_directory()
{
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "tribound-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) return {};
  return name;
}

}  // namespace tribound
