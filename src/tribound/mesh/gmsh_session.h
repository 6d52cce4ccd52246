#pragma once

/// @file gmsh_session.h
/// A Gmsh model loaded from a file; the only place where Gmsh is started and stopped.

#include <filesystem>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// What Gmsh may need for a file, beside its library.
struct ReadingLimits
{
  double memory;   ///< bytes of address space
  double seconds;  ///< of CPU time
};

/// For a .msh by its size: several times what sound files need, so that wrong counts in a damaged one, which
/// Gmsh believes, cost neither gigabytes nor minutes. For a .geo infinite: a few lines may ask for any mesh.
[[nodiscard]] ReadingLimits reading_limits(const std::filesystem::path& file);

/// Gmsh holds one global state per process: one session at a time. Its messages go to stdout and stderr.
class GmshSession
{
 public:
  /// Opens a .msh within its reading_limits(), or opens and meshes a .geo; in a process of its own
  /// (base/apart.h). Throws InputError with Gmsh's own message, placed at `file`, and std::bad_alloc.
  explicit GmshSession(const std::filesystem::path& file);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

/// Throws InputError at `where` unless the file can be read and is, by its suffix and its first characters, a
/// .msh, a .geo or an .inp.
void check_mesh_file(const std::filesystem::path& file, const Where& where);

}  // namespace tribound::mesh
