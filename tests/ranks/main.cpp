/// @file main.cpp
/// GoogleTest on every rank; ranks other than the first report only failures.

#include <gtest/gtest.h>

#include "tribound/algebra/petsc.h"
#include "tribound/base/ranks.h"

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  const tribound::algebra::Environment environment;
  if (!tribound::Ranks::world().is_first()) GTEST_FLAG_SET(brief, true);
  return RUN_ALL_TESTS();
}
