/// @file path_facts_test.cpp
/// Load factors at which contact cannot balance the loads.

#include "tribound/doctor/path_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"

namespace tribound::test
{

namespace
{

/// A block of width 2 is pressed on its floor with 1 and pushed with 0.3 t on a side of height 1.
TEST(PathFacts, FirstLoadBeyondFriction)
{
  const mesh::Mesh<2> mesh(block<2>({4, 2}));
  const ProblemData<2> data{.boundaries = {loaded<2>("top", 0, -1), loaded<2>("right", formula("-0.3*t"), 0),
                                           obstacle<2>("bottom", Coulomb(0.2))}};
  const problem::Problem<2> problem(data.on(mesh));
  const fem::LagrangeSpace<2> space(mesh, 1);
  EXPECT_FALSE(doctor::load_beyond_contact<2>(problem, space, std::vector{0.5, 1.0, 1.33}));
  const auto beyond = doctor::load_beyond_contact<2>(problem, space, std::vector{0.5, 1.0, 1.34, 2.0});
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->t, 1.34);
  EXPECT_THAT(beyond->why, ::testing::HasSubstr("friction is too weak"));
}

}  // namespace

}  // namespace tribound::test
