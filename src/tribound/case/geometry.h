#pragma once

/// @file geometry.h
/// [obstacle.NAME], [shape.NAME], and what a contact makes of them: plain data, as the rest of config.h.

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
    distance,  ///< by a formula; obstacles alone
    surface,   ///< triangles from an STL file
    mesh       ///< the second-order facets of the mesh; shapes alone
  };

  /// Where the body is: of a closed surface outside or inside, of an open one on the side into which the
  /// normals point, or on the other.
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
  Where kind_where{};               ///< of the key that says what it is
};

/// What a contact says of obstacle, shapes and direction.
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
  std::string master_shape{};  ///< the same name as `shape`: both sides lie on it
  Normal normal = Normal::standard;
  std::vector<std::string> direction{};  ///< formulas of `given`, of any length
  Where where{};                         ///< of the contact
  Where obstacle_where{};
  Where shape_where{};
  Where master_shape_where{};
  Where normal_where{};
};

}  // namespace tribound::case_file
