/// @file water_test.cpp
/// Water pressures in a joint, against formulas.

#include "tribound/problem/water.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/input_error.h"
#include "tribound/problem/formula.h"

namespace tribound
{
namespace
{

using problem::BaseLine;
using problem::Field;
using problem::Seepage;
using problem::Water;

Field level(const std::string& text)
{
  return {text, Where{.file = {}, .key = "head"}};
}

Seepage dam()
{
  return {.head = level("t"), .tail = level("5"), .weight = 0.01, .line = {{0, 2}, {60, 3}}};
}

/// The point at arc length s on the line of dam().
Point<2> at(double s)
{
  const double length = std::sqrt(3601);
  return Point<2>(60 * s / length, 2 + s / length);
}

TEST(Water, FallsLinearlyFromHeelToToe)
{
  const Water water = Water(dam()).at(80);
  const double length = dam().line.length();
  const double heel = 0.01 * 78;
  const double toe = 0.01 * 2;
  for (const double share : {0.0, 0.3, 0.7, 1.0})
    EXPECT_NEAR(water(at(share * length)), heel + share * (toe - heel), 1e-15);
  EXPECT_NEAR(water(at(-1)), heel, 1e-15);
  EXPECT_NEAR(water(at(length + 1)), toe, 1e-15);
  EXPECT_EQ(Water(dam()).at(1)(at(0.0)), 0);  // below the heel
  EXPECT_TRUE(water.uses_time());
  EXPECT_FALSE(water.follows_crack());
}

TEST(Water, ADrainWithoutEffectIsNone)
{
  Seepage drained = dam();
  drained.drain = {.at = 10, .efficiency = 0};
  const Water with = Water(drained).at(80);
  const Water without = Water(dam()).at(80);
  for (const double s : {0.0, 4.0, 10.0, 30.0, 60.0}) EXPECT_NEAR(with(at(s)), without(at(s)), 1e-15);
}

TEST(Water, DrainsAndCracks)
{
  const double length = dam().line.length();
  const double heel = 0.78;
  const double toe = 0.02;
  Seepage seepage = dam();
  seepage.drain = {.at = 10, .efficiency = 0.6};
  EXPECT_NEAR(Water(seepage).at(80)(at(10)), toe + 0.4 * (heel - toe) * (length - 10) / length, 1e-15);
  // The crack carries the full pressure up to its tip.
  seepage.crack = true;
  const Water cracked = Water(seepage).at(80).with_crack_tip(4);
  EXPECT_TRUE(cracked.follows_crack());
  EXPECT_EQ(cracked.crack_tip(), 4);
  EXPECT_NEAR(cracked(at(3.9)), heel, 1e-15);
  const double at_drain = toe + 0.4 * (heel - toe) * (length - 10) / (length - 4);
  EXPECT_NEAR(cracked(at(7)), (heel + at_drain) / 2, 1e-14);
  EXPECT_NEAR(cracked(at(10)), at_drain, 1e-15);
  EXPECT_NEAR(cracked(at((10 + length) / 2)), (toe + at_drain) / 2, 1e-14);
  EXPECT_EQ(cracked.at(80).crack_tip(), 4);
  // A crack tip at the drain disables the drain.
  EXPECT_NEAR(cracked.with_crack_tip(10)(at((10 + length) / 2)), (heel + toe) / 2, 1e-14);
  EXPECT_NEAR(cracked.with_crack_tip(length)(at(length - 0.1)), heel, 1e-15);
  seepage.crack = false;
  const Water lost = Water(seepage).at(80).with_crack_tip(12);
  EXPECT_NEAR(lost(at(10)), heel + 10 / length * (toe - heel), 1e-15);
  seepage.drain->from_full_head = true;
  EXPECT_NEAR(Water(seepage).at(80)(at(10)), toe + 0.4 * (heel - toe), 1e-15);
}

/// Kinks, where the quadrature of assembly and certificate is cut.
TEST(Water, TellsItsKinks)
{
  Seepage seepage = dam();
  seepage.crack = true;
  seepage.drain = {.at = 10, .efficiency = 0.6};
  const Water water = Water(seepage).at(80).with_crack_tip(4);
  EXPECT_EQ(water.pressure().switches().size(), 3);
  for (const double s : {4.0, 10.0, dam().line.length()})
  {
    bool found = false;
    for (const problem::Affine& a : water.pressure().switches())
      found = found || std::abs(a.a[0] * at(s)[0] + a.a[1] * at(s)[1] + a.b) < 1e-12 * std::abs(a.b);
    EXPECT_TRUE(found) << s;
  }
}

TEST(Water, RefusesNegativePressuresAndLevelsThatVary)
{
  const auto says = [](const std::string& text, const auto& action)
  { EXPECT_NE(test::message_of(action).find(text), std::string::npos) << test::message_of(action); };
  says("is negative, -0.5, at the point (0.5, 0)", [] { return Water(level("x - 1"))(Point<2>(0.5, 0)); });
  Seepage seepage = dam();
  seepage.head = level("x*t");
  says("varies in space", [&] { return Water(seepage); });
}

}  // namespace
}  // namespace tribound
