#pragma once

/// @file seams.h
/// Where the bodies of a mesh are not joined, and what else a case says of its mesh.

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tribound::mesh
{

/// Two sides of boundary facets, by names of groups, that may touch and overlap each other: those of bodies
/// in contact, where vertices are doubled.
struct Interface
{
  std::array<std::vector<std::string>, 2> sides;
};

/// What is applied to a mesh before it is verified.
struct Seams
{
  std::vector<Interface> interfaces;
  std::vector<std::string> joints;  ///< groups of facets inside along which it is cut, see cut_open()
  bool has_axis = false;            ///< it is the meridian of bodies of revolution, see meet_axis()
};

/// The seams of a mesh with these boundaries; may throw InputError.
using FindSeams = std::function<Seams(std::span<const std::string> boundary_names)>;

}  // namespace tribound::mesh
