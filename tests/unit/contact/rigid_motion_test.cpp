/// @file rigid_motion_test.cpp
/// Which cases are held, and the words for the motions of those that are not.

#include "contact/rigid_motion.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "contact/rigid_modes.h"
#include "support/discrete_case.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string material = "degree = 1\nmaterial = { E = 1, nu = 0.3 }\n";

/// What check_rigid_motions says about the case, or "held".
template <int dim>
std::string verdict(const MeshData<dim>& mesh, const std::string& toml)
{
  const DiscreteCase<dim> c(material + toml, mesh);
  try
  {
    check_rigid_motions<dim>(c.problem, c.space, c.form.data(), c.form.load());
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "held";
}

MeshData<2> block()
{
  return box<2>({0, 0}, {2, 1}, {4, 2});
}

MeshData<3> brick()
{
  return box<3>({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
}

/// A block on a slope of the given angle: its bottom is inclined, gravity points down.
MeshData<2> on_slope(double angle)
{
  const Eigen::Rotation2Dd turn(angle);
  return mapped<2>(block(), [&](const Point<2>& x) -> Point<2> { return turn * x; });
}

MeshData<3> brick_on_slope(double angle)
{
  const auto turn = Eigen::AngleAxisd(angle, Point<3>(0, -1, 0)).toRotationMatrix();
  return mapped<3>(brick(), [&](const Point<3>& x) -> Point<3> { return turn * x; });
}

TEST(RigidMotion, FreeBodyHasAllMotions)
{
  EXPECT_THAT(verdict<2>(block(), "boundary.top.traction = [0, 1]"),
              HasSubstr("boundary: nothing stops the body (region \"box\") from: translation along x; "
                        "translation along y; rotation about (1, 0.5)"));
  EXPECT_THAT(verdict<3>(brick(), ""),
              HasSubstr("translation along x; translation along y; translation along z; rotation about the "
                        "axis through (1, 0.5, 0.5) along (1, 0, 0); rotation about "
                        "the axis through (1, 0.5, 0.5) along (0, 1, 0); rotation about the axis through "
                        "(1, 0.5, 0.5) along (0, 0, 1)"));
}

TEST(RigidMotion, ClampedBodyIsHeldWhateverTheLoad)
{
  EXPECT_EQ(verdict<2>(block(), "boundary.left.displacement = [0, 0]\nboundary.top.traction = [3, 1]"),
            "held");
  EXPECT_EQ(verdict<3>(brick(), "boundary.left.displacement = [0, 0, 0]\nload.body = [1, 1, 1]"), "held");
}

TEST(RigidMotion, RollerLeavesTheMotionAlongIt)
{
  const std::string said = verdict<2>(block(), "boundary.bottom.displacement = [\"free\", 0]");
  EXPECT_THAT(said, AllOf(HasSubstr("from: translation along x\n"), HasSubstr("hint: fix")));
  EXPECT_THAT(said, Not(HasSubstr("friction")));
  EXPECT_THAT(verdict<3>(brick(), "boundary.bottom.displacement = [\"free\", 0, \"free\"]"),
              HasSubstr("from: translation along x; translation along z; rotation about the "
                        "axis through (1, 0.5, 0.5) along (0, 1, 0)\n"));
}

TEST(RigidMotion, SlidersThroughAPointLeaveTheRotationAboutIt)
{
  EXPECT_THAT(verdict<2>(block(),
                         "boundary.bottom.displacement = [0, \"free\"]\n"
                         "boundary.left.displacement = [\"free\", 0]"),
              HasSubstr("from: rotation about (0, 0)\n"));
  EXPECT_THAT(verdict<3>(brick(),
                         "boundary.bottom.displacement = [0, \"free\", \"free\"]\n"
                         "boundary.left.displacement = [\"free\", 0, \"free\"]\n"
                         "boundary.front.displacement = [\"free\", \"free\", 0]"),
              HasSubstr("from: rotation about the axis through (0, 0, 0.5) along (0, 0, 1)\n"));
}

/// A component normal to a side without load, each named once.
TEST(RigidMotion, NamesAComponentThatWouldStopTheMotion)
{
  EXPECT_THAT(verdict<2>(block(), "boundary.left.traction = [1, 0]\nboundary.top.traction = [0, 1]"),
              HasSubstr("change, for example x on boundary \"right\", y on boundary \"bottom\" (symmetry:"));
  EXPECT_THAT(verdict<3>(brick(), "boundary.bottom.displacement = [0, 0, \"free\"]"),
              HasSubstr("for example z on boundary \"back\" (symmetry:"));
}

TEST(RigidMotion, WordsForAScrew)
{
  const RigidModes<3> modes{.centre = {0, 0, 0}, .size = 2};
  RigidModes<3>::Coefficients motion;
  motion << 1, 0, 3, 0, 0, 1;  // about the vertical axis where its horizontal part vanishes, at y = 2
  EXPECT_EQ(modes.describe(motion), "screw motion about the axis through (0, 2, 0) along (0, 0, 1)");
}

TEST(RigidMotion, RollersOnTwoPlanesLeaveTheirCommonDirection)
{
  EXPECT_EQ(verdict<2>(block(),
                       "boundary.bottom.displacement = [\"free\", 0]\n"
                       "boundary.left.displacement = [0, \"free\"]"),
            "held");
  EXPECT_THAT(verdict<3>(brick(),
                         "boundary.left.displacement = [0, \"free\", \"free\"]\n"
                         "boundary.bottom.displacement = [\"free\", 0, \"free\"]"),
              HasSubstr("from: translation along z\n"));
}

TEST(RigidMotion, BodiesAreLookedAtOneByOne)
{
  const MeshData<2> two = side_by_side(block(), box<2>({5, 0}, {6, 2}, {1, 2}), "2");
  const std::string said = verdict<2>(two,
                                      "boundary.left.displacement = [0, 0]\nboundary.bottom2.displacement = "
                                      "[\"free\", 0]\nboundary.right2.displacement = [\"free\", 0]");
  EXPECT_THAT(said, HasSubstr("nothing stops the body around (5.5, 1) (region \"box2\") from: translation "
                              "along x\n"));
}

TEST(RigidMotion, TwoRegionsOfOneBodyAreNamedTogether)
{
  MeshData<2> data = block();
  data.region_names = {"steel", "rubber"};
  data.regions.back() = 1;
  EXPECT_THAT(verdict<2>(data, ""), HasSubstr("the body (regions \"steel\", \"rubber\")"));
}

TEST(RigidMotion, FrictionlessFloorLeavesTheMotionAlongIt)
{
  const std::string down = "boundary.top.traction = [0, -1]\n";
  const std::string said = verdict<2>(block(), down + "boundary.bottom.contact = { friction = \"none\" }");
  EXPECT_THAT(said, AllOf(HasSubstr("from: translation along x\n"), HasSubstr("or give its contact")));
  for (const std::string zero : {"\"coulomb\", coefficient = 0", "\"tresca\", threshold = 0"})
    EXPECT_EQ(verdict<2>(block(), down + "boundary.bottom.contact = { friction = " + zero + " }"), said);
  EXPECT_THAT(verdict<2>(on_slope(0.5), down + "boundary.bottom.contact = { friction = \"none\" }"),
              HasSubstr("from: translation along (0.8776, 0.4794)\n"));
}

TEST(RigidMotion, BlockOnFloorWithFrictionIsHeld)
{
  EXPECT_EQ(verdict<2>(block(),
                       "boundary.top.traction = [0, -1]\n"
                       "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.2 }"),
            "held");
  EXPECT_EQ(verdict<3>(brick(),
                       "boundary.top.traction = [0.1, -1, 0.1]\n"
                       "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.2 }"),
            "held");
}

TEST(RigidMotion, BalancedOrAbsentLoadsNeedNoContactForce)
{
  const std::string floor = "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.2 }\n";
  EXPECT_EQ(verdict<2>(block(), floor), "held");
  EXPECT_EQ(verdict<2>(block(), floor + "boundary.left.traction = [-0.3, 0]\nboundary.right.traction = [0.3, "
                                        "0]"),
            "held");
}

TEST(RigidMotion, BlockPulledOffTheFloor)
{
  const std::string said =
      verdict<2>(block(),
                 "boundary.top.traction = [0, 1]\n"
                 "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.2 }");
  EXPECT_THAT(said, HasSubstr("boundary.bottom: contact cannot hold the body (region \"box\"): the loads "
                              "drive it into translation along y; contact only pushes"));
  EXPECT_THAT(verdict<3>(brick(),
                         "boundary.top.traction = [0, 1, 0]\n"
                         "boundary.bottom.contact = { friction = \"tresca\", threshold = 9 }"),
              HasSubstr("drive it into translation along y"));
}

TEST(RigidMotion, BlockTippedOverItsEdge)
{
  // down 2 in the middle of [0, 2], up at the right end: the resultant acts left of the block
  const std::string said =
      verdict<2>(block(),
                 "boundary.top.traction = [0, -1]\nboundary.right.traction = [0, 1.5]\n"
                 "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 5 }");
  EXPECT_THAT(said, HasSubstr("drive it into rotation about (0, 0)"));
}

TEST(RigidMotion, BlockPushedHighTipsBeforeItSlides)
{
  // A side load on top of a block of weight 2, 2 wide and 1 high, tips it from 2 on, and makes it slide from
  // 4 on.
  const auto pushed = [](const std::string& load)
  {
    return verdict<2>(block(), "load.body = [0, -1]\nboundary.top.traction = [" + load +
                                   ", 0]\n"
                                   "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 2 }");
  };
  EXPECT_EQ(pushed("0.999"), "held");
  EXPECT_THAT(pushed("1.001"), HasSubstr("drive it into rotation about (2, 0); contact only pushes"));
}

std::string on_floor(double coefficient)
{
  return "load.body = [0, -1]\nboundary.bottom.contact = { friction = \"coulomb\", coefficient = " +
         std::to_string(coefficient) + " }";
}

TEST(RigidMotion, CoulombHoldsUpToTheFrictionAngle)
{
  const double angle = 0.3;
  EXPECT_EQ(verdict<2>(on_slope(angle), on_floor(std::tan(angle) * 1.001)), "held");
  EXPECT_THAT(verdict<2>(on_slope(angle), on_floor(std::tan(angle) * 0.999)),
              HasSubstr("drive it into translation along (-0.9553, -0.2955); friction is too weak"));
}

TEST(RigidMotion, CoulombConeIn3DIsCircumscribed)
{
  const auto slope = [](double angle, double coefficient)
  {
    return verdict<3>(brick_on_slope(angle),
                      "load.body = [0, 0, -1]\nboundary.back.contact = { friction = \"coulomb\", coefficient "
                      "= " +
                          std::to_string(coefficient) + " }");
  };
  const double angle = 0.3;
  EXPECT_EQ(slope(angle, std::tan(angle) * 1.001), "held");
  EXPECT_THAT(slope(angle, std::tan(angle) * 0.9), HasSubstr("friction is too weak"));
}

TEST(RigidMotion, CoulombIn3DRefusesNothingThatTheRoundConeHolds)
{
  constexpr double coefficient = 0.5;
  for (int i = 0; i < 16; ++i)
  {
    const double side = 0.999 * coefficient;
    const double angle = i * std::numbers::pi / 8;
    EXPECT_EQ(
        verdict<3>(brick(), "load.body = [" + std::to_string(side * std::cos(angle)) + ", -1, " +
                                std::to_string(side * std::sin(angle)) +
                                "]\nboundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.5 }"),
        "held")
        << "direction " << i;
  }
}

TEST(RigidMotion, TrescaThresholdTooSmallForTheSideLoad)
{
  // 0.1 on the right side of length 1 against s on the bottom of length 2
  const auto pushed = [](const std::string& threshold)
  {
    return verdict<2>(block(),
                      "boundary.top.traction = [0, -1]\nboundary.right.traction = [-0.1, 0]\n"
                      "boundary.bottom.contact = { friction = \"tresca\", threshold = " +
                          threshold + " }");
  };
  EXPECT_EQ(pushed("0.0501"), "held");
  EXPECT_EQ(pushed("\"0.0502*x\""), "held");
  EXPECT_THAT(pushed("0.0499"),
              HasSubstr("translation along -x; the friction threshold takes up only 99.8 % of"));
  EXPECT_THAT(pushed("0.025"), HasSubstr("translation along -x; the friction threshold takes up "
                                         "only 50 % of their work in it"));
}

/// Strips of friction between the points of the rule hold as much as their width makes of them.
TEST(RigidMotion, TrescaOnANarrowStripCounts)
{
  const auto pulled = [](const std::string& from, double threshold)
  {
    return verdict<2>(box<2>({0, 0}, {1, 1}, {1, 1}),
                      "boundary.top.traction = [0, -1]\nboundary.right.traction = [1, 0]\n"
                      "boundary.bottom.contact = { friction = \"tresca\", threshold = \"x > " +
                          from + " && x < " + from + " + 0.07 ? " + std::to_string(threshold) + " : 0\" }");
  };
  for (const std::string from : {"0.34", "0.08", "0.6"})
  {
    EXPECT_EQ(pulled(from, 100), "held");
    EXPECT_EQ(pulled(from, 1.001 / 0.07), "held");
    EXPECT_THAT(pulled(from, 0.999 / 0.07), HasSubstr("takes up only 99.9 % of their work"));
  }
}

TEST(RigidMotion, TrescaBelowARollerThatTakesTheNormalForces)
{
  const auto pushed = [](const std::string& threshold)
  {
    return verdict<2>(block(),
                      "boundary.top.displacement = [\"free\", 0]\nboundary.right.traction = [-0.1, 0]\n"
                      "boundary.bottom.contact = { friction = \"tresca\", threshold = " +
                          threshold + " }");
  };
  EXPECT_EQ(pushed("0.0501"), "held");
  EXPECT_THAT(pushed("0.0499"), HasSubstr("drive it into translation along -x"));
}

TEST(RigidMotion, TrescaIn3DAgainstTheDirectionOfTheLoad)
{
  // resultant 0.1 (1, 0, 1) and its moments against s on an area of 2
  const auto pushed = [](const std::string& threshold)
  {
    return verdict<3>(brick(),
                      "load.body = [0.05, -1, 0.05]\n"
                      "boundary.bottom.contact = { friction = \"tresca\", threshold = " +
                          threshold + " }");
  };
  EXPECT_EQ(pushed("0.0708"), "held");
  EXPECT_THAT(pushed("0.0706"), HasSubstr("translation along (0.7071, 0, 0.7071)"));
}

/// The body can only move along x, off its inclined floor, and only Tresca friction resists that.
TEST(RigidMotion, TrescaTooWeakAgainstAPullOffTheFloor)
{
  const double angle = 0.3;
  const auto pulled = [&](double threshold)
  {
    return verdict<2>(on_slope(angle),
                      "load.body = [-0.1, 0]\nboundary.top.displacement = [\"free\", 0]\n"
                      "boundary.bottom.contact = { friction = \"tresca\", threshold = " +
                          std::to_string(threshold) + " }");
  };
  EXPECT_EQ(pulled(0.1001 / std::cos(angle)), "held");
  EXPECT_THAT(pulled(0.0999 / std::cos(angle)),
              HasSubstr("translation along -x; the friction threshold takes up only 99.9 % of"));
  EXPECT_THAT(pulled(0.003), HasSubstr("takes up only 2.87 % of"));
}

/// The box with a condition on each side, turned, so that no side is parallel to an axis.
template <int dim>
struct RandomCase
{
  std::mt19937 random;
  double pick(double from, double to) { return std::uniform_real_distribution<>(from, to)(random); }

  std::string side()
  {
    switch (random() % 5)
    {
      case 0:
        return "contact = {}";
      case 1:
        return fmt::format("contact = {{ friction = \"tresca\", threshold = {} }}", pick(0, 1));
      case 2:
        return fmt::format("contact = {{ friction = \"tresca\", threshold = \"x > {} ? 0.2 : {}*x^2\" }}",
                           pick(0, 2), pick(0, 1));
      case 3:
        return fmt::format("contact = {{ friction = \"coulomb\", coefficient = {} }}", pick(0, 1));
      default:
        return dim == 2 ? "traction = [0, 0]" : "traction = [0, 0, 0]";
    }
  }

  std::string boundaries()
  {
    std::string toml;
    std::vector<std::string> names = {"left", "right", "bottom", "top"};
    if (dim == 3) names.insert(names.end(), {"back", "front"});
    for (const std::string& name : names) toml += fmt::format("boundary.{} = {{ {} }}\n", name, side());
    return toml;
  }

  MeshData<dim> mesh()
  {
    Tensor<dim> turn = Tensor<dim>::Identity();
    const double angle = pick(0, 6.28);
    turn.topLeftCorner(2, 2) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    if constexpr (dim == 2)
      return mapped<2>(block(), [&](const Point<2>& x) -> Point<2> { return turn * x; });
    else
      return mapped<3>(brick(), [&](const Point<3>& x) -> Point<3> { return turn * x; });
  }

  /// A traction that contact can exert, often one of the largest.
  Point<dim> traction(const ContactFacet<dim>& facet, const Point<dim>& x)
  {
    const Point<dim>& n = facet.geometry.normal;
    const double pressure = random() % 2 == 0 ? 0 : std::pow(pick(0, 1), 4);
    double limit = 0;
    if (const auto* tresca = std::get_if<Tresca>(&facet.contact->friction)) limit = tresca->threshold(x);
    if (const auto* coulomb = std::get_if<Coulomb>(&facet.contact->friction))
      limit = coulomb->coefficient * pressure;
    const Point<dim> any = Point<dim>::Random();
    const Point<dim> direction = (any - any.dot(n) * n).normalized();
    return -pressure * n + (random() % 2 == 0 ? limit : pick(0, limit)) * direction;
  }
};

bool refused(const std::string& verdict)
{
  return verdict.find("contact cannot hold") != std::string::npos;
}

/// Loads that are in equilibrium with tractions which the contact laws allow are never refused.
template <int dim>
void never_refused(int n_cases)
{
  int tried = 0;
  for (int i = 0; i < n_cases; ++i)
  {
    RandomCase<dim> any{std::mt19937(i)};
    const DiscreteCase<dim> c(material + any.boundaries(), any.mesh());
    // On a third of the cases all friction pulls in one direction as hard as it can.
    const Point<dim> pull = Point<dim>::Random();
    std::vector<Point<dim>> t;
    for (const ContactFacet<dim>& facet : c.form.contact_facets())
      for (const Point<dim - 1>& s : c.form.facet_rule().points)
      {
        t.push_back(any.traction(
            facet, cell_map(c.mesh, facet.facet.cell)(facet_to_cell<dim>(facet.facet.local, s))));
        const Point<dim>& n = facet.geometry.normal;
        const Point<dim> along = pull - pull.dot(n) * n;
        const Point<dim> friction = t.back() - t.back().dot(n) * n;
        if (i % 3 == 0) t.back() += friction.norm() * along.normalized() - friction;
      }
    std::vector<double> load(c.space.n_dofs(), 0.0);
    c.form.add_contact_load(t, load);
    for (double& entry : load) entry = -entry;
    std::string said = "held";
    try
    {
      check_rigid_motions<dim>(c.problem, c.space, c.form.data(), load);
      ++tried;
    }
    catch (const InputError& error)
    {
      said = error.what();
    }
    EXPECT_FALSE(refused(said)) << "case " << i << ": " << said;
  }
  EXPECT_GT(tried, n_cases / 2) << "most cases leave a motion free";
  fmt::print("{}D: {} cases with a solution, all held\n", dim, tried);
}

TEST(RigidMotion, RefusesNothingThatHasASolution)
{
  never_refused<2>(500);
  never_refused<3>(100);
}

/// An L of three squares, foot to the right; frictionless obstacles around it.
MeshData<2> hook()
{
  MeshData<2> data = box<2>({0, 0}, {2, 2}, {2, 2});
  std::erase_if(data.cells,
                [&](const Cell<2>& cell)
                {
                  Point<2> middle = Point<2>::Zero();
                  for (const Index v : cell) middle += data.vertices[v] / 3;
                  return middle[0] > 1 && middle[1] > 1;
                });
  data.regions.resize(data.cells.size());
  data.vertices.pop_back();  // (2, 2)
  std::erase_if(data.facets,
                [](const TaggedFacet<2>& f) { return f.vertices[0] == 8 || f.vertices[1] == 8; });
  data.boundary_names.insert(data.boundary_names.end(), {"step", "notch"});
  data.facets.push_back({{4, 5}, 4});  // (1, 1)-(2, 1)
  data.facets.push_back({{4, 7}, 5});  // (1, 1)-(1, 2)
  return data;
}

TEST(RigidMotion, HookIsHeldByGeometryAlone)
{
  const std::string smooth = ".contact = { friction = \"none\" }\n";
  const std::string inside = "boundary.step" + smooth + "boundary.notch" + smooth;
  EXPECT_EQ(verdict<2>(hook(), inside + "boundary.bottom.traction = [0, 1]"
                                        "\nboundary.left.traction = [1, 0]"),
            "held");
  EXPECT_THAT(
      verdict<2>(hook(), inside + "boundary.bottom.traction = [0, 1]\nboundary.left.traction = [-1, 0]"),
      HasSubstr("contact cannot hold the body"));
  // A foot on the floor and its upper side under a ledge: two-sided, holds up and down and against turning.
  EXPECT_EQ(verdict<2>(hook(), "boundary.bottom" + smooth + "boundary.step" + smooth +
                                   "boundary.left.displacement = [0, \"free\"]\nload.body = [0, 1]"),
            "held");
}

}  // namespace

}  // namespace tribound::test
