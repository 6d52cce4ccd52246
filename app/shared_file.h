#pragma once

/// @file shared_file.h
/// Files that the program needs besides itself: scripts that it runs, the template of the report page; and
/// those embedded in it.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tribound::app
{

/// The file of this name, with symbolic links resolved: in share/tribound of the installation or build tree
/// of the program, which may have been moved; else under the prefix of the installation. Empty if it is in
/// neither.
[[nodiscard]] std::filesystem::path find_shared_file(const std::string& name);

/// The folder of the guide, found in the same way; if it is in neither, its place under the prefix.
[[nodiscard]] std::filesystem::path guide_directory();

struct EmbeddedFile
{
  std::string_view name;
  std::string_view text;
};

/// The files of app/templates, and docs/case-format.md; see cmake/embed.cmake.
[[nodiscard]] std::span<const EmbeddedFile> embedded_files();

}  // namespace tribound::app
