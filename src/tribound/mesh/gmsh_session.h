#pragma once

/// @file gmsh_session.h
/// A Gmsh model loaded from a file; the only place where Gmsh is started.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// What Gmsh may need for a file, beside its library.
struct ReadingLimits
{
  double memory;   ///< bytes of address space
  double seconds;  ///< of CPU time
};

/// For a mesh by the size of the file: several times what sound files need, so that wrong counts in a damaged
/// one, which Gmsh believes, cost neither gigabytes nor minutes. For a geometry infinite: a few lines may ask
/// for any mesh.
[[nodiscard]] ReadingLimits reading_limits(const std::filesystem::path& file);

/// Starts Gmsh and opens a mesh within its reading_limits(), or opens and meshes a geometry; in a process of
/// its own (base/apart.h), once, which ends without stopping Gmsh: after elements that it takes for others it
/// crashes then. Its messages go to stdout and stderr. `notes` gets what a geometry was meshed with. Throws
/// InputError with Gmsh's own message, placed at the file, and std::bad_alloc.
void open_in_gmsh(const MeshFile& source, std::vector<std::string>& notes);

/// Runs one step of Gmsh, which reports failure by an exception, by a message, or by both: an InputError
/// "Gmsh cannot `what`: ...".
void run_gmsh(const std::filesystem::path& file, const std::string& what, const std::string& hint,
              const std::function<void()>& step);

}  // namespace tribound::mesh
