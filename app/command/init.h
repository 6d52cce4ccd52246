#pragma once

/// @file init.h
/// The command `tribound init`: a case to start from.

#include <filesystem>
#include <string>
#include <vector>

namespace tribound::app
{

/// The cases that `init` knows, in the order of app/templates.
[[nodiscard]] std::vector<std::string> template_names();

/// Writes the commented case NAME.toml, with NAME.geo where it needs one, into the directory and prints what
/// to do next. Throws InputError for an unknown name, when one of the files exists (then none is written),
/// and when a file cannot be written.
void init(const std::string& name, const std::filesystem::path& directory);

}  // namespace tribound::app
