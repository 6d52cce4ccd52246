/// The script that draws figures gets its argument unchanged, and its failure is reported.

#include "app/result/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace tribound
{
namespace
{

/// A directory with a name that a shell would change, and a script in it.
class Figures : public ::testing::Test
{
 protected:
  Figures()
  {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }

  [[nodiscard]] std::filesystem::path script(const std::string& body) const
  {
    const std::filesystem::path path = directory_ / "draw";
    std::ofstream(path) << "#!/bin/sh\n" << body;
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
  }

  std::filesystem::path directory_ =
      std::filesystem::path(::testing::TempDir()) /
      ("a $(study); 'of' two " +
       std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(Figures, TheScriptGetsTheDirectory)
{
  EXPECT_EQ(app::run_figure_script(script("echo drawn > \"$1/figure.svg\""), directory_), "");
  EXPECT_TRUE(std::filesystem::exists(directory_ / "figure.svg"));
}

TEST_F(Figures, WhatGoesWrongIsTold)
{
  EXPECT_EQ(app::run_figure_script(script("exit 3"), directory_), "ended with exit code 3");
  EXPECT_EQ(app::run_figure_script(script("kill -9 $$"), directory_), "was ended by signal 9 (Killed)");
  EXPECT_THAT(app::run_figure_script(directory_ / "missing", directory_),
              ::testing::HasSubstr("cannot be started"));
}

}  // namespace
}  // namespace tribound
