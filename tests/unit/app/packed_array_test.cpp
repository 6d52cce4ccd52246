#include "app/page/packed_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "unit/app/packed_array.h"

namespace tribound::test
{
namespace
{

using ::testing::ElementsAreArray;

std::string base64_of(const std::string& text)
{
  return app::base64(std::as_bytes(std::span(text)));
}

TEST(PackedArray, Base64OfRfc4648)
{
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("\xfb\xff"), "+/8=");
}

TEST(PackedArray, LinearIsOffByAtMostHalfAStep)
{
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(3.0 + std::sin(0.7 * i));
  for (const int bits : {1, 8, 12, 16, 20, 24, 31})
  {
    const std::vector<double> read = unpack(app::pack_linear(values, bits));
    ASSERT_EQ(read.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(read[i], values[i], 1.0001 * 2.0 / (std::ldexp(2.0, bits) - 2.0)) << bits;
  }
}

TEST(PackedArray, LinearOfOneValueAndOfNone)
{
  EXPECT_THAT(unpack(app::pack_linear(std::vector{0.1, 0.1}, 16)), ElementsAreArray(std::vector{0.1, 0.1}));
  EXPECT_TRUE(unpack(app::pack_linear({}, 16)).empty());
}

TEST(PackedArray, LogarithmicKeepsRelativePrecisionOverDecades)
{
  const std::vector<double> values = {0.0, 1e-3, 2.5e-1, 1.0, 4.0, 1e-20};
  const std::vector<double> read = unpack(app::pack_logarithmic(values, 10, 8));
  for (const std::size_t i : {1, 2, 3, 4}) EXPECT_NEAR(read[i] / values[i], 1.0, 0.01);
  EXPECT_EQ(read[0], 0.0);
  EXPECT_EQ(read[5], 0.0);  // beyond the decades
}

TEST(PackedArray, LogarithmicOfZeros)
{
  EXPECT_THAT(unpack(app::pack_logarithmic(std::vector{0.0, 0.0}, 10, 8)),
              ElementsAreArray(std::vector{0.0, 0.0}));
}

TEST(PackedArray, IntegersAreExact)
{
  const std::vector<Index> values = {0, 7, 3, 1'000'000, 2, 2, std::numeric_limits<Index>::max(), 0};
  for (const std::size_t stride : {1, 2, 3})
    EXPECT_THAT(unpack(app::pack_integers(values, stride)), ElementsAreArray(values));
}

TEST(PackedArray, NumbersOfNeighboursTakeFewBytes)
{
  std::vector<Index> triangles;
  for (Index t = 0; t < 10'000; ++t)
    for (const Index v : {t, t + 1, t + 500}) triangles.push_back(v);
  EXPECT_LT(app::pack_integers(triangles, 3).dump().size(), 1000u);
}

}  // namespace
}  // namespace tribound::test
