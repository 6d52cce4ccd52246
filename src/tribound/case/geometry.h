#pragma once

/// @file geometry.h
/// [obstacle.NAME], [shape.NAME], and how a contact uses them: plain data, like the rest of config.h.

#include <filesystem>
#include <string>
#include <vector>

#include "tribound/base/error.h"

namespace tribound::case_file
{

/// One [obstacle.NAME] or [shape.NAME] table.
struct SurfaceConfig
{
  enum class Kind
  {
    plane,
    circle,
    sphere,
    cylinder,
    distance,  ///< by a formula; obstacles only
    surface,   ///< triangles from an STL file
    mesh       ///< the second-order facets of the mesh; shapes only
  };

  /// The side of the body: outside or inside a closed surface; in front of an open one, where its normals
  /// point, or behind it.
  enum class Side
  {
    outside,
    inside,
    front,
    back
  };

  std::string name;
  Kind kind = Kind::plane;
  std::vector<double> point{};      ///< of a plane; the centre of others
  std::vector<double> direction{};  ///< normal of a plane, axis of a cylinder
  double radius = 0;
  bool inside = false;     ///< whether the body lies inside
  std::string distance{};  ///< the formula
  std::filesystem::path file{};
  Side side = Side::outside;        ///< of `surface`
  std::vector<double> translate{};  ///< empty: none
  Where where{};                    ///< of the table
  Where kind_where{};               ///< of the key that gives the kind
};

/// The obstacle, shapes and direction of a contact.
struct GeometryConfig
{
  enum class Normal
  {
    standard,  ///< that of the obstacle or of the master's shape, else of the slave's, else of the facets
    facet,
    obstacle,  ///< also of the master
    shape,     ///< of the body or the slave
    given
  };

  std::string obstacle{};      ///< name; empty: none
  std::string shape{};         ///< of the boundary or the slave
  std::string master_shape{};  ///< same name as `shape`: both sides lie on it
  Normal normal = Normal::standard;
  std::vector<std::string> direction{};  ///< formulas of `given`, of any length
  Where where{};                         ///< of the contact
  Where obstacle_where{};
  Where shape_where{};
  Where master_shape_where{};
  Where normal_where{};
};

}  // namespace tribound::case_file
