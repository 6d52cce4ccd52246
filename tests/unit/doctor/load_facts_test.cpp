/// @file load_facts_test.cpp
/// Guesses of stresses, strains and units from the data of a case.

#include "tribound/doctor/load_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/discrete_problem.h"
#include "support/meridian_problem.h"
#include "support/meshes.h"
#include "tribound/doctor/units.h"

namespace tribound::test
{

namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;

doctor::LoadFacts facts(const std::vector<problem::BoundaryCondition<2>>& boundaries,
                        const std::array<problem::Field, 2>& body_force = {},
                        const problem::Material& material = lame(100, 0.3))
{
  return doctor::load_facts(
      DiscreteProblem<2>(block<2>({4, 2}),
                         {.boundaries = boundaries, .material = material, .body_force = body_force})
          .form);
}

TEST(LoadFacts, TractionAndWhatHoldsIt)
{
  const doctor::LoadFacts loads = facts({clamped<2>("left"), loaded<2>("top", 0.3, -0.4)});
  EXPECT_THAT(loads.extent, ElementsAre(2, 1));
  EXPECT_EQ(loads.size, 2);
  EXPECT_NEAR(loads.traction_stress, 0.5, 1e-14);
  EXPECT_NEAR(loads.support_stress, 1, 1e-14);  // force 1 on a side of length 1
  EXPECT_NEAR(loads.stress(), 1, 1e-14);
  EXPECT_NEAR(loads.strain(), 0.01, 1e-14);
}

/// A force of 10 on a ring between r = 1 and 2, whose ends have the area 3 pi.
TEST(LoadFacts, AreasOfBodiesOfRevolutionAreThoseOfTheFullCircle)
{
  const double stress = 10 / (3 * std::numbers::pi);
  problem::BoundaryCondition<2> plate;
  plate.name = "top";
  plate.rigid.emplace().force[1] = -10;
  for (const auto& top : {plate, pressed<2>("top", stress)})
  {
    const doctor::LoadFacts loads =
        doctor::load_facts(MeridianProblem(box<2>({1, 0}, {2, 1}, {2, 2}),
                                           {.boundaries = {fixed<2>("bottom", free, 0.0), top}}, {})
                               .form);
    EXPECT_NEAR(loads.traction_stress, stress, 1e-14);
    EXPECT_NEAR(loads.support_stress, top.rigid ? stress / 2 : stress, 1e-14);  // plates support as well
  }
}

TEST(LoadFacts, LoadsInEquilibriumDoNotReachTheSupports)
{
  const doctor::LoadFacts loads = facts({clamped<2>("left"), pressed<2>("top", 2), pressed<2>("bottom", 2)});
  EXPECT_NEAR(loads.traction_stress, 2, 1e-14);
  EXPECT_NEAR(loads.support_stress, 0, 1e-14);
}

TEST(LoadFacts, ANegativePressurePulls)
{
  const doctor::LoadFacts loads =
      facts({clamped<2>("left"), pressed<2>("top", 2), pressed<2>("right", formula("0.75-y"))});
  ASSERT_EQ(loads.suction.size(), 1u);
  EXPECT_EQ(loads.suction[0].boundary, "right");
  EXPECT_NEAR(loads.suction[0].lowest, -0.25, 0.05);
  EXPECT_NEAR(loads.suction[0].where.at(1), 1, 0.05);
}

TEST(LoadFacts, BodyForceOverTheLengthOfTheBody)
{
  const doctor::LoadFacts loads = facts({clamped<2>("left")}, {0, -0.25});
  EXPECT_NEAR(loads.largest_body_force, 0.25, 1e-15);
  EXPECT_NEAR(loads.body_stress, 0.5, 1e-14);
  EXPECT_NEAR(loads.support_stress, 0.5, 1e-14);  // weight 0.25 * 2 on a side of length 1
}

TEST(LoadFacts, PrescribedDisplacements)
{
  const auto both =
      facts({fixed<2>("left", 0.5, free), fixed<2>("right", 0.7, free), fixed<2>("bottom", free, 0)});
  EXPECT_NEAR(both.displacement_strain, 0.1, 1e-14);
  const auto pushed = facts({fixed<2>("top", 0, -0.3), obstacle<2>("bottom")});
  EXPECT_NEAR(pushed.displacement_strain, 0.15, 1e-14);  // the obstacle stays
  const auto moved = facts({fixed<2>("top", 5, -3)});
  EXPECT_NEAR(moved.displacement_strain, 0, 1e-14);  // a rigid motion
  const auto slid = facts({clamped<2>("left"), obstacle<2>("right", problem::Slider(), 0.3)});
  EXPECT_NEAR(slid.displacement_strain, 0.15, 1e-14);
  EXPECT_EQ(slid.interference_strain, 0);
}

TEST(LoadFacts, WhatSpringsAloneHold)
{
  problem::BoundaryCondition<2> ground{.name = "bottom"};
  ground.spring = problem::Spring<2>{.normal = 0.1};
  const auto shift = [&](const problem::BoundaryCondition<2>& left) {
    return facts({left, ground, loaded<2>("top", 0.7, -0.4)}).spring_shift;
  };
  EXPECT_NEAR(shift(fixed<2>("left", 0, free)), 2, 1e-13);  // 0.4 over 0.1, of a length of 2
  EXPECT_EQ(shift(clamped<2>("left")), 0);
  EXPECT_EQ(shift(obstacle<2>("left", problem::Slider())), 0);  // not known
}

TEST(LoadFacts, MaterialsAsGiven)
{
  const doctor::LoadFacts loads = facts({clamped<2>("left")}, {}, lame(7, 0.25, problem::PlaneModel::stress));
  EXPECT_NEAR(loads.smallest_E, 7, 1e-13);
  EXPECT_NEAR(loads.materials[0].nu, 0.25, 1e-14);
  EXPECT_TRUE(loads.materials[0].plane_stress);
}

std::vector<std::string> guesses(double E, double size, double body_force = 0)
{
  doctor::LoadFacts loads;
  loads.materials = {{"body", E, 0.3, false}};
  loads.smallest_E = E;
  loads.size = size;
  loads.largest_body_force = body_force;
  std::vector<std::string> names;
  using problem::UnitOf;
  for (const problem::Units& units : doctor::plausible_units(loads))
    names.push_back(units.label(UnitOf::length) + " " + units.label(UnitOf::force) + " " +
                    units.label(UnitOf::stress));
  return names;
}

TEST(Units, Guesses)
{
  EXPECT_THAT(guesses(2.1e11, 2), ElementsAre("m N Pa"));
  EXPECT_THAT(guesses(2.1e5, 40)[0], "mm N MPa");
  EXPECT_THAT(guesses(210, 40), ElementsAre("mm N MPa", "m MN MPa", "mm kN GPa"));
  EXPECT_THAT(guesses(25e3, 30, 9.81 * 2400e-6), ElementsAre("m MN MPa"));  // concrete in m and MN
  EXPECT_THAT(guesses(25e3, 30, 9.81 * 2400e-9), ElementsAre("mm N MPa"));  // in mm and N
  EXPECT_THAT(guesses(25e6, 30, 9.81 * 2.4), ElementsAre("m kN kPa"));
  EXPECT_THAT(guesses(1, 2), IsEmpty());
  EXPECT_THAT(guesses(2.1e11, 4000), IsEmpty());  // 4 km of steel: mm with Pa
}

}  // namespace

}  // namespace tribound::test
