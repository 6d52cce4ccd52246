/// Marking, against all subsets and against sorting; equal and zero estimates.

#include "tribound/adapt/mark.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

namespace tribound
{

namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;

double sum_of_squares(std::span<const double> eta, std::span<const Index> cells)
{
  double sum = 0;
  for (const Index c : cells) sum += eta[c] * eta[c];
  return sum;
}

double sum_of_squares(std::span<const double> eta)
{
  return std::inner_product(eta.begin(), eta.end(), eta.begin(), 0.0);
}

/// Small integers, so that sums of squares are exact and many are equal; some are 0.
std::vector<double> whole_numbers(std::size_t n, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<double> eta(n);
  for (double& x : eta) x = static_cast<double>(random() % 7);
  return eta;
}

/// Their squares are exact.
constexpr std::array thetas{0.125, 0.25, 0.5, 0.75, 0.875, 1.0};

TEST(MarkDoerfler, NoSubsetIsSmaller)
{
  for (unsigned seed = 0; seed < 50; ++seed)
    for (const double theta : thetas)
    {
      const std::vector<double> eta = whole_numbers(10, seed);
      const double goal = theta * theta * sum_of_squares(eta);
      int smallest = 10;
      for (unsigned subset = 0; subset < 1024; ++subset)
      {
        double sum = 0;
        for (int c = 0; c < 10; ++c)
          if ((subset >> c & 1U) != 0) sum += eta[c] * eta[c];
        if (sum >= goal) smallest = std::min(smallest, std::popcount(subset));
      }
      const std::vector<Index> marked = adapt::mark_doerfler(eta, theta);
      EXPECT_EQ(marked.size(), static_cast<std::size_t>(smallest));
      EXPECT_GE(sum_of_squares(eta, marked), goal);
    }
}

/// The first cells in descending order of eta_T, equal ones in ascending order of their numbers.
TEST(MarkDoerfler, IsTheBeginningOfTheSortedCells)
{
  for (unsigned seed = 0; seed < 20; ++seed)
    for (const double theta : thetas)
    {
      const std::vector<double> eta = whole_numbers(1000 + seed, seed);
      const double goal = theta * theta * sum_of_squares(eta);
      std::vector<Index> cells(eta.size());
      std::iota(cells.begin(), cells.end(), 0);
      std::ranges::stable_sort(cells, [&](Index a, Index b) { return eta[a] > eta[b]; });
      double sum = 0;
      std::size_t n = 0;
      while (sum < goal) sum += eta[cells[n]] * eta[cells[n]], ++n;
      cells.resize(n);
      std::ranges::sort(cells);
      EXPECT_EQ(adapt::mark_doerfler(eta, theta), cells);
    }
}

/// Estimates over many orders of magnitude: the set reaches the goal, but not without its least cell.
TEST(MarkDoerfler, ReachesTheGoalAndNoMore)
{
  std::mt19937 random(3);
  std::lognormal_distribution<double> lognormal(0, 3);
  std::vector<double> eta(100000);
  for (double& x : eta) x = lognormal(random);
  const double total = sum_of_squares(eta);
  for (const double theta : {0.1, 0.3, 0.5, 0.7, 0.9, 0.99})
  {
    std::vector<Index> marked = adapt::mark_doerfler(eta, theta);
    EXPECT_TRUE(std::ranges::is_sorted(marked));
    EXPECT_GE(sum_of_squares(eta, marked), theta * theta * total * (1 - 1e-12));
    const auto least = std::ranges::min_element(marked, {}, [&](Index c) { return eta[c]; });
    const double smallest = eta[*least];
    marked.erase(least);
    EXPECT_LT(sum_of_squares(eta, marked), theta * theta * total * (1 + 1e-12));
    std::vector<char> in_set(eta.size(), 0);
    for (const Index c : marked) in_set[c] = 1;
    for (std::size_t c = 0; c < eta.size(); ++c)
    {
      ASSERT_LE(in_set[c] == 0 ? eta[c] : 0.0, smallest);
    }
  }
}

TEST(MarkDoerfler, OfEqualCellsTheFirst)
{
  EXPECT_THAT(adapt::mark_doerfler(std::vector{2.0, 2.0, 2.0, 2.0}, 0.5), ElementsAre(0));
  EXPECT_THAT(adapt::mark_doerfler(std::vector{1.0, 3.0, 3.0, 3.0}, 0.75), ElementsAre(1, 2));
}

TEST(MarkDoerfler, OneMarksAllThatIsNotZero)
{
  EXPECT_THAT(adapt::mark_doerfler(std::vector{1e10, 0.0, 1e-10, 1.0}, 1), ElementsAre(0, 2, 3));
}

TEST(MarkMaximum, FromTheShareOfTheLargestOn)
{
  const std::vector<double> eta{0.5, 4.0, 1.9, 2.0, 0.0, 2.1};
  EXPECT_THAT(adapt::mark_maximum(eta, 0.5), ElementsAre(1, 3, 5));
  EXPECT_THAT(adapt::mark_maximum(eta, 0.125), ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(adapt::mark_maximum(eta, 1), ElementsAre(1));
}

TEST(Mark, NothingWhereNothingIsEstimated)
{
  const std::vector<double> zeros(5, 0.0);
  EXPECT_THAT(adapt::mark_doerfler(zeros, 0.5), IsEmpty());
  EXPECT_THAT(adapt::mark_maximum(zeros, 0.5), IsEmpty());
  EXPECT_THAT(adapt::mark_doerfler({}, 0.5), IsEmpty());
  EXPECT_THAT(adapt::mark_maximum({}, 0.5), IsEmpty());
}

/// Cells with these values of str and cnt.
std::vector<certify::BoundComponents> cells_with(std::span<const double> str, std::span<const double> cnt)
{
  std::vector<certify::BoundComponents> cells(str.size());
  for (std::size_t c = 0; c < str.size(); ++c) cells[c].str = str[c], cells[c].cnt = cnt[c];
  return cells;
}

TEST(Mark, AsTheCaseAsks)
{
  const std::vector<certify::BoundComponents> eta =
      cells_with(std::vector{1.0, 1.0, 1.0, 2.0}, std::vector{0.0, 0.0, 0.0, 0.0});
  adapt::MarkingOptions options;
  options.theta = 0.5;
  options.strategy = adapt::Marking::doerfler;
  EXPECT_THAT(adapt::mark(eta, options), ElementsAre(3));
  options.strategy = adapt::Marking::maximum;
  EXPECT_THAT(adapt::mark(eta, options), ElementsAre(0, 1, 2, 3));
  options.theta = 1;
  EXPECT_THAT(adapt::mark(eta, options), ElementsAre(3));
  options.strategy = adapt::Marking::uniform;
  EXPECT_THAT(adapt::mark(eta, options), ElementsAre(0, 1, 2, 3));
}

TEST(Mark, TheContactPartIsMarkedForItselfWhenAsked)
{
  const std::vector<double> str{1.0, 8.0, 1.0, 1.0};
  adapt::MarkingOptions options;
  options.theta = 0.9;
  const std::vector<certify::BoundComponents> cells = cells_with(str, std::vector{2.0, 0.0, 0.0, 0.5});
  EXPECT_THAT(adapt::mark(cells, options), ElementsAre(1));
  options.separate_contact = true;
  EXPECT_THAT(adapt::mark(cells, options), ElementsAre(0, 1));
  // Below a tenth of the bound, contact is not marked separately.
  EXPECT_THAT(adapt::mark(cells_with(str, std::vector{0.5, 0.0, 0.0, 0.0}), options), ElementsAre(1));
}

}  // namespace

}  // namespace tribound
