#include "tribound/base/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tribound::test
{

namespace
{

TEST(ParallelFor, VisitsAll)
{
  std::vector<int> visits(5000, 0);
  parallel_for(visits.size(), [&](std::size_t i) { ++visits[i]; });
  EXPECT_EQ(visits, std::vector<int>(5000, 1));
}

TEST(ParallelFor, TheFirstFailureIsTheOneReported)
{
  for (const std::size_t n : {100U, 5000U}) try
    {
      parallel_for(n,
                   [](std::size_t i)
                   {
                     if (i % 7 == 6) throw std::runtime_error(std::to_string(i));
                   });
      FAIL() << "no exception";
    }
    catch (const std::runtime_error& error)
    {
      EXPECT_EQ(std::string(error.what()), "6");
    }
}

/// What would come after a failure can be expensive.
TEST(ParallelFor, NothingIsStartedBehindAFailure)
{
  std::vector<int> visits(100, 0);
  EXPECT_THROW(parallel_for(visits.size(),
                            [&](std::size_t i)
                            {
                              ++visits[i];
                              if (i == 10) throw std::runtime_error("10");
                            }),
               std::runtime_error);
  for (std::size_t i = 0; i < visits.size(); ++i) EXPECT_EQ(visits[i], i <= 10 ? 1 : 0);
}

}  // namespace

}  // namespace tribound::test
