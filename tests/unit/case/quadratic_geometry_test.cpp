// A shape given by the second-order facets of the mesh: its meaning, enclosures, and every mistake.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "support/edge_nodes.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/case/config.h"
#include "tribound/case/resolve.h"
#include "tribound/problem/formula.h"

namespace tribound::quadratic_geometry_cases
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

/// y of the lower side.
template <int dim>
double height(const Point<dim>& x)
{
  return 0.5 * x[0] * x[0] + (dim == 3 ? 0.2 * x[0] * x[2 % dim] : 0);
}

/// y of the upper side of the block below.
template <int dim>
double depth(const Point<dim>& x)
{
  return -0.5 - 0.3 * x[0] * x[0] - (dim == 3 ? 0.1 * x[2 % dim] * x[2 % dim] : 0);
}

/// A block with a bent lower side, above one with a bent upper side; a mesh of order 2 or 1.
template <int dim>
mesh::Mesh<dim> bent_block(int order = 2)
{
  std::array<int, dim> cells;
  cells.fill(3);
  mesh::MeshData<dim> data = test::mapped<dim>(test::block<dim>(cells),
                                               [](Point<dim> x) -> Point<dim>
                                               {
                                                 x[0] -= 1;
                                                 x[1] += (1 - x[1]) * height(x);
                                                 return x;
                                               });
  const auto on_curve = [](Point<dim> x) -> Point<dim>
  {
    x[1] = height(x);
    return x;
  };
  if (order == 2) data = test::with_edge_nodes<dim>(std::move(data), 2, on_curve);
  mesh::MeshData<dim> below = test::mapped<dim>(test::block<dim>(cells),
                                                [](Point<dim> x) -> Point<dim>
                                                {
                                                  x[0] -= 1;
                                                  x[1] = -1.5 + x[1] * (1.5 + depth(x));
                                                  return x;
                                                });
  const auto on_other_curve = [](Point<dim> x) -> Point<dim>
  {
    x[1] = depth(x);
    return x;
  };
  if (order == 2) below = test::with_edge_nodes<dim>(std::move(below), 3, on_other_curve);
  return mesh::Mesh<dim>(test::side_by_side(std::move(data), below, "2"));
}

template <int dim = 2>
problem::Problem<dim> problem_of(const std::string& text, int order = 2)
{
  return case_file::resolve<dim>(
      case_file::parse_config("mesh.box = { lower = [0, 0], upper = [1, 1], cells = [1, 1] }\n"
                              "material = { E = 1, nu = 0.25 }\n" +
                                  text,
                              "case.toml"),
      bent_block<dim>(order));
}

template <int dim = 2>
std::string message(const std::string& text, int order = 2)
{
  return test::message_of([&] { (void)problem_of<dim>(text, order); });
}

const std::string shape_table = "[shape.foot]\nmesh = 'order2'\n";

std::string on_bottom(const std::string& keys, const std::string& tables)
{
  return "boundary.bottom.contact = { " + keys + " }\n" + tables;
}

std::string pair_of(const std::string& keys, const std::string& tables)
{
  return "[[contact]]\nslave = 'bottom'\nmaster = 'top2'\n" + keys + tables;
}

TEST(QuadraticGeometry, GapAndDirectionAreThoseOfTheCurve)
{
  const std::string tables = shape_table + "[obstacle.floor]\nplane = { point = [0, 0], normal = [0, 1] }\n";
  const problem::Problem<2> p = problem_of(on_bottom("obstacle = 'floor', shape = 'foot'", tables));
  const problem::Contact& contact = *p.boundary(2).contact;
  EXPECT_EQ(contact.geometry, "obstacle floor, shape foot");
  EXPECT_EQ(contact.gap->degree(), 2);
  EXPECT_TRUE(contact.gap->is_enclosed());
  EXPECT_TRUE(contact.normal->is_constant());
  const Point<2> x(-0.1, (height<2>({-1.0 / 3, 0}) + height<2>({1.0 / 3, 0})) / 2);  // on the middle facet
  EXPECT_NEAR((*contact.gap)(x), height(x), 1e-15);
  EXPECT_NEAR(((*contact.normal)(x)-Point<2>(0, -1)).norm(), 0, 1e-15);
  // The facet lies inside the body.
  EXPECT_LT((*contact.true_surface)(x), 0);
  EXPECT_NEAR((*contact.true_surface)(x), height(x) - x[1], 1e-3);

  const problem::Problem<2> own =
      problem_of(on_bottom("gap = 0, shape = 'foot', normal = 'shape'", shape_table));
  EXPECT_NEAR(((*own.boundary(2).contact->normal)(x)-Point<2>(-0.1, -1).normalized()).norm(), 0, 0.01);
}

