#include "tribound/base/parallel.h"

#include <gtest/gtest.h>
#include <omp.h>

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

/// Work after a failure could be expensive.
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

/// Terms whose sum depends on the order: summation in blocks changes the last digits.
TEST(ParallelSum, IsTheSameForAnyNumberOfThreads)
{
  const int available = omp_get_max_threads();
  for (const std::size_t n : {0U, 1U, 63U, 64U, 65U, 100'003U})
  {
    const auto sum = [&](int n_threads)
    {
      omp_set_num_threads(n_threads);
      return parallel_sum(n, 0.0, [](std::size_t i) { return 1 / (1.0 + static_cast<double>(i)); });
    };
    double expected = 0;
    for (std::size_t i = 0; i < n; ++i) expected += 1 / (1.0 + static_cast<double>(i));
    const double alone = sum(1);
    EXPECT_NEAR(alone, expected, 1e-12);
    for (const int n_threads : {2, 3, 8}) EXPECT_EQ(sum(n_threads), alone);
  }
  omp_set_num_threads(available);
}

}  // namespace

}  // namespace tribound::test
