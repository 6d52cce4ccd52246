#pragma once

/// @file read_apart.h
/// Reading by libraries that do not survive damaged files.

#include <filesystem>
#include <functional>
#include <string>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// The mesh that `read` returns in a copy of this process (base/apart.h). Whatever a library does with the
/// file (crash, hang, use up memory), the result is an InputError, in which it is called `library`. What it
/// may use of memory and time fits the size of the file.
[[nodiscard]] ImportedMesh read_apart(const std::filesystem::path& file, const std::string& library,
                                      const std::function<ImportedMesh()>& read);

}  // namespace tribound::mesh