/// Checks enclosures over parts of facets: values, and Taylor coefficients by differences.
template <int dim>
void expect_enclosed(const problem::Field& field, const mesh::Mesh<dim>& mesh)
{
  ASSERT_TRUE(field.is_enclosed());
  EXPECT_EQ(field.degree(), problem::FieldFunction::not_polynomial);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag != 2) continue;
    const auto whole =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
    Point<dim> centre = Point<dim>::Zero();
    for (const Point<dim>& v : whole) centre += v / dim;
    std::vector<double> vertices;
    for (const Point<dim>& v : whole)
      for (const double c : (Point<dim>((v + centre) / 2))) vertices.push_back(c);
    std::array<problem::Enclosure, 3> taylor;
    field.enclose(vertices, dim, taylor);
    for (int trial = 0; trial < 20; ++trial)
    {
      Point<dim> x = Point<dim>::Zero();
      double sum = 0;
      for (int i = 0; i < dim; ++i)
      {
        const double weight = uniform(random);
        x += weight * Point<dim>(&vertices[i * dim]);
        sum += weight;
      }
      x /= sum;
      EXPECT_TRUE(taylor[0].contains(field(x)));
      constexpr double t = 1e-4;
      const Point<dim> step = t * (x - centre);
      const double first = (field(Point<dim>(x + step)) - field(Point<dim>(x - step))) / (2 * t);
      const double second =
          (field(Point<dim>(x + step)) - 2 * field(x) + field(Point<dim>(x - step))) / (2 * t * t);
      EXPECT_GE(first, taylor[1].lower - 1e-8);
      EXPECT_LE(first, taylor[1].upper + 1e-8);
      EXPECT_GE(second, taylor[2].lower - 1e-6);
      EXPECT_LE(second, taylor[2].upper + 1e-6);
    }
    EXPECT_LT(taylor[0].upper - taylor[0].lower, 1);
  }
}

template <int dim>
void expect_contact_enclosed(const std::string& obstacle)
{
  const problem::Problem<dim> p =
      problem_of<dim>(on_bottom("obstacle = 'o', shape = 'foot'", shape_table + "[obstacle.o]\n" + obstacle));
  const mesh::Mesh<dim> mesh = bent_block<dim>();
  const problem::Contact& contact = *p.boundary(2).contact;
  expect_enclosed<dim>(*contact.gap, mesh);
  for (const problem::Field& component : contact.normal->components()) expect_enclosed<dim>(component, mesh);
  const problem::Problem<dim> own =
      problem_of<dim>(on_bottom("gap = 0, shape = 'foot', normal = 'shape'", shape_table));
  for (const problem::Field& component : own.boundary(2).contact->normal->components())
    expect_enclosed<dim>(component, mesh);
}

TEST(QuadraticGeometry, WhatCurvedObstaclesMakeOfItIsEnclosed)
{
  expect_contact_enclosed<2>("circle = { centre = [0.1, -2], radius = 2 }\n");
  expect_contact_enclosed<3>("sphere = { centre = [0.1, -2, 0.3], radius = 2 }\n");
}

