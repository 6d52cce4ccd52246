/// @file findings_output_test.cpp
/// The doctor's findings, on the screen and as JSON.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "app/console/console.h"

namespace tribound
{
namespace
{

TEST(Findings, OnTheScreen)
{
  const std::vector<doctor::Finding> some = {
      {"a", doctor::Severity::ok, "all is well", {}, {}, {}},
      {"b", doctor::Severity::warning, "something is odd", {}, {}, "mend it"}};
  EXPECT_EQ(app::findings_text(some),
            "findings\n"
            "  ok          all is well\n"
            "  warning     something is odd\n"
            "              -> mend it\n"
            "in all        1 warning, 0 notes\n");
}

TEST(Findings, AsJson)
{
  const std::vector<doctor::Finding> some = {
      {"a", doctor::Severity::ok, "all is well", {}, {}, {}},
      {"b", doctor::Severity::warning, "odd", {{"kink", 2.5}}, {1, 0.5}, "mend it"}};
  const auto json = nlohmann::json::parse(
      app::check_json({"T", "case.toml", 2, 1, certify::PatchStress::rows, "none", 10}, {}, "direct", some));
  EXPECT_EQ(json["title"], "T");
  EXPECT_EQ(json["solver"], "direct");
  EXPECT_EQ(json["warnings"], 1);
  EXPECT_TRUE(json["mesh"].contains("vertices"));
  EXPECT_EQ(json["findings"][0]["severity"], "ok");
  EXPECT_TRUE(json["findings"][0]["where"].is_null());
  EXPECT_TRUE(json["findings"][0]["advice"].is_null());
  EXPECT_EQ(json["findings"][1]["code"], "b");
  EXPECT_EQ(json["findings"][1]["numbers"]["kink"], 2.5);
  EXPECT_EQ(json["findings"][1]["where"], (std::vector<double>{1, 0.5}));
}

TEST(RunWarnings, InTheCertificateAndOnTheScreen)
{
  io::RunRecord run;
  run.warnings = {{"sliding", doctor::Severity::warning, "all slides", {{"value", 1}}},
                  {"osc", doctor::Severity::warning, "coarse", {{"value", 0.75}}}};
  run.warnings[0].boundary = "base";
  const auto json = nlohmann::json::parse(io::certificate_json(run))["warnings"];
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["code"], "sliding");
  EXPECT_EQ(json[0]["where"], "boundary \"base\"");
  EXPECT_EQ(json[1]["value"], 0.75);
  EXPECT_TRUE(json[1]["where"].is_null());
  EXPECT_EQ(app::warnings_text(run.warnings),
            "warning       boundary \"base\": all slides\n"
            "warning       coarse\n");
}

}  // namespace
}  // namespace tribound
