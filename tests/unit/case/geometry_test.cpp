// Obstacles, shapes and directions of contact in the case file: their meaning, and every mistake.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/case/config.h"
#include "tribound/case/resolve.h"

namespace tribound::geometry_cases
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;
using Names = std::vector<std::string>;

const std::string head =
    "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\nboundary.a.traction = [0, 0]\n";
const std::string floor_table = "[obstacle.floor]\nplane = { point = [0, 0], normal = [0, 2] }\n";
const std::string hole_table = "[shape.hole]\ncircle = { centre = [0, 1], radius = 1 }\n";

template <int dim = 2>
problem::Problem<dim> problem_of(const std::string& text)
{
  return case_file::resolve<dim>(case_file::parse_config(text, "case.toml"), Names{"steel"}, Names{"a", "b"});
}

template <int dim = 2>
std::string message(const std::string& text)
{
  return test::message_of([&] { (void)problem_of<dim>(text); });
}

/// Contact of boundary b with these keys, and the given tables.
std::string on_b(const std::string& keys, const std::string& tables)
{
  return head + "boundary.b.contact = { " + keys + " }\n" + tables;
}

/// Contact between a and b.
std::string pair_of(const std::string& keys, const std::string& tables)
{
  return "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\n[[contact]]\nslave = 'a'\nmaster = 'b'\n" +
         keys + tables;
}

TEST(Geometry, AnObstacleGivesGapAndDirection)
{
  const problem::Problem<2> p = problem_of(on_b("obstacle = 'floor'", floor_table));
  const problem::Contact& contact = *p.boundary(1).contact;
  EXPECT_EQ((*contact.gap)(Point<2>(3, 0.25)), 0.25);
  EXPECT_EQ((*contact.normal)(Point<2>(3, 0.25)), Point<2>(0, -1));
  EXPECT_FALSE(contact.true_surface);
  EXPECT_EQ(contact.geometry, "obstacle floor");
}

TEST(Geometry, TheShapeOfTheBodyComesFirst)
{
  const problem::Problem<2> p =
      problem_of(on_b("obstacle = 'floor', shape = 'hole'", floor_table + hole_table));
  const problem::Contact& contact = *p.boundary(1).contact;
  const Point<2> x(0.3, 0.06);  // just inside the circle around (0, 1)
  const double on_circle = 1 - 0.94 / std::hypot(0.3, 0.94);
  EXPECT_NEAR((*contact.gap)(x), on_circle, 1e-14);
  EXPECT_NEAR(std::abs((*contact.true_surface)(x)), 1 - std::hypot(0.3, 0.94), 1e-14);
  const problem::Problem<2> facet = problem_of(on_b("obstacle = 'floor', normal = 'facet'", floor_table));
  EXPECT_FALSE(facet.boundary(1).contact->normal);
  const problem::Problem<2> along = problem_of(on_b("obstacle = 'floor', normal = [1, 'x']", floor_table));
  EXPECT_NEAR((*along.boundary(1).contact->normal)(Point<2>(1, 0))[1], std::sqrt(0.5), 1e-15);
}

TEST(Geometry, ObstaclesAreMoved)
{
  const std::string moved = floor_table + "translate = [1, 0.5]\n";
  EXPECT_EQ((*problem_of(on_b("obstacle = 'floor'", moved)).boundary(1).contact->gap)(Point<2>(0, 0.75)),
            0.25);
  const std::string ball =
      "[obstacle.ball]\nsphere = { centre = [0, 0, 0], radius = 1, inside = true }\ntranslate = [0, 0, 1]\n";
  const std::string text =
      "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\nboundary.a.traction = [0, 0, 0]\n"
      "boundary.b.contact = { obstacle = 'ball' }\n" +
      ball;
  const problem::Contact contact = *problem_of<3>(text).boundary(1).contact;
  EXPECT_EQ((*contact.gap)(Point<3>(0, 0, 0.25)), 0.25);
  EXPECT_EQ((*contact.normal)(Point<3>(0, 0, 0.25)), Point<3>(0, 0, -1));
}

