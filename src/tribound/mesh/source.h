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

/// What a reader does beyond what the file says.
struct ImportOptions
{
  double size = 0;               ///< largest edge in a geometry that is to be meshed; 0: by its extent
  double merge = 0;              ///< nodes of a body not farther apart than this become one; 0: none
  bool ignore_elements = false;  ///< elements without a counterpart are left out, with a note
  std::string region_array{};    ///< the cell array that has the regions, where a format has arrays
  std::vector<std::string> boundaries{};  ///< the sets that become boundaries; empty: all
};

/// A mesh or a geometry in one of the formats of read_imported().
struct MeshFile
{
  std::filesystem::path path;
  Where where = {};  ///< for messages
  ImportOptions options = {};
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
