/// @file memory_test.cpp
/// Limits of control groups, read from files like those of the system.

#include "tribound/base/memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

namespace tribound
{
namespace
{

/// A folder of its own for each test.
class ControlGroups : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    root_ =
        std::filesystem::path(::testing::TempDir()) /
        ("control_groups_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(root_);
  }

  void TearDown() override { std::filesystem::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const
  {
    std::filesystem::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text << '\n';
  }

  [[nodiscard]] double limit(const std::string& groups) const
  {
    write("groups", groups);
    return control_group_memory(root_ / "groups", root_);
  }

 private:
  std::filesystem::path root_;
};

TEST_F(ControlGroups, OfVersion2)
{
  write("job/step/memory.max", "max");
  write("job/memory.max", "4000000000");
  EXPECT_EQ(limit("0::/job/step"), 4e9);
  EXPECT_TRUE(std::isinf(limit("0::/other")));
}

TEST_F(ControlGroups, OfVersion1)
{
  write("memory/memory.limit_in_bytes", "9223372036854771712");  // means no limit
  write("memory/job/memory.limit_in_bytes", "2000000000");
  EXPECT_EQ(limit("5:cpu,memory:/job\n1:pids:/\n0::/"), 2e9);
  EXPECT_GT(limit("5:memory:/"), 1e18);
  EXPECT_TRUE(std::isinf(limit("5:cpuset:/job")));
}

TEST_F(ControlGroups, WithoutAny)
{
  EXPECT_TRUE(std::isinf(control_group_memory("/does/not/exist", "/does/not/exist")));
}

TEST(Memory, ThereIsSome)
{
  EXPECT_GT(machine_memory(), 0);
  EXPECT_LE(machine_memory(), physical_memory());
  EXPECT_LE(peak_memory(), physical_memory());
}

}  // namespace
}  // namespace tribound
