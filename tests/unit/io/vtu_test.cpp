#include "io/vtu.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "io/vtu_file.h"

namespace tribound
{
namespace
{

TEST(Vtu, OutOfPlaneRatio)
{
  EXPECT_NEAR(out_of_plane_ratio(lame(2.0, 0.3, PlaneModel::strain)), 0.3, 1e-15);
  EXPECT_EQ(out_of_plane_ratio(lame(2.0, 0.3, PlaneModel::stress)), 0.0);
}

TEST(Vtu, VonMises)
{
  EXPECT_DOUBLE_EQ(von_mises({-3.0, 0.0, 0.0, 0.0, 0.0, 0.0}), 3.0);
  EXPECT_DOUBLE_EQ(von_mises({2.0, 2.0, 2.0, 0.0, 0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(von_mises({0.0, 0.0, 0.0, 0.0, 2.0, 0.0}), 2.0 * std::sqrt(3.0));
}

TEST(VtuFile, RefusesAnArrayOfWrongLength)
{
  const auto path = std::filesystem::path(::testing::TempDir()) / "wrong.vtu";
  for (const int n : {2, 4})
  {
    VtuGrid grid;
    grid.points = {vtu_array<double>("Points", 1, 3,
                                     [n](const auto& put)
                                     {
                                       for (int i = 0; i < n; ++i) put(i);
                                     })};
    EXPECT_THROW(write_vtu(path, grid), std::logic_error);
    EXPECT_FALSE(std::filesystem::exists(path));
  }
}

}  // namespace
}  // namespace tribound
