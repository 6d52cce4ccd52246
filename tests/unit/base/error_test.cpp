#include "tribound/base/error.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tribound
{
namespace
{

TEST(Where, IsWrittenWithThePartsThatAreKnown)
{
  EXPECT_EQ(to_string(Where{"case.toml", "material.nu", 8, 6}), "case.toml:8:6: material.nu");
  EXPECT_EQ(to_string(Where{"case.toml", "material.nu", 8, 0}), "case.toml:8: material.nu");
  EXPECT_EQ(to_string(Where{"case.toml", "mesh", 0, 3}), "case.toml: mesh");
  EXPECT_EQ(to_string(Where{"case.toml", "", 0, 0}), "case.toml");
  EXPECT_EQ(to_string(Where{"", "mesh", 0, 0}), "mesh");
  EXPECT_EQ(to_string(Where{}), "");
}

TEST(InputError, SaysWhereWhatAndWhatWouldBeRight)
{
  const InputError error({"case.toml", "material.nu", 8, 6}, "must lie in (-1, 0.5), found 0.7",
                         "such as 0.3");
  EXPECT_STREQ(error.what(),
               "case.toml:8:6: material.nu: must lie in (-1, 0.5), found 0.7\n  hint: such as 0.3");
  EXPECT_EQ(error.where().line, 8);
  EXPECT_EQ(error.problem(), "must lie in (-1, 0.5), found 0.7");
  EXPECT_EQ(error.hint(), "such as 0.3");
}

TEST(InputError, LeavesOutWhatIsNotKnown)
{
  EXPECT_STREQ(InputError({}, "no mesh").what(), "no mesh");
  EXPECT_STREQ(InputError({"a.msh", "", 0, 0}, "no cells").what(), "a.msh: no cells");
}

TEST(Closest, FindsTheNearestName)
{
  const std::vector<std::string> names = {"tolerance", "marking", "theta", "max_levels", "max_dofs"};
  EXPECT_EQ(closest("tolerence", names), "tolerance");
  EXPECT_EQ(closest("tolerance", names), "tolerance");
  EXPECT_EQ(closest("max_dof", names), "max_dofs");
  EXPECT_EQ(closest("max_level", names), "max_levels");
  EXPECT_EQ(closest("tehta", names), "theta");
}

TEST(Closest, SuggestsNothingFarAway)
{
  const std::vector<std::string> names = {"tolerance", "marking"};
  EXPECT_EQ(closest("colour", names), "");
  EXPECT_EQ(closest("", names), "");
  EXPECT_EQ(closest("tolerance", {}), "");
}

}  // namespace
}  // namespace tribound
