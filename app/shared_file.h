#pragma once

/// @file shared_file.h
/// Files that the program needs beside itself: scripts that it runs, the template of the report page; and
/// those that are a part of it.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tribound::app
{

/// The file of this name, without symbolic links: in share/tribound of the installation or build tree that
/// the program belongs to, which may have been moved; else under the prefix of the installation. Empty where
/// it is in neither.
[[nodiscard]] std::filesystem::path find_shared_file(const std::string& name);

/// The folder of the guide, found in the same way; where the prefix has it if it is in neither.
[[nodiscard]] std::filesystem::path guide_directory();

struct EmbeddedFile
{
  std::string_view name;
  std::string_view text;
};

/// The files of app/templates, and docs/case-format.md; see cmake/embed.cmake.
[[nodiscard]] std::span<const EmbeddedFile> embedded_files();

}  // namespace tribound::app
