/// @file run_warnings_test.cpp
/// Which results deserve a warning.

#include "tribound/doctor/run_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tribound
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

doctor::SolvedFigures solved(const certify::BoundComponents& components)
{
  return {certify::Bound{components, components.total(), components.total_sharp()}, 10, 1};
}

doctor::ContactOutcome closed_contact()
{
  doctor::ContactOutcome outcome;
  outcome.boundary = "base";
  outcome.facets = 20;
  outcome.closed_facets = 10;
  outcome.closed = 1;
  outcome.slipping = 0.5;
  outcome.has_friction = true;
  outcome.coefficient = 0.3;
  outcome.force = 1.5;  // a mean pressure of 1.5
  outcome.largest_pressure = 2;
  outcome.penetration = 1e-4;
  outcome.zigzag = 1e-3;
  return outcome;
}

std::vector<std::string> codes(const doctor::SolvedFigures& record, const doctor::ContactOutcome& outcome)
{
  std::vector<std::string> result;
  for (const doctor::Finding& warning : doctor::run_warnings(record, std::array{outcome}))
    result.push_back(warning.code);
  return result;
}

const doctor::SolvedFigures sound = solved({.str = 1, .cnt = 0.5});

TEST(RunWarnings, NoneForASoundResult)
{
  EXPECT_THAT(codes(sound, closed_contact()), IsEmpty());
}

TEST(RunWarnings, NumbersCarryTheirUnits)
{
  doctor::SolvedFigures in_mm = sound;
  in_mm.units = {"mm", "N"};
  doctor::ContactOutcome outcome = closed_contact();
  outcome.penetration = 0.25;
  outcome.kink_pressure = 6;
  outcome.damage.softening = {.slope = 9, .gamma = 10, .h = 0.5};
  outcome.damage.open_cohesion = 0.125;
  std::string all;
  for (const doctor::Finding& warning : doctor::run_warnings(in_mm, std::array{outcome}))
    all += warning.text + "\n";
  EXPECT_THAT(all, HasSubstr("reaches 6 MPa, 4 times its mean"));
  EXPECT_THAT(all, HasSubstr("the body penetrates the obstacle by 0.25 mm, "));
  EXPECT_THAT(all, HasSubstr("the slope 9 N/mm^3, and gamma is 10 N/mm^3 on a facet of size 0.5 mm"));
  EXPECT_THAT(all, HasSubstr("its cohesion of 0.125 MPa, since"));
}

TEST(RunWarnings, DataThatDominate)
{
  EXPECT_THAT(codes(solved({.osc = 2, .str = 1}), closed_contact()), ElementsAre("body_force_oscillation"));
  EXPECT_THAT(codes(solved({.str = 1, .neu = 2}), closed_contact()), ElementsAre("traction_oscillation"));
  EXPECT_THAT(codes(solved({.osc = 1e-12, .str = 1e-14}), closed_contact()), IsEmpty());  // round-off
  doctor::SolvedFigures without_bound;
  without_bound.max_displacement = 1;
  EXPECT_THAT(codes(without_bound, closed_contact()), IsEmpty());
}

TEST(RunWarnings, ContactThatIsNotResolved)
{
  doctor::ContactOutcome outcome = closed_contact();
  outcome.closed_facets = 2;
  EXPECT_THAT(codes(sound, outcome), ElementsAre("few_contact_facets"));
  outcome.facets = 2;  // all of it is closed: nothing to resolve
  EXPECT_THAT(codes(sound, outcome), IsEmpty());
  outcome = closed_contact();
  outcome.closed = 0;
  outcome.slipping = 0;
  EXPECT_THAT(codes(sound, outcome), ElementsAre("no_contact"));
}