TEST(Geometry, PairsHaveTheGapOfTheirTrueShapes)
{
  const std::string shapes =
      "[shape.pin]\ncircle = { centre = [0, 1], radius = 1, inside = true }\n"
      "[shape.bore]\ncircle = { centre = [0, 1.5], radius = 1.5 }\n";
  const problem::Problem<2> p = problem_of(pair_of("shape = { slave = 'pin', master = 'bore' }\n", shapes));
  const problem::Contact& contact = p.pairs()[0].contact;
  EXPECT_NEAR((*contact.gap)(Point<2>(0, 0)), 0, 1e-15);
  EXPECT_NEAR((*contact.gap)(Point<2>(1, 1)), 1.5 - std::hypot(1, 0.5), 1e-14);
  EXPECT_NEAR(((*contact.normal)(Point<2>(1, 1)) - Point<2>(1, -0.5).normalized()).norm(), 0, 1e-14);
  // Both sides on one surface: no gap, the normal of the surface.
  const problem::Problem<2> one = problem_of(
      pair_of("shape = 'pin'\n", "[shape.pin]\ncircle = { centre = [0, 1], radius = 1, inside = true }\n"));
  EXPECT_TRUE(one.pairs()[0].contact.gap->is_zero());
  EXPECT_NEAR(((*one.pairs()[0].contact.normal)(Point<2>(0.5, 1)) - Point<2>(1, 0)).norm(), 0, 1e-14);
  // Only one side: its normal, and the gap of the meshes.
  const problem::Problem<2> slave =
      problem_of(pair_of("shape = { slave = 'pin' }\n",
                         "[shape.pin]\ncircle = { centre = [0, 1], radius = 1, inside = true }\n"));
  EXPECT_FALSE(slave.pairs()[0].contact.gap);
  EXPECT_NEAR(((*slave.pairs()[0].contact.normal)(Point<2>(0.5, 1)) - Point<2>(1, 0)).norm(), 0, 1e-14);
}

TEST(Geometry, MistakesOfSurfacesAreNamed)
{
  const auto obstacle = [](const std::string& table)
  { return message(on_b("obstacle = 'o'", "[obstacle.o]\n" + table)); };
  EXPECT_THAT(obstacle("translate = [0, 1]\n"),
              AllOf(HasSubstr("obstacle.o: does not define a surface"), HasSubstr("plane, circle, sphere")));
  EXPECT_THAT(
      obstacle("plane = { point = [0, 0], normal = [0, 1] }\ncircle = { centre = [0, 0], radius = 1 }\n"),
      HasSubstr("case.toml:7:10: obstacle.o.circle: circle stands beside another surface"));
  EXPECT_THAT(obstacle("plane = { point = [0, 0], normal = [0, 0] }\n"),
              HasSubstr("obstacle.o.plane.normal: has no length"));
  EXPECT_THAT(obstacle("plane = { point = [0, 0] }\n"), HasSubstr("normal"));
  EXPECT_THAT(obstacle("circle = { centre = [0, 0], radius = 0 }\n"), HasSubstr("obstacle.o.circle.radius"));
  EXPECT_THAT(obstacle("circle = { centre = [0, 0], radius = -1 }\n"), HasSubstr("obstacle.o.circle.radius"));
  EXPECT_THAT(obstacle("circle = { radius = 1 }\n"), HasSubstr("centre"));
  EXPECT_THAT(obstacle("circle = { centre = [0, 0, 0], radius = 1 }\n"),
              HasSubstr("obstacle.o.circle: has 3 coordinates, but the mesh is 2D"));
  EXPECT_THAT(obstacle("sphere = { centre = [0, 0], radius = 1 }\n"), HasSubstr("a sphere in a 2D case"));
  EXPECT_THAT(obstacle("cylinder = { centre = [0, 0, 0], axis = [0, 0, 0], radius = 1 }\n"),
              HasSubstr("obstacle.o.cylinder.axis: has no length"));
  EXPECT_THAT(obstacle("cylinder = { centre = [0, 0, 0], axis = [0, 0, 1], radius = 1 }\n"),
              HasSubstr("a cylinder in a 2D case"));
  EXPECT_THAT(obstacle("distance = 'y - q'\n"), HasSubstr("obstacle.o.distance: unknown name \"q\""));
  EXPECT_THAT(obstacle("distance = 'z - y'\n"), HasSubstr("obstacle.o.distance: uses z in a 2D case"));
  EXPECT_THAT(obstacle("plane = { point = [0, 0], normal = [0, 1] }\ntranslate = [1, 2, 3]\n"),
              HasSubstr("translate has 3 components, but the mesh is 2D"));
  EXPECT_THAT(obstacle("surface = 'a.stl'\n"), HasSubstr("a surface in a 2D case"));
  EXPECT_THAT(obstacle("plane = { point = [0, 0], normal = [0, 1] }\nside = 'front'\n"),
              HasSubstr("obstacle.o.side: stands beside another surface"));
  EXPECT_THAT(obstacle("surface = 'a.stl'\nside = 'top'\n"), HasSubstr("obstacle.o.side"));
  EXPECT_THAT(obstacle("box = 1\n"), HasSubstr("obstacle.o.box: unknown key"));
  EXPECT_THAT(message(on_b("obstacle = 'floor', shape = 's'", floor_table + "[shape.s]\ndistance = 'y'\n")),
              HasSubstr("shape.s.distance: unknown key"));
  const std::string in_3d =
      "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\n"
      "boundary.a.traction = [0, 0, 0]\nboundary.b.contact = { obstacle = 'o' }\n"
      "[obstacle.o]\ncircle = { centre = [0, 0, 0], radius = 1 }\n";
  EXPECT_THAT(message<3>(in_3d), HasSubstr("a circle in a 3D case"));
}

