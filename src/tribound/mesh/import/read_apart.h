#pragma once

/// @file read_apart.h
/// Reading by libraries that do not survive damaged files.

#include <filesystem>
#include <functional>
#include <string>

namespace tribound::mesh
{

/// What `read` returns in a copy of this process (base/apart.h), or an InputError as bytes
/// (imported_bytes.h). Whatever a library does with the file (crash, hang, use up memory), the result is an
/// InputError, in which it is called `library`. What it may use of memory and time fits the size of the file.
[[nodiscard]] std::string read_apart(const std::filesystem::path& file, const std::string& library,
                                     const std::function<std::string()>& read);

}  // namespace tribound::mesh
