#include "app/console/console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tribound
{
namespace
{

/// Levels with a bound of 0.5 (dofs / 100)^rate.
io::RunRecord with_rate(double rate, int n_levels)
{
  io::RunRecord run;
  run.tolerance = 0.01;
  for (int i = 0; i < n_levels; ++i)
  {
    io::LevelRecord& level = run.levels.emplace_back();
    level.dofs = 100L << i;
    level.figures.sigma_norm = 2;
    level.bound = certify::Bound{{}, 2, 2 * 0.5 * std::pow(2, rate * i)};
  }
  return run;
}

TEST(Forecast, FollowsTheRate)
{
  // 0.5 (N/100)^{-1} = 0.01 for N = 5000, with rate -1/2 for 250 000, with -1/4 for 625 million
  EXPECT_EQ(app::forecast_text(with_rate(-1, 3), 100'000), "  at this rate 1 % needs 5000 unknowns");
  EXPECT_EQ(app::forecast_text(with_rate(-0.5, 5), 100'000),
            "  at this rate 1 % needs 250000 unknowns, above adapt.max_dofs");
  // 625 is rounded to either side.
  EXPECT_THAT(app::forecast_text(with_rate(-0.25, 3), 2'000'000'000),
              ::testing::AnyOf("  at this rate 1 % needs 620 million unknowns",
                               "  at this rate 1 % needs 630 million unknowns"));
}

TEST(Forecast, LargeNumbersStayShort)
{
  // 0.5 (N/100)^{-0.1} = 0.01 for N = 100 * 50^10
  EXPECT_EQ(app::forecast_text(with_rate(-0.1, 3), 100'000),
            "  at this rate 1 % needs more than 10^9 unknowns, above adapt.max_dofs");
  EXPECT_THAT(app::forecast_text(with_rate(-0.0501, 3), 100'000), ::testing::HasSubstr("more than 10^9"));
  // (N/100)^{-1} = 0.01 / 0.5 at tolerance 50 / 999 600
  io::RunRecord run = with_rate(-1, 3);
  run.tolerance = 50.0 / 999'600;
  EXPECT_THAT(app::forecast_text(run, 100'000), ::testing::HasSubstr("needs 1 million unknowns"));
}

TEST(Forecast, SaysNothingTooEarlyOrAtTheEnd)
{
  EXPECT_EQ(app::forecast_text(with_rate(-1, 2), 1000), "");
  EXPECT_EQ(app::forecast_text(with_rate(-1, 8), 1000), "");
  EXPECT_EQ(app::forecast_text(with_rate(0, 4), 1000), "  the bound hardly decreases");
}

}  // namespace
}  // namespace tribound