TEST(Geometry, MistakesOfContactsAreNamed)
{
  EXPECT_THAT(message(on_b("obstacle = 'flor'", floor_table)),
              AllOf(HasSubstr("boundary.b.contact.obstacle: there is no [obstacle.flor]"),
                    HasSubstr("did you mean \"floor\"?")));
  EXPECT_THAT(message(on_b("obstacle = 'floor', shape = 'hole'", floor_table)),
              HasSubstr("there is no [shape.hole]"));
  EXPECT_THAT(message(on_b("", floor_table)), HasSubstr("obstacle.floor: no contact names this obstacle"));
  EXPECT_THAT(message(on_b("obstacle = 'floor'", floor_table + hole_table)),
              HasSubstr("shape.hole: no contact names this shape"));
  EXPECT_THAT(message(on_b("obstacle = 'floor', gap = 0.1", floor_table)),
              HasSubstr("boundary.b.contact.gap: stands beside an obstacle"));
  EXPECT_THAT(message(on_b("normal = 'obstacle'", "")),
              HasSubstr("boundary.b.contact.normal: there is no such surface here"));
  EXPECT_THAT(message(on_b("normal = 'shape'", "")), HasSubstr("there is no such surface here"));
  EXPECT_THAT(message(on_b("normal = 'up'", "")), HasSubstr("boundary.b.contact.normal"));
  EXPECT_THAT(message(on_b("normal = [0, 0]", "")), HasSubstr("boundary.b.contact.normal: has no length"));
  EXPECT_THAT(message(on_b("normal = [0, 1, 0]", "")), HasSubstr("has 3 components, but the mesh is 2D"));
  EXPECT_THAT(message(on_b("normal = [0, 'z']", "")), HasSubstr("uses z in a 2D case"));
  EXPECT_THAT(message("obstacle = 3\n" + head), HasSubstr("obstacle: "));

  EXPECT_THAT(message(pair_of("shape = { slave = 'hole', master = 'hole' }\ngap = 0.1\n", hole_table)),
              HasSubstr("gap: stands beside the shapes of both sides"));
  EXPECT_THAT(message(pair_of("shape = {}\n", "")), HasSubstr("names no shape"));
  EXPECT_THAT(message(pair_of("shape = 'pin'\n", "")), HasSubstr("there is no [shape.pin]"));
  EXPECT_THAT(message(pair_of("normal = 'master'\n", "")), HasSubstr("there is no such surface here"));
  EXPECT_THAT(message(pair_of("friction = 'tied'\nnormal = [0, 1]\n", "")),
              HasSubstr("normal: does not belong to friction = \"tied\""));
  EXPECT_THAT(message(pair_of("friction = 'tied'\nshape = 'hole'\n", hole_table)),
              HasSubstr("shape: does not belong to friction = \"tied\""));
}

