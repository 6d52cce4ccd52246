/// Loads of decks: what their keywords, steps and amplitudes become.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "support/input_error.h"
#include "tribound/case/deck/course.h"
#include "tribound/case/deck/nodal_forces.h"
#include "tribound/problem/formula.h"
#include "unit/case/import_deck.h"

namespace tribound
{

namespace
{

using case_file::ImportedDeck;
using test::ImportDeck;
using test::message_of;
using test::two_cubes;
using testing::HasSubstr;

TEST_F(ImportDeck, SpreadsNodalForces)
{
  const case_file::Config exact = config_of(import("", "*CLOAD\ntop, 3, -2.\n"));
  EXPECT_NEAR(value(boundary(exact, "top").traction[2], 1), -8, 1e-12);
  EXPECT_EQ(value(boundary(exact, "top").traction[0], 1), 0);

  // The lines of a step add up, also where nodes are given one by one.
  const ImportedDeck uneven =
      import("", "*CLOAD\n15, 3, -1.\n16, 3, -2.\n17, 3, -1.\n18, 3, -1.5\n18, 3, -.5\n");
  const case_file::Config spread = config_of(uneven);
  EXPECT_NEAR(value(spread.boundaries.back().traction[2], 1), -6, 1e-12);
  EXPECT_THAT(spread.not_covered, testing::Contains(HasSubstr("spread evenly")));

  const char* couple = "*CLOAD\n15, 3, 1.\n16, 3, -1.\n17, 3, -1.\n18, 3, 1.\n";
  EXPECT_THAT(message_of([&] { return import("", couple); }),
              HasSubstr("their moment, or what cancels, is lost"));

  const auto alone = [&] { return import("", "*CLOAD\n15, 3, -1.\n"); };
  EXPECT_THAT(message_of(alone), HasSubstr("forces at single nodes, such as node 15"));
  EXPECT_THAT(message_of(alone), HasSubstr("deck.inp:56: *CLOAD"));
  EXPECT_NO_THROW(static_cast<void>(import("", "*CLOAD\n15, 3, -1.\n", {"CLOAD"})));
}

TEST_F(ImportDeck, CutsSetsThatOverlap)
{
  const case_file::Config config = config_of(import("", "*DSLOAD\ncrown, P, 1.\n*CLOAD\ntop, 3, -1.\n"));
  EXPECT_EQ(value(*boundary(config, "crown").pressure, 1), 1);
  EXPECT_NEAR(value(boundary(config, "crown").traction[2], 1), -4, 1e-12);
}

TEST_F(ImportDeck, FollowsSteps)
{
  const std::string steps = R"(*AMPLITUDE, NAME=wave
0., 0., .5, 1., 1., -1.
*STEP
*STATIC
.25, 1.
*DSLOAD
crown, P, 4.
*END STEP
*STEP
*STATIC
.5, 2.
*CLOAD, AMPLITUDE=wave
top, 1, 1.
*END STEP
)";
  const case_file::Config config = config_of(import(std::string(two_cubes) + steps));
  ASSERT_TRUE(config.history);
  const problem::Field& pressure = *boundary(config, "crown").pressure;
  for (const auto& [t, p] : std::map<double, double>{{0.25, 1}, {0.5, 2}, {1, 4}, {2, 4}, {3, 4}})
    EXPECT_NEAR(value(pressure, t), p, 1e-14);
  const problem::Field& shear = boundary(config, "crown").traction[0];
  for (const auto& [t, s] :
       std::map<double, double>{{0.5, 0}, {1, 0}, {1.25, 2}, {1.5, 4}, {1.75, 0}, {2, -4}, {3, -4}})
    EXPECT_NEAR(value(shear, t), s, 1e-12) << t;
  EXPECT_THAT(config.history->program.targets, testing::ElementsAre(0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3));
}

/// The two cubes with these steps, each of length 1.
std::string with_steps(std::initializer_list<const char*> steps)
{
  std::string text(two_cubes);
  for (const char* step : steps) text += fmt::format("*STEP\n*STATIC\n1., 1.\n{}*END STEP\n", step);
  return text;
}

TEST_F(ImportDeck, LoadsEndAndBeginAgain)
{
  const auto pressure_at = [&](const std::string& deck, double t)
  { return value(*boundary(config_of(import(deck)), "crown").pressure, t); };
  const char* first = "*DSLOAD\ncrown, P, 10.\n";
  const std::string ended = with_steps({first, "*DSLOAD, OP=NEW\n", ""});
  EXPECT_NEAR(pressure_at(ended, 1), 10, 1e-14);
  EXPECT_NEAR(pressure_at(ended, 2), 0, 1e-14);
  EXPECT_NEAR(pressure_at(ended, 3), 0, 1e-14);
  const std::string again = with_steps({first, "*DSLOAD, OP=NEW\n", "*DSLOAD\ncrown, P, 4.\n"});
  EXPECT_NEAR(pressure_at(again, 3), 4, 1e-14);
  EXPECT_NEAR(pressure_at(with_steps({"*DSLOAD\ncrown, P, 10.\ncrown, P, 1.\n", ""}), 2), 11, 1e-14);

  // Every list of loads is renewed by itself.
  const std::string renewed = with_steps(
      {"*BOUNDARY, OP=NEW\n*BOUNDARY\nbase, 1, 3\n*DSLOAD, OP=NEW\n*DSLOAD\ncrown, P, 3.\n*CLOAD, OP=NEW\n"});
  EXPECT_EQ(pressure_at(renewed, 1), 3);

  const case_file::Config zero =
      config_of(import(with_steps({"*CLOAD\ntop, 1, 5.\n", "*CLOAD\ntop, 1, 0.\n"})));
  EXPECT_NEAR(value(boundary(zero, "top").traction[0], 1), 20, 1e-12);
  EXPECT_NEAR(value(boundary(zero, "top").traction[0], 2), 0, 1e-12);

  const std::string early =
      "*AMPLITUDE, NAME=half\n0., 0., 1., .5\n*BOUNDARY, AMPLITUDE=half\ntop, 3, 3, .01\n";
  const case_file::Config before = config_of(import(early, ""));
  EXPECT_NEAR(value(*boundary(before, "top").displacement[2], 1), 0.005, 1e-15);
}

TEST_F(ImportDeck, TakesWeightRotationAndTemperature)
{
  const case_file::Config config = config_of(
      import("*NSET, NSET=all\n1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18\n*INITIAL CONDITIONS, "
             "TYPE=TEMPERATURE\nall, 20.\n",
             "*DLOAD\nlower, GRAV, 9810., 0., 0., -2.\nupper, CENTRIF, 100., 1., 0., 0., 0., 0., "
             "3.\n*TEMPERATURE\nall, "
             "120.\n"));
  ASSERT_EQ(config.loads.size(), 2U);
  const case_file::LoadConfig& lower = config.loads[0];
  const case_file::LoadConfig& upper = config.loads[1];
  EXPECT_NEAR(value(lower.body[2], 1), -7.8e-9 * 9810, 1e-18);
  const Point<3> x(3, 5, 7);
  EXPECT_NEAR(value(upper.body[0], 1, x), 7.8e-9 * 100 * 2, 1e-18);
  EXPECT_NEAR(value(upper.body[1], 1, x), 7.8e-9 * 100 * 5, 1e-18);
  EXPECT_EQ(value(upper.body[2], 1, x), 0);
  EXPECT_EQ(value(*lower.temperature, 1), 120);
  EXPECT_EQ(value(lower.reference_temperature, 1), 20);

  // Only the direction of the weight counts; of two temperatures of a node the last one does.
  const case_file::Config twice =
      config_of(import("*NSET, NSET=all, GENERATE\n1, 18\n*NSET, NSET=high, GENERATE\n11, 18\n",
                       "*DLOAD\nlower, GRAV, 10., 0., 0., -1.\nlower, GRAV, 20., 0., 0., "
                       "-2.\n*TEMPERATURE\nall, 20.\nhigh, 100.\n"));
  EXPECT_NEAR(value(twice.loads[0].body[2], 1), -7.8e-9 * 30, 1e-18);
  EXPECT_EQ(value(*twice.loads[0].temperature, 1), 20);
  EXPECT_EQ(value(*twice.loads[1].temperature, 1), 100);
}

/// The function of time that a deck means, point by point.
double interpolate(const std::vector<case_file::Course::Point>& points, double t)
{
  for (std::size_t i = 1; i < points.size(); ++i)
    if (t <= points[i].t && points[i].t > points[i - 1].t)
      return points[i - 1].value + (points[i].value - points[i - 1].value) * (t - points[i - 1].t) /
                                       (points[i].t - points[i - 1].t);
  return points.back().value;
}

double value_of(const std::string& formula, double t)
{
  return problem::Formula(formula, {}, t)({});
}

TEST(Course, IsItsFormula)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<> value(-3, 3);
  for (int trial = 0; trial < 300; ++trial)
  {
    case_file::Course course;
    std::vector<case_file::Course::Point> points;
    double t = 0;
    for (int i = 0; i < 2 + trial % 7; ++i)
    {
      points.push_back({t, random() % 4 == 0 && !points.empty() ? points.back().value : value(random)});
      course.add(points.back().t, points.back().value);
      if (random() % 5 != 0) t += 0.25 * static_cast<double>(1 + random() % 4);
    }
    if (points.back().t == 0) continue;
    const double factor = value(random);
    const case_file::Node datum = course.datum(factor, false);
    for (int k = 0; k < 20; ++k)
    {
      const double at = points.back().t * (k + 0.5) / 20;
      const auto* number = std::get_if<double>(&datum.value);
      const double found = number != nullptr ? *number : value_of(std::get<std::string>(datum.value), at);
      EXPECT_NEAR(found, factor * interpolate(points, at), 1e-12)
          << (number != nullptr ? std::string("a number") : std::get<std::string>(datum.value)) << " at "
          << at;
    }
  }
}

