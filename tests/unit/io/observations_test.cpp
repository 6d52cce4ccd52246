/// @file observations_test.cpp
/// Probes and sections in the certificate and as tables.

#include "tribound/io/record/observations_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tribound/io/record/level_json.h"

namespace tribound
{
namespace
{

using ::testing::HasSubstr;

io::LevelRecord plane_level()
{
  io::LevelRecord level;
  level.level = 3;
  level.probes = {{"p, q",
                   {{0,
                     {1, 2},
                     "a+b",
                     "a",
                     {0.5, -0.25},
                     {1, 2, 3, 4, 0, 0},
                     std::array<double, 6>{5, 6, 7, 8, 0, 0},
                     0.5},
                    {1, {4, 6}, "a+b", "b", {0, 1}, {1, 1, 1, 1, 0, 0}}}}};
  level.sections = {
      {"cut", 1.5, {2, -3}, {4}, {0.6, 0.8, -0.8, 0.6}, 5, {6}, {4}, "moments need degree 2 or more"}};
  return level;
}

TEST(Observations, AreTablesInThePlane)
{
  const nlohmann::json levels = {io::level_json(plane_level()), io::level_json(io::LevelRecord())};
  EXPECT_EQ(io::probes_csv(levels),
            "level,probe,point,body,region,distance,x,y,u_x,u_y,stress_xx,stress_yy,stress_zz,stress_xy,"
            "equilibrated_xx,equilibrated_yy,equilibrated_zz,equilibrated_xy,difference\n"
            "3,\"p, q\",0,a+b,a,0,1,2,0.5,-0.25,1,2,3,4,5,6,7,8,0.5\n"
            "3,\"p, q\",1,a+b,b,5,4,6,0,1,1,1,1,1,,,,,\n");
  EXPECT_EQ(io::sections_csv(levels),
            "level,section,measure,N,V,M,force_x,force_y,moment,in_equilibrium\n"
            "3,cut,1.5,5,6,4,2,-3,4,0\n");
}

TEST(Observations, AreTablesOfLoadStepsInSpace)
{
  io::LevelRecord step;
  step.level = 2;
  step.load_step.emplace().t = 0.5;
  step.probes = {{"p", {{0, {1, 2, 3}, "a", "a", {4, 5, 6}, {1, 2, 3, 4, 5, 6}}}}};
  step.sections = {{"cut", 1, {1, 2, 3}, {4, 5, 6}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1, {2, 3}, {4, 5, 6}, ""}};
  const nlohmann::json steps = {io::level_json(step)};
  EXPECT_THAT(io::probes_csv(steps), HasSubstr("\n2,0.5,p,0,a,a,0,1,2,3,4,5,6,1,2,3,4,5,6,,,,,,,\n"));
  EXPECT_EQ(io::sections_csv(steps),
            "step,t,section,measure,N,V_1,V_2,M_n,M_1,M_2,force_x,force_y,force_z,moment_x,moment_y,moment_z,"
            "in_equilibrium\n2,0.5,cut,1,1,2,3,4,5,6,1,2,3,4,5,6,1\n");
}

TEST(Observations, AreInTheCertificate)
{
  const nlohmann::json level = io::level_json(plane_level());
  EXPECT_EQ(level["probes"][0]["name"], "p, q");
  EXPECT_EQ(level["probes"][0]["points"][0]["stress"], (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(level["probes"][0]["points"][0]["equilibrated_stress"], (std::vector<double>{5, 6, 7, 8}));
  EXPECT_TRUE(level["probes"][0]["points"][1]["equilibrated_stress"].is_null());
  EXPECT_EQ(level["sections"][0]["note"], "moments need degree 2 or more");
  EXPECT_EQ(level["sections"][0]["in_equilibrium"], false);
  const nlohmann::json empty = io::level_json(io::LevelRecord());
  EXPECT_FALSE(empty.contains("probes"));
  EXPECT_FALSE(empty.contains("sections"));
  EXPECT_EQ(io::probes_csv({empty}), "");
  EXPECT_EQ(io::sections_csv({empty}), "");
}

}  // namespace
}  // namespace tribound
