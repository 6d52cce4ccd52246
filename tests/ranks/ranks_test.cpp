/// @file ranks_test.cpp
/// Sums, decisions, data and errors among processes, against what one process computes.

#include "tribound/base/ranks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "tribound/base/error.h"

namespace tribound::test
{
namespace
{

using ::testing::HasSubstr;

/// A number for rank r; sums of these depend on the order of summation.
double part(int r)
{
  return std::sin(1.0 + r) * std::pow(10.0, 7 * (r % 3));
}

TEST(Ranks, OneRankIsTheIdentity)
{
  const Ranks alone;
  EXPECT_TRUE(alone.is_first());
  EXPECT_EQ(alone.size(), 1);
  EXPECT_EQ(alone.sum(3.5), 3.5);
  EXPECT_EQ(alone.before(7), 0);
  EXPECT_EQ(alone.max(-2.0), -2.0);
  EXPECT_FALSE(alone.any(false));
  EXPECT_TRUE(alone.first_says(true));
  const std::vector<std::vector<int>> out = {{1, 2, 3}};
  EXPECT_EQ(alone.send(out), out);
  EXPECT_EQ(alone.together([] { return 5; }), 5);
  EXPECT_THROW(alone.together([] { throw InputError({}, "wrong"); }), InputError);
}

TEST(Ranks, SumsHaveTheSameBitsEverywhere)
{
  const Ranks ranks = Ranks::world();
  double expected = 0;
  for (int r = 0; r < ranks.size(); ++r) expected += part(r);
  std::vector<double> x = {part(ranks.rank()), 1.0, -0.5 * ranks.rank()};
  ranks.sum(x);
  EXPECT_EQ(x[0], expected);
  EXPECT_EQ(x[1], ranks.size());
  EXPECT_EQ(ranks.sum(part(ranks.rank())), expected);
  EXPECT_EQ(ranks.sum(std::int64_t{1} << 40), ranks.size() * (std::int64_t{1} << 40));
  std::vector<double> nothing;
  ranks.sum(nothing);
}

TEST(Ranks, NumbersBeforeLargestAndDecisions)
{
  const Ranks ranks = Ranks::world();
  const int last = ranks.size() - 1;
  EXPECT_EQ(ranks.before(ranks.rank() + 1), ranks.rank() * (ranks.rank() + 1) / 2);
  EXPECT_EQ(ranks.max(part(ranks.rank()) * 0 + ranks.rank()), last);
  EXPECT_TRUE(ranks.any(ranks.rank() == last));
  EXPECT_FALSE(ranks.any(false));
  EXPECT_TRUE(ranks.first_says(ranks.is_first()));
  EXPECT_EQ(ranks.first_says(!ranks.is_first()), false);
}

struct Item
{
  std::int64_t number;
  double value;
  char kind;
};

/// Rank r sends r + 2 s items to rank s, and none to some ranks.
TEST(Ranks, EveryItemArrivesOnceAndInOrder)
{
  const Ranks ranks = Ranks::world();
  const auto count = [](int from, int to) { return (from + to) % 3 == 1 ? 0 : from + 2 * to; };
  std::vector<std::vector<Item>> out(ranks.size());
  for (int r = 0; r < ranks.size(); ++r)
    for (int i = 0; i < count(ranks.rank(), r); ++i)
      out[r].push_back({1000 * ranks.rank() + i, 0.1 * r, static_cast<char>('a' + r)});
  const std::vector<std::vector<Item>> in = ranks.send(out);
  ASSERT_EQ(std::ssize(in), ranks.size());
  for (int r = 0; r < ranks.size(); ++r)
  {
    ASSERT_EQ(std::ssize(in[r]), count(r, ranks.rank()));
    for (int i = 0; i < count(r, ranks.rank()); ++i)
    {
      EXPECT_EQ(in[r][i].number, 1000 * r + i);
      EXPECT_EQ(in[r][i].value, 0.1 * ranks.rank());
      EXPECT_EQ(in[r][i].kind, 'a' + ranks.rank());
    }
  }
}

TEST(Ranks, GatheredOnTheFirstAndCopiedFromIt)
{
  const Ranks ranks = Ranks::world();
  std::vector<int> mine(ranks.rank() + 1);
  std::iota(mine.begin(), mine.end(), 10 * ranks.rank());
  const auto all = ranks.gather<int>(mine);
  std::vector<int> expected;
  for (int r = 0; r < ranks.size() && ranks.is_first(); ++r)
    for (int i = 0; i <= r; ++i) expected.push_back(10 * r + i);
  EXPECT_EQ(all, expected);
  std::vector<char> text;
  if (ranks.is_first()) text = {'c', 'a', 's', 'e'};
  ranks.copy_from_first(text);
  EXPECT_EQ(std::string(text.begin(), text.end()), "case");
}

/// The same call on every rank ends in the same kind of exception, whichever rank threw it.
TEST(Ranks, WhatOneRankThrowsAllThrow)
{
  const Ranks ranks = Ranks::world();
  const int last = ranks.size() - 1;
  const std::string who = ranks.rank() == last ? "" : "process " + std::to_string(last) + ": ";
  const auto last_throws = [&](const auto& error)
  {
    ranks.together(
        [&]
        {
          if (ranks.rank() == last) throw error;
        });
  };
  try
  {
    last_throws(InputError({"case.toml", "boundary.top", 7, 3}, "no such group", "did you mean \"up\"?"));
    FAIL();
  }
  catch (const InputError& error)
  {
    EXPECT_EQ(error.where().file, "case.toml");
    EXPECT_EQ(error.where().key, "boundary.top");
    EXPECT_EQ(error.where().line, 7);
    EXPECT_EQ(error.where().column, 3);
    EXPECT_EQ(error.problem(), who + "no such group");
    EXPECT_EQ(error.hint(), "did you mean \"up\"?");
  }
  try
  {
    last_throws(SolveError("singular"));
    FAIL();
  }
  catch (const SolveError& error)
  {
    EXPECT_EQ(error.what(), who + "singular");
  }
  EXPECT_THROW(last_throws(std::bad_alloc()), std::bad_alloc);
  EXPECT_THROW(last_throws(std::runtime_error("disk full")), std::runtime_error);
  EXPECT_EQ(ranks.together([&] { return 2 * ranks.rank(); }), 2 * ranks.rank());  // no messages are left
}

/// If several ranks fail, the others are told of the failure of the lowest rank.
TEST(Ranks, TheLowestRankIsHeard)
{
  const Ranks ranks = Ranks::world();
  if (ranks.size() < 3) return;
  try
  {
    ranks.together(
        [&]
        {
          if (ranks.rank() > 0) throw SolveError("of " + std::to_string(ranks.rank()));
        });
    FAIL();
  }
  catch (const SolveError& error)
  {
    EXPECT_EQ(error.what(),
              ranks.is_first() ? std::string("process 1: of 1") : "of " + std::to_string(ranks.rank()));
  }
}

}  // namespace
}  // namespace tribound::test