TEST(QuadraticGeometry, ASurfaceOfTrianglesIsMetOnIt)
{
  const std::string path = testing::TempDir() + "quadratic_geometry_test.stl";
  std::ofstream(path) << "solid s\nfacet normal 0 0 0\nouter loop\nvertex -9 0 -9\nvertex 0 0 9\nvertex 9 0 "
                         "-9\nendloop\nendfacet\nendsolid\n";
  const problem::Problem<3> p =
      problem_of<3>(on_bottom("obstacle = 'o', shape = 'foot'",
                              shape_table + "[obstacle.o]\nsurface = '" + path + "'\nside = 'front'\n"));
  const problem::Contact& contact = *p.boundary(2).contact;
  EXPECT_FALSE(contact.gap->is_enclosed());
  const mesh::Mesh<3> mesh = bent_block<3>();
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag != 2) continue;
    const Point<3> x = mesh::facet_map(mesh, facet.cell, facet.local)(Point<2>(0.3, 0.2));
    EXPECT_NEAR((*contact.gap)(x), height(x), 1e-14);
    EXPECT_LT((*contact.true_surface)(x), 1e-15);
  }
}

TEST(QuadraticGeometry, SlavesOfPairsHaveIt)
{
  const std::string bore = "[shape.bore]\nplane = { point = [0, -0.25], normal = [0, 1] }\n";
  const problem::Problem<2> p =
      problem_of(pair_of("shape = { slave = 'foot', master = 'bore' }\n", shape_table + bore));
  const Point<2> x(-0.1, (height<2>({-1.0 / 3, 0}) + height<2>({1.0 / 3, 0})) / 2);
  EXPECT_NEAR((*p.pairs()[0].contact.gap)(x), height(x) + 0.25, 1e-15);
  // Both sides on the shape: no gap, its normal, from the facets of the slave.
  const problem::Problem<2> one = problem_of(pair_of("shape = 'foot'\n", shape_table));
  EXPECT_TRUE(one.pairs()[0].contact.gap->is_zero());
  EXPECT_NEAR(((*one.pairs()[0].contact.normal)(x)-Point<2>(-0.1, -1).normalized()).norm(), 0, 0.01);
  const problem::Problem<2> slave = problem_of(pair_of("shape = { slave = 'foot' }\n", shape_table));
  EXPECT_FALSE(slave.pairs()[0].contact.gap);
  EXPECT_TRUE(slave.pairs()[0].contact.normal);
}

/// The distance of `from` from the upper side of the block below, by sampling.
template <int dim>
double sampled_distance(const Point<dim>& from)
{
  constexpr int n = 1000;
  double least = 9;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= (dim == 3 ? n : 0); ++j)
    {
      Point<dim> y = Point<dim>::Zero();
      y[0] = -1 + 2.0 * i / n;
      if (dim == 3) y[dim - 1] = static_cast<double>(j) / n;
      y[1] = depth(y);
      least = std::min(least, (from - y).norm());
    }
  return least;
}

template <int dim>
Point<dim> on_bottom_of(const mesh::Mesh<dim>& mesh)
{
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.tag == 2) return mesh::facet_map(mesh, facet.cell, facet.local)(Point<dim - 1>::Constant(0.3));
  return Point<dim>::Zero();
}

