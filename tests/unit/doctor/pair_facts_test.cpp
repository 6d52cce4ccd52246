/// @file pair_facts_test.cpp
/// Opposite sides and their distances for pairs of known shape; what deserves a warning.

#include "tribound/doctor/pair_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/doctor/findings.h"

namespace tribound::test
{

namespace
{

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The bottom of one mesh and the top of the other may touch.
template <int dim>
mesh::MeshData<dim> stacked(const mesh::MeshData<dim>& upper, const mesh::MeshData<dim>& lower)
{
  mesh::MeshData<dim> data = side_by_side(upper, lower, "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  return data;
}

/// The block (0, 2) x (0, 1) on one whose top is y = -gap, from x = 0 to `length`.
doctor::PairFacts facts_of(problem::ContactLaw law, double gap, double length,
                           std::optional<problem::Field> given = std::nullopt)
{
  problem::ContactPair<2> contact = pair<2>("bottom", "top_below", std::move(law));
  contact.contact.gap = cone(contact.contact.law).is_tied ? problem::Field(0.0) : std::move(given);
  const DiscreteProblem<2> c(
      stacked(block<2>({4, 2}), box<2>({0, -2}, {length, -gap}, {3, 1})),
      {.boundaries = {clamped<2>("left"), clamped<2>("bottom_below")}, .pairs = {contact}});
  return doctor::pair_facts(c.form).at(0);
}

/// The codes of the warnings about a pair.
std::vector<std::string> warnings(const doctor::PairFacts& facts)
{
  doctor::Diagnosis diagnosis;
  diagnosis.pairs = {facts};
  std::vector<std::string> codes;
  for (const doctor::Finding& finding : doctor::pair_findings(diagnosis))
    if (finding.severity == doctor::Severity::warning) codes.push_back(finding.code);
  return codes;
}

TEST(PairFacts, OfBlocks)
{
  const doctor::PairFacts facts = facts_of(Frictionless(), 0.1, 2.5);
  EXPECT_EQ(facts.name, "\"bottom\" on \"top_below\"");
  EXPECT_EQ(facts.segments, 6);
  EXPECT_NEAR(facts.covered_share, 1, 1e-12);
  EXPECT_NEAR(facts.smallest_gap, 0.1 / 0.5, 1e-12);
  EXPECT_NEAR(facts.stretch, 1, 1e-12);
  EXPECT_NEAR(facts.distance, 0.1, 1e-12);
  EXPECT_NEAR(facts.size, 2, 1e-12);
  EXPECT_EQ(facts.turn, 0);
  EXPECT_THAT(warnings(facts), ElementsAre());
}

TEST(PairFacts, WhatIsNotCovered)
{
  const doctor::PairFacts facts = facts_of(Coulomb(0.3), 0.0, 1.9);
  EXPECT_NEAR(facts.covered_share, 0.95, 1e-12);
  EXPECT_THAT(warnings(facts), ElementsAre("pair_coverage"));
  EXPECT_THAT(warnings(facts_of(Tied(), 0.0, 1.9)), ElementsAre("pair_coverage"));
  EXPECT_THAT(warnings(facts_of(Coulomb(0.3), 0.0, 1.9, problem::Field(0.0))), ElementsAre());
  EXPECT_THAT(warnings(facts_of(Coulomb(0.3), 0.0, 1.99)), ElementsAre());
}

TEST(PairFacts, FarFromEachOther)
{
  EXPECT_THAT(warnings(facts_of(Frictionless(), 0.0, 2, problem::Field(5.1))), ElementsAre("pair_gap"));
  EXPECT_THAT(warnings(facts_of(Frictionless(), 0.0, 2, problem::Field(-5.1))), ElementsAre("pair_gap"));
  EXPECT_THAT(warnings(facts_of(Frictionless(), 0.0, 2, formula("5.1*x"))), ElementsAre());
  EXPECT_THAT(warnings(facts_of(Tied(), 0.0021, 2)), ElementsAre("tie_distance"));
  EXPECT_THAT(warnings(facts_of(Tied(), 0.0019, 2)), ElementsAre());
}

/// Sides that meet at an angle of 63 degrees: dM/dS = sqrt(5) along the slave's normal.
TEST(PairFacts, SidesThatAreNotParallel)
{
  const auto steep = [](const Point<2>& x) { return Point<2>(x[0], x[1] - 2 * x[0] * (x[1] + 8) / 7); };
  const mesh::MeshData<2> below = mapped<2>(box<2>({0, -8}, {1, -1}, {3, 7}), steep);
  const DiscreteProblem<2> c(stacked(box<2>({0, 0}, {1, 1}, {2, 2}), below),
                             {.boundaries = {clamped<2>("left"), clamped<2>("bottom_below")},
                              .pairs = {pair<2>("bottom", "top_below")}});
  const doctor::PairFacts facts = doctor::pair_facts(c.form).at(0);
  EXPECT_NEAR(facts.stretch, std::sqrt(5), 1e-12);
  EXPECT_THAT(warnings(facts), ElementsAre("pair_stretch"));
}

TEST(PairFacts, ASlaveThatTurns)
{
  const auto bent = [](double slope)
  { return [slope](const Point<2>& x) { return Point<2>(x[0], x[1] + slope * std::max(0.0, x[0] - 1)); }; };
  for (const auto& [slope, expected] : {std::pair(0.2, 0), {0.3, 1}, {1.5, 1}})
  {
    const DiscreteProblem<2> c(
        mapped<2>(stacked(block<2>({2, 1}), box<2>({-1, -1}, {2, 0}, {3, 1})), bent(slope)),
        {.boundaries = {clamped<2>("left"), clamped<2>("bottom_below")},
         .pairs = {pair<2>("bottom", "top_below")}});
    const doctor::PairFacts facts = doctor::pair_facts(c.form).at(0);
    EXPECT_NEAR(facts.turn, std::atan(slope) * 180 / std::acos(-1), 1e-9);
    const auto codes = warnings(facts);
    EXPECT_EQ(std::ranges::count(codes, "pair_turn"), expected) << slope;
  }
}

TEST(PairFacts, In3D)
{
  const DiscreteProblem<3> c(stacked(block<3>({2, 1, 2}), box<3>({0, -1, 0}, {2, -0.01, 0.5}, {1, 1, 1})),
                             {.boundaries = {clamped<3>("left"), clamped<3>("bottom_below")},
                              .pairs = {pair<3>("bottom", "top_below")}});
  doctor::PairFacts facts = doctor::pair_facts(c.form).at(0);
  EXPECT_NEAR(facts.covered_share, 0.5, 1e-12);
  EXPECT_NEAR(facts.distance, 0.01, 1e-12);
  EXPECT_NEAR(facts.size, std::hypot(2, 0.5), 1e-12);
  facts.geometric_gap = true;
  doctor::Diagnosis diagnosis;
  diagnosis.pairs = {facts};
  const auto findings = doctor::pair_findings(diagnosis);
  EXPECT_THAT(findings.at(0).text, AllOf(HasSubstr("segments"), HasSubstr("covers 50 % of the slave")));
  EXPECT_THAT(findings.at(1).text, HasSubstr("50 % of the slave of \"bottom\" on \"top_below\" has nothing"));
}

}  // namespace

}  // namespace tribound::test
