#include "app/command/step_pairs.h"

#include <gmock/gmock.h>

#include "tribound/base/error.h"

namespace tribound::test
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;

/// The steps of a file with these times.
std::vector<app::TheirStep> steps_at(const std::vector<double>& times)
{
  std::vector<app::TheirStep> steps;
  for (const double t : times)
    steps.push_back({"theirs.frd", mesh::SolutionStep{static_cast<int>(steps.size()) + 1, t}});
  return steps;
}

std::vector<std::size_t> pairs(const std::vector<double>& load_steps, const std::vector<double>& times)
{
  return app::pair_steps(load_steps, steps_at(times));
}

void expect_refusal(const std::vector<double>& load_steps, const std::vector<app::TheirStep>& theirs,
                    const std::string& words)
{
  try
  {
    (void)app::pair_steps(load_steps, theirs);
    ADD_FAILURE() << words;
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(StepPairs, TimesThatAreThoseOfTheCase)
{
  EXPECT_THAT(pairs({0.5, 1}, {0.5, 1}), ElementsAre(0, 1));
  EXPECT_THAT(pairs({0.5, 1}, {0, 0.25, 0.5, 0.75, 1}), ElementsAre(2, 4));
  EXPECT_THAT(pairs({1, 0.5}, {0.5, 1}), ElementsAre(1, 0));
  EXPECT_THAT(pairs({1.0 / 3}, {0.25, 0.333333}), ElementsAre(1));  // six digits of a .frd
}

TEST(StepPairs, InOrderWhereTimesAreOthersOrNumbers)
{
  EXPECT_THAT(pairs({0.25, 0.5}, {1, 2}), ElementsAre(0, 1));
  EXPECT_THAT(pairs({0.5, 1}, {1, 2}), ElementsAre(0, 1));
  EXPECT_THAT(pairs({10, 20}, {0.1, 0.7}), ElementsAre(0, 1));
  EXPECT_THAT(pairs({0, 1, 0, 1}, {0, 1, 0, 1}), ElementsAre(0, 1, 2, 3));  // a cycle
  EXPECT_THAT(app::pair_steps(std::vector{0.5, 1.0}, std::vector<app::TheirStep>{{"a.csv"}, {"b.csv"}}),
              ElementsAre(0, 1));
}

TEST(StepPairs, OthersAreRefusedWithBothLists)
{
  expect_refusal({0.5, 1}, steps_at({1, 2, 3}),
                 "theirs.frd: has 3 steps (t = 1, 2, 3), the case 2 load steps (t = 0.5, 1)");
  expect_refusal({0.5, 1}, steps_at({0, 0.5}), "has 2 steps (t = 0, 0.5)");  // begins with another state
  expect_refusal({0, 1, 0}, steps_at({0, 1}), "has 2 steps (t = 0, 1), the case 3 load steps (t = 0, 1, 0)");
  expect_refusal({0.5, 1}, {{"a.csv"}}, "a.csv: has 1 step, the case 2 load steps");
  expect_refusal({0.5, 1}, {{"a.csv"}, {"b.csv"}, {"c.csv"}}, "a.csv, ...: has 3 steps, the case");
  std::vector<double> many(20);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  expect_refusal({0.5}, steps_at(many), "has 20 steps (t = 0, 1, 2, 3, ..., 16, 17, 18, 19)");
}

}  // namespace
}  // namespace tribound::test
