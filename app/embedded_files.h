#pragma once

/// @file embedded_files.h
/// Text files that are part of the program, see cmake/embed.cmake.

#include <span>
#include <string_view>

namespace tribound::app
{

struct EmbeddedFile
{
  std::string_view name;
  std::string_view text;
};

/// The files of app/templates.
[[nodiscard]] std::span<const EmbeddedFile> embedded_files();

}  // namespace tribound::app
