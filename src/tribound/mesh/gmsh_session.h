#pragma once

/// @file gmsh_session.h
/// A Gmsh model loaded from a file; the only place where Gmsh is started and stopped.

#include <filesystem>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// Gmsh holds one global state per process: one session at a time. Its messages go to stdout and stderr.
class GmshSession
{
 public:
  /// Opens a .msh, or opens and meshes a .geo. Throws InputError with Gmsh's own message, placed at `file`.
  explicit GmshSession(const std::filesystem::path& file);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

/// Throws InputError at `where` unless the file can be read and is, by its suffix and its first characters, a
/// .msh or a .geo.
void check_mesh_file(const std::filesystem::path& file, const Where& where);

}  // namespace tribound::mesh