/// The distance from the master alone, below another mesh of order 2, and below formulas.
template <int dim>
void expect_distances_from_master()
{
  const mesh::Mesh<dim> mesh = bent_block<dim>();
  const Point<dim> x = on_bottom_of(mesh);
  Point<dim> on_curve = x;
  on_curve[1] = height(x);
  const Point<dim> on_plane = x - (x[1] - 0.25) * Point<dim>(Point<dim>::Unit(1));
  const std::string seat = "[shape.seat]\nmesh = 'order2'\n";
  const std::string coordinates =
      dim == 2 ? "point = [0, 0.25], normal = [0, -1]" : "point = [0, 0.25, 0], normal = [0, -1, 0]";
  const auto gap = [&](const std::string& slave)
  {
    const problem::Problem<dim> p = problem_of<dim>(
        pair_of("shape = { slave = 'pin', master = 'seat' }\n", seat + "[shape.pin]\n" + slave));
    const problem::Contact& contact = p.pairs()[0].contact;
    EXPECT_EQ(contact.geometry, "shape pin, shape of the master seat");
    EXPECT_FALSE(contact.normal->is_constant());
    EXPECT_TRUE(contact.true_surface);
    EXPECT_LT(((*contact.normal)(x) + Point<dim>(Point<dim>::Unit(1))).norm(), 1);
    return (*contact.gap)(x);
  };
  EXPECT_NEAR(gap("mesh = 'order2'\n"), sampled_distance(on_curve), 1e-5);
  EXPECT_NEAR(gap("plane = { " + coordinates + " }\n"), sampled_distance(on_plane), 1e-5);
  if constexpr (dim == 3)
  {
    const std::string path = testing::TempDir() + "quadratic_geometry_master_test.stl";
    std::ofstream(path) << "solid s\nfacet normal 0 0 0\nouter loop\nvertex -9 0.25 -9\nvertex 9 0.25 -9\n"
                           "vertex 0 0.25 9\nendloop\nendfacet\nendsolid\n";
    EXPECT_NEAR(gap("surface = '" + path + "'\nside = 'front'\n"), sampled_distance(on_plane), 1e-5);
  }
  const problem::Problem<dim> alone = problem_of<dim>(pair_of("shape = { master = 'seat' }\n", seat));
  EXPECT_FALSE(alone.pairs()[0].contact.gap);
  EXPECT_FALSE(alone.pairs()[0].contact.true_surface);
  EXPECT_LT(((*alone.pairs()[0].contact.normal)(x) + Point<dim>(Point<dim>::Unit(1))).norm(), 1);
}

TEST(QuadraticGeometry, MastersOfPairsHaveIt)
{
  expect_distances_from_master<2>();
  expect_distances_from_master<3>();
}

TEST(QuadraticGeometry, MistakesAreNamed)
{
  const std::string alone = on_bottom("gap = 0, shape = 'foot'", shape_table);
  EXPECT_EQ(message(alone), "");
  EXPECT_THAT(message(alone, 1), AllOf(HasSubstr("shape.foot.mesh: the mesh has no second-order facets"),
                                       HasSubstr("Mesh.ElementOrder = 2")));
  EXPECT_THAT(message(on_bottom("gap = 0, shape = 'foot'", "[shape.foot]\nmesh = 'order3'\n")),
              AllOf(HasSubstr("shape.foot.mesh"), HasSubstr("order2")));
  EXPECT_THAT(message(on_bottom("gap = 0, shape = 'foot'", shape_table + "translate = [0, 1]\n")),
              HasSubstr("shape.foot.translate: moves the surface of the body itself"));
  EXPECT_THAT(message(on_bottom("gap = 0, shape = 'foot'", shape_table + "side = 'front'\n")),
              HasSubstr("shape.foot.side: stands beside another surface"));
  EXPECT_THAT(message(on_bottom("gap = 0, shape = 'foot'",
                                shape_table + "circle = { centre = [0, 0], radius = 1 }\n")),
              HasSubstr("stands beside another surface"));
  EXPECT_THAT(message(on_bottom("obstacle = 'o'", "[obstacle.o]\nmesh = 'order2'\n")),
              HasSubstr("obstacle.o.mesh: unknown key"));
  EXPECT_THAT(message("boundary.top.contact = { gap = 0, shape = 'foot' }\n" + shape_table),
              HasSubstr("shape.foot.mesh: the boundary has no facets of second order"));
  EXPECT_THAT(message(on_bottom("obstacle = 'o', shape = 'foot'",
                                shape_table + "[obstacle.o]\nsphere = { centre = [0, 0, 0], radius = 1 }\n")),
              HasSubstr("a sphere in a 2D case"));
  EXPECT_THAT(message(pair_of("shape = { master = 'foot' }\n", shape_table), 1),
              HasSubstr("shape.foot.mesh: the mesh has no second-order facets"));
  EXPECT_THAT(message("[[contact]]\nslave = 'bottom'\nmaster = 'right2'\nshape = { master = 'foot' }\n" +
                      shape_table),
              HasSubstr("shape.foot.mesh: the boundary has no facets of second order"));
}

}  // namespace
}  // namespace tribound::quadratic_geometry_cases
