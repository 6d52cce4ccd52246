/// @file contact_facts_test.cpp
/// Normals, kinks and gaps of contact boundaries of known shape.

#include "tribound/doctor/contact_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

using ::testing::ElementsAre;
using ::testing::SizeIs;

constexpr double degree = std::numbers::pi / 180;

TEST(ContactFacts, FlatBoundaryWithAGap)
{
  const DiscreteProblem<2> c(
      box<2>({-1, 0}, {2, 1}, {6, 1}),
      {.boundaries = {clamped<2>("top"), obstacle<2>("bottom", Frictionless(), formula("0.1*x^2"))}});
  const auto facts = doctor::contact_boundary_facts(c.form);
  ASSERT_THAT(facts, SizeIs(1));
  EXPECT_EQ(facts[0].name, "bottom");
  EXPECT_EQ(facts[0].facets, 6);
  EXPECT_NEAR(facts[0].measure, 3, 1e-14);
  EXPECT_THAT(facts[0].normal, ElementsAre(0, -1));
  EXPECT_NEAR(facts[0].spread, 0, 1e-12);
  EXPECT_NEAR(facts[0].kink, 0, 1e-12);
  // The outermost points of the rule lie a little inside the facets, which end at 0 and at 2.
  EXPECT_LT(facts[0].smallest_gap, 0.1 * 0.05 * 0.05);
  EXPECT_NEAR(facts[0].smallest_gap_at[0], 0, 0.05);
  EXPECT_NEAR(facts[0].largest_gap, 0.1 * std::pow(facts[0].largest_gap_at[0], 2), 1e-15);
  EXPECT_NEAR(facts[0].largest_gap_at[0], 2, 0.05);
}

/// The bottom of a strip bent to a circle of radius 10, with six facets of one degree each.
TEST(ContactFacts, PolygonHasEqualKinks)
{
  const auto bend = [](const Point<2>& x) -> Point<2> {
    return {(10 - x[1]) * std::sin(x[0] * degree), 10 - (10 - x[1]) * std::cos(x[0] * degree)};
  };
  const DiscreteProblem<2> c(mapped<2>(box<2>({-3, 0}, {3, 1}, {6, 1}), bend),
                             {.boundaries = {clamped<2>("top"), obstacle<2>("bottom")}});
  const auto facts = doctor::contact_boundary_facts(c.form);
  ASSERT_THAT(facts, SizeIs(1));
  EXPECT_NEAR(facts[0].kink, 1, 1e-10);
  EXPECT_NEAR(facts[0].spread, 2.5, 1e-10);
  EXPECT_NEAR(facts[0].normal[0], 0, 1e-12);
  EXPECT_NEAR(facts[0].normal[1], -1, 1e-12);
}

TEST(ContactFacts, CornersOfTheBodyAreNoKinks)
{
  mesh::MeshData<2> mesh = box<2>({0, 0}, {1, 1}, {2, 2});
  for (mesh::TaggedFacet<2>& facet : mesh.facets)
    if (mesh.boundary_names[facet.tag] == "left")
      facet.tag =
          static_cast<int>(std::ranges::find(mesh.boundary_names, "bottom") - mesh.boundary_names.begin());
  const DiscreteProblem<2> c(mesh, {.boundaries = {clamped<2>("top"), obstacle<2>("bottom")}});
  const auto facts = doctor::contact_boundary_facts(c.form);
  ASSERT_THAT(facts, SizeIs(1));
  EXPECT_EQ(facts[0].kink, 0);
  EXPECT_NEAR(facts[0].spread, 45, 1e-10);
}

/// The direction turns from the facets' normal at the left to 90 degrees away from it at the right.
TEST(ContactFacts, DirectionsOffTheNormal)
{
  ProblemData<2> data{.boundaries = {clamped<2>("top"), obstacle<2>("bottom")}};
  const auto facts = [&]
  {
    const DiscreteProblem<2> c(box<2>({0, 0}, {1, 1}, {6, 1}), data);
    return doctor::contact_boundary_facts(c.form)[0];
  };
  EXPECT_EQ(facts().off_normal, 0);
  data.boundaries.back().contact->normal =
      problem::NormalField({formula("sin(x*pi/2)"), formula("-cos(x*pi/2)")});
  const doctor::ContactBoundaryFacts turned = facts();
  EXPECT_NEAR(turned.off_normal, 90 * turned.off_normal_at[0], 1e-10);
  EXPECT_GT(turned.off_normal, 85);  // the last point of the rule lies a little inside
  data.boundaries.back().contact->normal = problem::NormalField({0.0, 1.0});
  EXPECT_NEAR(facts().off_normal, 180, 1e-10);
}

TEST(ContactFacts, RoofIn3D)
{
  const auto fold = [](const Point<3>& x) -> Point<3> {
    return {x[0], x[1], x[2] + std::tan(5 * degree) * std::abs(x[0])};
  };
  const DiscreteProblem<3> c(mapped<3>(box<3>({-1, 0, 0}, {1, 1, 1}, {2, 1, 1}), fold),
                             {.boundaries = {clamped<3>("front"), obstacle<3>("back", Frictionless(), 0.5)}});
  const auto facts = doctor::contact_boundary_facts(c.form);
  ASSERT_THAT(facts, SizeIs(1));
  EXPECT_EQ(facts[0].facets, 4);
  EXPECT_NEAR(facts[0].kink, 10, 1e-10);
  EXPECT_NEAR(facts[0].kink_at[0], 0, 1e-14);
  EXPECT_NEAR(facts[0].spread, 5, 1e-10);
  EXPECT_EQ(facts[0].smallest_gap, 0.5);
  EXPECT_EQ(facts[0].largest_gap, 0.5);
}

}  // namespace

}  // namespace tribound::test
