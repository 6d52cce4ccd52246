#include "app/result/verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tribound::verification_cases
{
namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

app::Verification example()
{
  app::Verification v;
  v.facts = {"Block", "case.toml", 2, 1, "tresca", 10.0};
  v.mesh.cells = 16;
  v.mesh.free_dofs = 24;
  v.refinements = 2;
  v.dual_space = {3, 256, 2450};
  v.iterates = {{{1, 0.25, 1.0, 1, true, 0.1}, 0.375, 0.5, 0.25, {1.0, 1.0, 0.0}, 1e-15},
                {{2, 1e-12, 1.0, 1, true, 0.1}, 0.05, 0.06, 0.04, {1.0, 1.0, 0.0}, 2e-15}};
  v.converged = true;
  v.richer_degree = 2;
  v.richer = certify::RicherSolution{256, 1100, 4, {}, certify::SolutionError{0.02, 0.025}};
  v.times = {{"solve", 0.5}};
  return v;
}

TEST(Verification, TheTextIsATableOfTheIterates)
{
  EXPECT_EQ(app::verification_text(example(), "out/verify.json"),
            "dual norm     from below, degree 3 on 256 cells (2 refinements), 2450 degrees of freedom\n"
            "step   residual   plain bound         bound     dual norm  effectivity  identities\n"
            "   1  2.500e-01           0.5         0.375          0.25       1.5000     1.0e-15\n"
            "   2  1.000e-12          0.06          0.05          0.04       1.2500     2.0e-15\n"
            "||sigma||     1; bound / ||sigma|| = 0.05\n"
            "richer        degree 2 on 256 cells, 1100 free degrees of freedom, 4 Newton steps\n"
            "energy error  0.02\n"
            "stress error  0.025, 0.025 of ||sigma||; bound / error = 2\n"
            "status        the bound holds at every iterate, effectivity 1.2500 to 1.5000\n"
            "results       out/verify.json\n");
}

TEST(Verification, AnEffectivityBelowOneViolatesTheGuarantee)
{
  app::Verification v = example();
  EXPECT_EQ(app::violation(v), "");
  v.iterates[0].dual_norm = 0.4375;
  EXPECT_THAT(app::violation(v),
              AllOf(HasSubstr("guarantee is violated"), HasSubstr("step 1"), HasSubstr("0.4375")));
  EXPECT_THAT(app::verification_text(v, ""),
              AllOf(HasSubstr("status        the guarantee is violated"), Not(HasSubstr("the bound holds"))));
  EXPECT_EQ(nlohmann::json::parse(app::verification_json(v))["guarantee"], "violated");
}

TEST(Verification, WhatRunWouldRefuseIsRefused)
{
  app::Verification v = example();
  v.iterates[1].identities = 1.1e-8;
  EXPECT_THAT(app::violation(v), HasSubstr("an identity of the equilibrated stress is violated"));
  EXPECT_EQ(nlohmann::json::parse(app::verification_json(v))["guarantee"], "not certified");
  v.iterates[1].norms.round_off = 1.5;  // of a stress of norm 1: everything is rounding
  EXPECT_EQ(app::violation(v), "");
}

TEST(Verification, RoundOffHasNoEffectivity)
{
  app::Verification v = example();
  for (app::VerifiedIterate& iterate : v.iterates) iterate.bound = iterate.dual_norm = 1e-13;
  v.iterates[1].dual_norm = 3e-13;
  EXPECT_EQ(app::violation(v), "");
  EXPECT_THAT(app::verification_text(v, ""), HasSubstr("bound and dual norm are both round-off"));
  EXPECT_TRUE(nlohmann::json::parse(app::verification_json(v))["effectivity"].is_null());
}

TEST(Verification, Json)
{
  app::Verification v = example();
  const auto json = nlohmann::json::parse(app::verification_json(v));
  EXPECT_EQ(json["guarantee"], "holds");
  EXPECT_EQ(json["bound"], 0.05);
  EXPECT_EQ(json["effectivity"], 1.25);
  EXPECT_EQ(json["dual_space"]["dofs"], 2450);
  EXPECT_EQ(json["richer_solution"]["energy_error"], 0.02);
  ASSERT_EQ(json["iterates"].size(), 2u);
  EXPECT_EQ(json["iterates"][0]["effectivity"], 1.5);
  EXPECT_EQ(json["times"]["solve"], 0.5);

  v.richer->error.reset();
  v.richer->failure = "step 50 was the last";
  EXPECT_TRUE(nlohmann::json::parse(app::verification_json(v))["richer_solution"]["stress_error"].is_null());
  EXPECT_THAT(app::verification_text(v, ""), HasSubstr("no solution: step 50 was the last"));

  v.richer.reset();
  EXPECT_TRUE(nlohmann::json::parse(app::verification_json(v))["richer_solution"].is_null());
  EXPECT_THAT(app::verification_text(v, ""), HasSubstr("not computed"));
}

}  // namespace
}  // namespace tribound::verification_cases
