/// @file units_test.cpp
/// Unit labels, against those that engineers write.

#include "tribound/problem/units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tribound
{
namespace
{

using problem::UnitOf;
using problem::Units;

std::string stress(std::string_view length, std::string_view force)
{
  return Units(length, force).label(UnitOf::stress, 3);
}

TEST(Units, StressesHaveNamesOfTheirOwn)
{
  EXPECT_EQ(stress("mm", "N"), "MPa");
  EXPECT_EQ(stress("m", "N"), "Pa");
  EXPECT_EQ(stress("m", "kN"), "kPa");
  EXPECT_EQ(stress("m", "MN"), "MPa");
  EXPECT_EQ(stress("mm", "kN"), "GPa");
  EXPECT_EQ(stress("mm", "mN"), "kPa");
  EXPECT_EQ(stress("um", "uN"), "MPa");
  EXPECT_EQ(stress("um", "mN"), "GPa");
  EXPECT_EQ(stress("um", "N"), "TPa");
  EXPECT_EQ(stress("nm", "nN"), "GPa");
  EXPECT_EQ(stress("in", "lbf"), "psi");
  EXPECT_EQ(stress("ft", "lbf"), "psf");
  EXPECT_EQ(stress("in", "kip"), "ksi");
  EXPECT_EQ(stress("ft", "kip"), "ksf");
}

TEST(Units, OtherStressesAreForcesPerArea)
{
  EXPECT_EQ(stress("cm", "N"), "N/cm^2");  // 10^4 Pa
  EXPECT_EQ(stress("cm", "kN"), "kN/cm^2");
  EXPECT_EQ(stress("cm", "kgf"), "kgf/cm^2");
  EXPECT_EQ(stress("cm", "dyn"), "dyn/cm^2");
  EXPECT_EQ(stress("m", "lbf"), "lbf/m^2");
  EXPECT_EQ(stress("nm", "GN"), "GN/nm^2");  // beyond TPa
}

/// All labels, in the order of unit_names.
std::vector<std::string> labels(const Units& units, int dimension)
{
  std::vector<std::string> result;
  for (const auto& [name, what] : problem::unit_names) result.push_back(units.label(what, dimension));
  return result;
}

TEST(Units, In3D)
{
  EXPECT_THAT(labels({"mm", "N"}, 3), testing::ElementsAre("mm", "mm^2", "mm^3", "MPa", "N/mm^3", "N/mm", "N",
                                                           "N mm", "N mm", "MPa mm^(3/2)", "(N mm)^(1/2)"));
}

TEST(Units, In2DForcesArePerDepth)
{
  EXPECT_THAT(labels({"m", "MN"}, 2), testing::ElementsAre("m", "m", "m^2", "MPa", "MN/m^3", "MN/m", "MN/m",
                                                           "MN m/m", "MN m/m", "MPa m", "(MN m/m)^(1/2)"));
}

TEST(Units, BehindANumber)
{
  EXPECT_EQ(Units("in", "lbf").behind(UnitOf::stress, 3), " psi");
  EXPECT_EQ(Units().behind(UnitOf::stress, 3), "");
}

TEST(Units, WithoutNamesThereAreNoLabels)
{
  EXPECT_FALSE(Units().are_named());
  EXPECT_THAT(labels({}, 2), testing::Each(""));
  EXPECT_EQ(Units().pascals(), 1);
}

TEST(Units, Sizes)
{
  EXPECT_DOUBLE_EQ(Units("mm", "N").pascals(), 1e6);
  EXPECT_DOUBLE_EQ(Units("m", "kN").pascals(), 1e3);
  EXPECT_NEAR(Units("in", "lbf").pascals(), 6894.757293, 1e-6);
  EXPECT_DOUBLE_EQ(Units("ft", "kip").metres(), 0.3048);
}

TEST(Units, EveryNameHasASize)
{
  for (const std::string& length : problem::length_names())
    for (const std::string& force : problem::force_names())
      EXPECT_GT(Units(length, force).pascals(), 0) << length << ", " << force;
}

}  // namespace
}  // namespace tribound
