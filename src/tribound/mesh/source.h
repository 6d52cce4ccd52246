#pragma once

/// @file source.h
/// Where a mesh comes from.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// A mesh read through Gmsh (.msh of any version, .geo).
struct MeshFile
{
  std::filesystem::path path;
  Where where = {};  ///< for messages
};

/// The structured mesh of a box; the length of the lists is the dimension. Boundaries: left right (x), bottom
/// top (y), back front (z) in 3D, where back is z = lower and front is z = upper; region: "box".
struct BoxMesh
{
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<int> cells;
  Where where = {};  ///< for messages
};

/// Several boxes, each a body of its own: region NAME, boundaries NAME.left, NAME.right, ...
struct NamedBox
{
  std::string name;
  BoxMesh box;
};
using Boxes = std::vector<NamedBox>;

using MeshSource = std::variant<MeshFile, BoxMesh, Boxes>;

}  // namespace tribound::mesh