/// A plane element with corners at random, and what a uniform load is at its nodes by the textbook.
TEST(NodalForces, OfUniformTractionsAreRecognised)
{
  using mesh::Shape;
  struct Textbook
  {
    mesh::ElementType cell;
    mesh::ElementType face;
    double corner;
    double middle;
  };
  const Textbook books[] = {{{Shape::tetrahedron, 4}, {Shape::triangle, 3}, 1. / 3, 0},
                            {{Shape::tetrahedron, 10}, {Shape::triangle, 6}, 0, 1. / 3},
                            {{Shape::hexahedron, 8}, {Shape::quadrilateral, 4}, 1. / 4, 0},
                            {{Shape::hexahedron, 20}, {Shape::quadrilateral, 8}, -1. / 12, 1. / 3},
                            {{Shape::hexahedron, 27}, {Shape::quadrilateral, 9}, 1. / 36, 1. / 9}};
  std::mt19937 random(3);
  std::uniform_real_distribution<> value(-1, 1);
  for (const Textbook& book : books)
  {
    const mesh::ShapeTable& table = mesh::table_of(book.cell.shape);
    // Corners of the reference cell, moved by an affine map: faces are triangles or parallelograms.
    const std::vector<Point<3>> corners =
        book.cell.shape == Shape::tetrahedron
            ? std::vector<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
            : std::vector<Point<3>>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 9; ++i) map(i / 3, i % 3) += 0.3 * value(random);
    mesh::ImportedMesh mesh;
    for (const Point<3>& x : corners) mesh.nodes.emplace_back(map * x);
    for (int e = 0; e < table.n_edges && mesh::has_middles(book.cell); ++e)
      mesh.nodes.emplace_back((mesh.nodes[table.edges[e][0]] + mesh.nodes[table.edges[e][1]]) / 2);
    for (int f = 0; f < table.n_faces && book.cell.n_nodes == 27; ++f)
      mesh.nodes.emplace_back(
          (mesh.nodes[table.faces[f].corners[0]] + mesh.nodes[table.faces[f].corners[2]]) / 2);
    while (static_cast<int>(mesh.nodes.size()) < book.cell.n_nodes)
      mesh.nodes.emplace_back((mesh.nodes[0] + mesh.nodes[6]) / 2);
    mesh::ElementBlock block{book.cell};
    for (int i = 0; i < book.cell.n_nodes; ++i) block.nodes.push_back(i);
    block.numbers = {1};
    mesh.cells = {block};

    const case_file::DeckFaces faces(mesh);
    const Index face = 1;
    const mesh::FaceNodes nodes = faces.nodes(face);
    ASSERT_EQ(nodes.type, book.face);
    const int n_corners = mesh::table_of(book.face.shape).n_corners;
    const Point<3> a = mesh.nodes[nodes.nodes[1]] - mesh.nodes[nodes.nodes[0]];
    const Point<3> b = mesh.nodes[nodes.nodes[n_corners - 1]] - mesh.nodes[nodes.nodes[0]];
    const double area = a.cross(b).norm() / (n_corners == 3 ? 2 : 1);
    const Point<3> traction(value(random), value(random), value(random));
    std::map<Index, Point<3>> forces;
    for (int i = 0; i < nodes.type.n_nodes; ++i)
    {
      const double weight = i < n_corners ? book.corner : i < 8 ? book.middle : 4. / 9;
      if (weight != 0) forces[nodes.nodes[i]] = weight * area * traction;
    }
    const case_file::SpreadForces found = case_file::spread(faces, forces);
    ASSERT_EQ(found.parts.size(), 1U);
    EXPECT_TRUE(found.lone_nodes.empty());
    EXPECT_TRUE(found.parts[0].is_exact);
    EXPECT_NEAR(found.parts[0].area, area, 1e-13);
    EXPECT_LT((found.parts[0].traction - traction).norm(), 1e-12);

    forces.begin()->second *= 1.1;
    EXPECT_FALSE(case_file::spread(faces, forces).parts[0].is_exact);
  }
}

}  // namespace

}  // namespace tribound
