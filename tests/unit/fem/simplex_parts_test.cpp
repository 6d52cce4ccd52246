#include "tribound/fem/simplex_parts.h"

#include <gtest/gtest.h>

#include <random>

#include "support/dimensions.h"

namespace tribound::test
{

namespace
{

template <class Dimension>
class SimplexParts : public ::testing::Test
{
 public:
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }

 private:
  std::mt19937 random_{Dimension::value};
};

TYPED_TEST_SUITE(SimplexParts, AllDimensions, );

/// The parts from cuts along three random planes fill the simplex, and none crosses a plane.
TYPED_TEST(SimplexParts, CutAlongPlanesFillTheSimplexAndLieOnOneSide)
{
  constexpr int k = TypeParam::value;
  for (int trial = 0; trial < 200; ++trial)
  {
    std::vector<fem::Part<k>> parts{fem::reference_simplex<k>()};
    for (int plane = 0; plane < 3; ++plane)
    {
      Point<k> a;
      for (double& x : a) x = this->between(-1, 1);
      const double b = this->between(-0.3, 0.3);
      std::vector<fem::Part<k>> finer;
      for (const fem::Part<k>& part : parts)
      {
        std::array<double, k + 1> values;
        for (int i = 0; i <= k; ++i) values[i] = a.dot(part[i]) + b;
        fem::cut<k>(part, values, 1e-14, finer);
      }
      for (const fem::Part<k>& part : finer)
      {
        double lowest = 0;
        double highest = 0;
        for (const Point<k>& x : part)
        {
          lowest = std::min(lowest, a.dot(x) + b);
          highest = std::max(highest, a.dot(x) + b);
        }
        EXPECT_LE(std::min(-lowest, highest), 1e-13);
      }
      parts = finer;
    }
    double all = 0;
    for (const fem::Part<k>& part : parts) all += fem::fraction<k>(part);
    EXPECT_NEAR(all, 1, 1e-12);
  }
}

}  // namespace

}  // namespace tribound::test
