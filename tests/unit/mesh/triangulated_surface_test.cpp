/// @file triangulated_surface_test.cpp
/// Surfaces of triangles, against the sphere and the box they approximate and against trying every triangle.

#include "tribound/mesh/triangulated_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace tribound::test
{

namespace
{

using mesh::TriangulatedSurface;

struct Triangles
{
  std::vector<Point<3>> vertices;
  std::vector<TriangulatedSurface::Triangle> triangles;
};

/// An octahedron refined n times, with its vertices moved to the unit sphere.
Triangles ball(int n)
{
  Triangles result;
  const auto add = [&](auto&& self, const Point<3>& a, const Point<3>& b, const Point<3>& c,
                       int depth) -> void
  {
    if (depth == 0)
    {
      const auto first = static_cast<Index>(result.vertices.size());
      for (const Point<3>& x : {a, b, c}) result.vertices.push_back(x);
      result.triangles.push_back({first, first + 1, first + 2});
      return;
    }
    const Point<3> ab = (a + b).normalized();
    const Point<3> bc = (b + c).normalized();
    const Point<3> ca = (c + a).normalized();
    self(self, a, ab, ca, depth - 1);
    self(self, ab, b, bc, depth - 1);
    self(self, ca, bc, c, depth - 1);
    self(self, ab, bc, ca, depth - 1);
  };
  for (const double z : {1.0, -1.0})
    for (int i = 0; i < 4; ++i)
    {
      const std::array<Point<3>, 4> around = {Point<3>(1, 0, 0), Point<3>(0, 1, 0), Point<3>(-1, 0, 0),
                                              Point<3>(0, -1, 0)};
      const Point<3>& from = around[z > 0 ? i : (i + 1) % 4];
      const Point<3>& to = around[z > 0 ? (i + 1) % 4 : i];
      add(add, from, to, Point<3>(0, 0, z), n);
    }
  return result;
}

TEST(TriangulatedSurface, ABallIsNearlyASphere)
{
  const Triangles data = ball(4);
  const TriangulatedSurface surface(data.vertices, data.triangles, {});
  EXPECT_EQ(surface.n_triangles(), 8u * 256);
  ASSERT_TRUE(surface.is_closed());
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> within(-2, 2);
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Point<3> x(within(dice), within(dice), within(dice));
    const TriangulatedSurface::Nearest found = surface.nearest(x);
    EXPECT_NEAR(found.distance, x.norm() - 1, 6e-3);
    EXPECT_NEAR(std::abs(found.distance), (x - found.point).norm(), 1e-14);
    EXPECT_NEAR(found.normal.norm(), 1, 1e-14);
    EXPECT_GE(found.normal.dot(found.point.normalized()), std::cos(0.02));
  }
}

/// Normals point outward whatever the orientation of the triangles; distances are those of a box, at its
/// faces, edges and corners.
TEST(TriangulatedSurface, ABoxHasItsDistances)
{
  Triangles box;
  for (int v = 0; v < 8; ++v) box.vertices.emplace_back(v & 1, (v >> 1) & 1, (v >> 2) & 1);
  for (const auto& [a, b, c, d] : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
  {
    box.triangles.push_back({a, b, c});
    box.triangles.push_back({a, c, d});
  }
  std::mt19937 dice(2);
  std::uniform_real_distribution<double> within(-1, 2);
  for (const bool inverted : {false, true})
  {
    if (inverted)
      for (auto& t : box.triangles) std::swap(t[0], t[1]);
    const TriangulatedSurface surface(box.vertices, box.triangles, {});
    ASSERT_TRUE(surface.is_closed());
    for (int trial = 0; trial < 2000; ++trial)
    {
      const Point<3> x(within(dice), within(dice), within(dice));
      const Point<3> out = (x - Point<3>::Constant(0.5)).cwiseAbs() - Point<3>::Constant(0.5);
      const double exact = out.cwiseMax(0).norm() + std::min(out.maxCoeff(), 0.0);
      EXPECT_NEAR(surface.nearest(x).distance, exact, 1e-14);
    }
  }
}

TEST(TriangulatedSurface, FilesAreReadInBothForms)
{
  const Triangles data = ball(1);
  const std::string text = testing::TempDir() + "ball_text.stl";
  const std::string binary = testing::TempDir() + "ball_binary.stl";
  std::ofstream ascii(text);
  ascii << "solid ball\n";
  std::ofstream bytes(binary, std::ios::binary);
  std::string header = "solid by its first word, binary by its size";
  header.resize(80, ' ');
  bytes << header;
  const auto put = [&bytes](const auto& value)
  { bytes.write(reinterpret_cast<const char*>(&value), sizeof(value)); };
  put(static_cast<std::uint32_t>(data.triangles.size()));
  for (const auto& t : data.triangles)
  {
    ascii << "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) put(0.0F);
    for (const Index v : t)
    {
      ascii << "vertex";
      for (const double coordinate : data.vertices[v])
      {
        ascii << ' ' << static_cast<float>(coordinate);
        put(static_cast<float>(coordinate));
      }
      ascii << '\n';
    }
    ascii << "endloop\nendfacet\n";
    put(std::uint16_t{0});
  }
  ascii << "endsolid\n";
  ascii.close();
  bytes.close();
  for (const std::string& file : {text, binary})
  {
    const TriangulatedSurface surface = mesh::read_stl(file, {});
    EXPECT_EQ(surface.n_triangles(), 32u);
    EXPECT_TRUE(surface.is_closed());
    EXPECT_NEAR(surface.nearest(Point<3>(3, 0, 0)).distance, 2, 1e-6);
  }
}

}  // namespace

}  // namespace tribound::test
