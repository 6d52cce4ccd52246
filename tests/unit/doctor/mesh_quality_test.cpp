/// @file mesh_quality_test.cpp
/// Angles and aspect ratios of cells of known shape.

#include "tribound/doctor/mesh_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/meshes.h"

namespace tribound::test
{

namespace
{

template <int dim>
mesh::Mesh<dim> one_cell(const std::vector<Point<dim>>& vertices)
{
  mesh::Cell<dim> cell;
  for (int i = 0; i <= dim; ++i) cell[i] = i;
  return mesh::Mesh<dim>(mesh::MeshData<dim>{{.region_names = {"body"}}, vertices, {cell}, {0}});
}

constexpr double degrees = 180 / std::numbers::pi;

TEST(MeshQuality, RegularTriangle)
{
  const auto quality = doctor::mesh_quality(one_cell<2>({{0, 0}, {2, 0}, {1, std::sqrt(3)}}));
  EXPECT_NEAR(quality.smallest_angle, 60, 1e-12);
  EXPECT_NEAR(quality.largest_angle, 60, 1e-12);
  EXPECT_NEAR(quality.largest_aspect, 1, 1e-14);
  EXPECT_NEAR(quality.smallest_cell, 2, 1e-14);
}

TEST(MeshQuality, RegularTetrahedron)
{
  const auto quality = doctor::mesh_quality(one_cell<3>({{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}));
  EXPECT_NEAR(quality.smallest_angle, std::acos(1.0 / 3) * degrees, 1e-12);
  EXPECT_NEAR(quality.largest_angle, std::acos(1.0 / 3) * degrees, 1e-12);
  EXPECT_NEAR(quality.largest_aspect, 1, 1e-14);
}

TEST(MeshQuality, FlatTriangle)
{
  const auto quality = doctor::mesh_quality(one_cell<2>({{0, 0}, {2, 0}, {1, 0.1}}));
  const double base_angle = std::atan(0.1) * degrees;
  EXPECT_NEAR(quality.smallest_angle, base_angle, 1e-10);
  EXPECT_NEAR(quality.largest_angle, 180 - 2 * base_angle, 1e-10);
  const double inradius = 2 * 0.1 / (2 + 2 * std::sqrt(1.01));  // 2 |T| / perimeter
  EXPECT_NEAR(quality.largest_aspect, 2 / (2 * std::sqrt(3) * inradius), 1e-12);
}

TEST(MeshQuality, SaysWhere)
{
  const auto pinch = [](const Point<2>& x) -> Point<2> {
    return {x[0], x[0] > 2.5 ? 0.1 * x[1] : x[1]};
  };
  const auto quality = doctor::mesh_quality(mesh::Mesh<2>(mapped<2>(box<2>({0, 0}, {4, 1}, {4, 1}), pinch)));
  EXPECT_GT(quality.smallest_angle_at[0], 2.5);
  EXPECT_NEAR(quality.smallest_angle, std::atan(0.1) * degrees, 1e-10);
  EXPECT_NEAR(quality.largest_cell, std::sqrt(2), 1e-14);
  EXPECT_NEAR(quality.smallest_cell, std::sqrt(1.01), 1e-14);
}

}  // namespace

}  // namespace tribound::test
