#include "tribound/io/fields/vtu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/vtu_file.h"

namespace fs = std::filesystem;

namespace tribound
{
namespace
{

TEST(Vtu, OutOfPlaneRatio)
{
  EXPECT_NEAR(io::out_of_plane_ratio(problem::lame(2.0, 0.3, problem::PlaneModel::strain)), 0.3, 1e-15);
  EXPECT_EQ(io::out_of_plane_ratio(problem::lame(2.0, 0.3, problem::PlaneModel::stress)), 0.0);
}

TEST(Vtu, VonMises)
{
  EXPECT_DOUBLE_EQ(io::von_mises({-3.0, 0.0, 0.0, 0.0, 0.0, 0.0}), 3.0);
  EXPECT_DOUBLE_EQ(io::von_mises({2.0, 2.0, 2.0, 0.0, 0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(io::von_mises({0.0, 0.0, 0.0, 0.0, 2.0, 0.0}), 2.0 * std::sqrt(3.0));
}

TEST(Vtu, PrincipalStresses)
{
  using ::testing::DoubleNear;
  using ::testing::ElementsAre;
  EXPECT_THAT(io::principal_stresses({-3.0, 1.0, 2.0, 0.0, 0.0, 0.0}),
              ElementsAre(DoubleNear(2, 1e-14), DoubleNear(1, 1e-14), DoubleNear(-3, 1e-14)));
  EXPECT_THAT(io::principal_stresses({0.0, 0.0, 0.0, 0.0, 2.0, 0.0}),
              ElementsAre(DoubleNear(2, 1e-14), DoubleNear(0, 1e-14), DoubleNear(-2, 1e-14)));
  EXPECT_THAT(io::principal_stresses({1.0, 1.0, 2.5, -2.0, 0.0, 0.0}),
              ElementsAre(DoubleNear(3, 1e-14), DoubleNear(2.5, 1e-14), DoubleNear(-1, 1e-14)));
  // 4, 1, 1 in a basis rotated about (1, 1, 1).
  EXPECT_THAT(io::principal_stresses({2.0, 2.0, 2.0, 1.0, 1.0, 1.0}),
              ElementsAre(DoubleNear(4, 1e-7), DoubleNear(1, 1e-7), DoubleNear(1, 1e-7)));
}

#ifndef NDEBUG
/// A programming error.
TEST(VtuFileDeathTest, AnArrayOfAnotherLengthThanAnnouncedIsAsserted)
{
  const auto path = std::filesystem::path(::testing::TempDir()) / "wrong.vtu";
  for (const int n : {2, 4})
  {
    io::VtuGrid grid;
    grid.points = {io::vtu_array<double>("Points", 1, 3,
                                         [n](const auto& put)
                                         {
                                           for (int i = 0; i < n; ++i) put(i);
                                         })};
    EXPECT_DEATH(io::write_vtu(path, grid), "announced|header_");
    EXPECT_FALSE(std::filesystem::exists(path));
  }
}
#endif

TEST(VtuSeries, RemovesOnlyWhatARunHasWritten)
{
  const fs::path directory = fs::path(::testing::TempDir()) / "old_series";
  fs::remove_all(directory);
  fs::create_directories(directory / "level_004.vtu");  // a directory
  const std::set<std::string> kept = {"level_01.vtu",     "level_abc.vtu",   "level_001.vtu.bak",
                                      "my_level_001.vtu", "contact_0x1.vtu", "contact_.vtu",
                                      "contact.csv",      "levels_001.vtu",  "certificate.json",
                                      "level_0011.vtux",  "level_-01.vtu",   "level_.vtu"};
  for (const std::string& name : kept) io::write_file(directory / name, "");
  for (const int level : {0, 12, 1234})
    for (const char* stem : {"level", "contact"})
      io::write_file(directory / io::level_file_name(stem, level), "");
  io::write_series(directory, 0, 2);

  io::remove_series(directory, 1234);
  for (const char* stem : {"level", "contact"})
    EXPECT_TRUE(fs::exists(directory / io::level_file_name(stem, 12)) &&
                !fs::exists(directory / io::level_file_name(stem, 1234)));
  io::remove_series(directory);
  std::set<std::string> left;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.is_regular_file()) left.insert(entry.path().filename().string());
  EXPECT_EQ(left, kept);
  EXPECT_TRUE(fs::exists(directory / "level_004.vtu"));
  io::remove_series(directory / "does_not_exist");  // nothing to do
  fs::remove_all(directory);
}

TEST(Series, ListsTheLevelsThatAreThere)
{
  const fs::path directory = fs::path(::testing::TempDir()) / "series_of_one";
  fs::create_directories(directory);
  io::write_file(directory / "level_007.vtu", "");
  io::write_series(directory, 7, 9);
  std::ifstream file(directory / "series.pvd");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, ::testing::HasSubstr(R"(timestep="7" part="0" file="level_007.vtu")"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("level_006")));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("level_008")));
  fs::remove_all(directory);
}

}  // namespace
}  // namespace tribound