/// The case with an obstacle in an STL file of these triangles.
std::string with_triangles(const std::string& triangles, const std::string& keys = "")
{
  const std::string path = testing::TempDir() + "geometry_test.stl";
  std::ofstream(path) << triangles;
  return "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\nboundary.a.traction = [0, 0, 0]\n"
         "boundary.b.contact = { obstacle = 'o' }\n[obstacle.o]\nsurface = '" +
         path + "'\n" + keys;
}

std::string facet(const std::string& a, const std::string& b, const std::string& c)
{
  return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}

TEST(Geometry, SurfacesAreReadFromFiles)
{
  const std::string sheet =
      "solid sheet\n" + facet("-9 0 -9", "9 0 9", "9 0 -9") + facet("-9 0 -9", "-9 0 9", "9 0 9");
  const problem::Contact contact =
      *problem_of<3>(with_triangles(sheet, "side = 'front'\ntranslate = [0, 1, 0]\n")).boundary(1).contact;
  EXPECT_NEAR((*contact.gap)(Point<3>(0.5, 3, 0.25)), 2, 1e-14);
  EXPECT_NEAR(((*contact.normal)(Point<3>(0.5, 3, 0.25)) - Point<3>(0, -1, 0)).norm(), 0, 1e-14);
  EXPECT_FALSE(contact.normal->is_enclosed());
  const problem::Contact behind =
      *problem_of<3>(with_triangles(sheet, "side = 'back'\n")).boundary(1).contact;
  EXPECT_NEAR((*behind.gap)(Point<3>(0.5, -3, 0.25)), 3, 1e-14);

  EXPECT_THAT(message<3>(with_triangles(sheet)), HasSubstr("obstacle.o.surface: the surface is open"));
  EXPECT_THAT(message<3>(with_triangles("")), HasSubstr("is no STL file with triangles"));
  EXPECT_THAT(message<3>(with_triangles("solid nothing\nendsolid\n")),
              HasSubstr("is no STL file with triangles"));
  EXPECT_THAT(message<3>(with_triangles("solid s\n" + facet("0 0 0", "0 0 0", "1 0 0"))),
              HasSubstr("has no triangle"));
  EXPECT_THAT(message<3>(with_triangles("solid s\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                        facet("0 0 0", "1 0 0", "0 0 1"))),
              HasSubstr("do not make a surface"));
  const std::string closed = "solid tetrahedron\n" + facet("0 0 0", "0 1 0", "1 0 0") +
                             facet("0 0 0", "1 0 0", "0 0 1") + facet("0 0 0", "0 0 1", "0 1 0") +
                             facet("1 0 0", "0 1 0", "0 0 1");
  EXPECT_EQ(message<3>(with_triangles(closed)), "");
  EXPECT_THAT(message<3>(with_triangles(closed, "side = 'back'\n")), HasSubstr("the surface is closed"));
  const std::string missing =
      "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\nboundary.a.traction = [0, 0, 0]\n"
      "boundary.b.contact = { obstacle = 'o' }\n[obstacle.o]\nsurface = 'none.stl'\n";
  EXPECT_THAT(message<3>(missing), HasSubstr("obstacle.o.surface: none.stl cannot be read"));
}

}  // namespace
}  // namespace tribound::geometry_cases