/// Values on either side of the limit, and the location in the warning.
TEST(RunWarnings, Zigzag)
{
  doctor::ContactOutcome outcome = closed_contact();
  outcome.zigzag = 0.035;
  EXPECT_THAT(codes(sound, outcome), IsEmpty());
  outcome.zigzag = 0.06;
  outcome.zigzag_at = {0.25, 0};
  const auto warnings = doctor::run_warnings(sound, std::array{outcome});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].code, "pressure_zigzag");
  EXPECT_EQ(warnings[0].numbers[0].second, 0.06);
  EXPECT_EQ(doctor::location(warnings[0]), "boundary \"base\" at (0.25, 0)");
  EXPECT_THAT(warnings[0].text, HasSubstr("goes up and down by 6 % of itself"));
}

TEST(RunWarnings, PressureAtKinks)
{
  doctor::ContactOutcome outcome = closed_contact();
  outcome.kink = 0.5;
  outcome.kink_pressure = 2;  // a Hertz contact on a fine polygon
  EXPECT_THAT(codes(sound, outcome), IsEmpty());
  outcome.kink_pressure = 4.5;
  outcome.kink_at = {0.5, 0};
  const auto warnings = doctor::run_warnings(sound, std::array{outcome});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].code, "pressure_at_kinks");
  EXPECT_DOUBLE_EQ(warnings[0].numbers[0].second, 3);
  EXPECT_EQ(doctor::location(warnings[0]), "boundary \"base\" at (0.5, 0)");
  EXPECT_THAT(warnings[0].text,
              HasSubstr("reaches 4.5, 3 times its mean, where facets meet at an angle (up to 0.5"));
}

TEST(RunWarnings, Penetration)
{
  doctor::ContactOutcome outcome = closed_contact();
  outcome.penetration = 0.015;
  EXPECT_THAT(codes(sound, outcome), IsEmpty());
  outcome.penetration = 0.1;
  outcome.penetration_at = {0.5, 0};
  const auto warnings = doctor::run_warnings(sound, std::array{outcome});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].code, "penetration");
  EXPECT_DOUBLE_EQ(warnings[0].numbers[0].second, 0.1);
  EXPECT_EQ(doctor::location(warnings[0]), "boundary \"base\" at (0.5, 0)");
  EXPECT_THAT(warnings[0].text, HasSubstr("by 0.1, 10 % of the largest displacement"));
}

TEST(RunWarnings, Friction)
{
  doctor::ContactOutcome outcome = closed_contact();
  outcome.coefficient = 1.5;
  EXPECT_THAT(codes(sound, outcome), ElementsAre("friction_coefficient"));
  outcome = closed_contact();
  outcome.slipping = outcome.closed;
  EXPECT_THAT(codes(sound, outcome), ElementsAre("sliding"));
  outcome.has_friction = false;  // without friction everything slides
  EXPECT_THAT(codes(sound, outcome), IsEmpty());
}

TEST(RunWarnings, Damage)
{
  doctor::ContactOutcome outcome = closed_contact();
  outcome.damage.softening = {.slope = 5, .gamma = 10, .h = 0.5, .where = {1, 0}};
  outcome.damage.process_zone = 3;
  EXPECT_THAT(codes(sound, outcome), IsEmpty());
  outcome.damage.softening.gamma = 8;
  outcome.damage.process_zone = 2.5;
  const auto warnings = doctor::run_warnings(sound, std::array{outcome});
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].code, "steep_softening");
  EXPECT_DOUBLE_EQ(warnings[0].numbers[0].second, 0.625);
  EXPECT_EQ(doctor::location(warnings[0]), "boundary \"base\" at (1, 0)");
  EXPECT_THAT(warnings[0].text, HasSubstr("facets of less than 0.4 there, or a nitsche.gamma0 of 1.2 times"));
  EXPECT_EQ(warnings[1].code, "process_zone");
  EXPECT_DOUBLE_EQ(warnings[1].numbers[0].second, 2.5);
  outcome = closed_contact();
  outcome.damage.open_cohesion = 0.7;
  const auto kept = doctor::run_warnings(sound, std::array{outcome});
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].code, "open_cohesion");
  EXPECT_THAT(kept[0].text, HasSubstr("an open point keeps its cohesion of 0.7"));
}

}  // namespace
}  // namespace tribound
