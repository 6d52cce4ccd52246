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
  v.facts = {"Block", "case.toml", 2, 1, certify::PatchStress::rows, "tresca", 10.0};
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
  v.iterates[1].norms.round_off = 1.5;  // the stress has norm 1: everything is rounding
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

/// The bound of an iterate with one quantity, in [lower, upper].
certify::EnergyBound with_interval(double value, double lower, double upper)
{
  certify::EnergyBound bound{.bound = 0.03};
  bound.quantities = {
      {.name = "thrust", .value = value, .lower = lower, .upper = upper, .basis = "energy bound"}};
  return bound;
}

/// Intervals of both iterates; the richer solution lies in a narrow interval.
app::Verification example_with_quantity()
{
  app::Verification v = example();
  v.iterates[0].energy = with_interval(0.5, 0, 2);
  v.energy = v.iterates[1].energy = with_interval(0.9, 0.75, 1.25);
  v.richer_energy = with_interval(1, 0.96875, 1.03125);
  return v;
}

TEST(Verification, IntervalsThatHoldTheRicherSolution)
{
  const app::Verification v = example_with_quantity();
  EXPECT_EQ(app::violation(v), "");
  EXPECT_THAT(app::verification_text(v, ""),
              AllOf(HasSubstr("quantities    thrust: 1, guaranteed between 0.75 and 1.25 (energy bound): "
                              "holds, at 50 % of it\n"),
                    HasSubstr("; so do the intervals that can be compared\n")));
  const auto json = nlohmann::json::parse(app::verification_json(v));
  EXPECT_EQ(json["guarantee"], "holds");
  const auto of_solution =
      nlohmann::json::parse(R"([{"name": "thrust", "value": 0.9, "lower": 0.75, "upper": 1.25,
    "exact": false, "richer_value": 1.0, "richer_lower": 0.96875, "richer_upper": 1.03125, "holds": true,
    "position": 0.5, "reason": null}])");
  EXPECT_EQ(json["quantities"], of_solution);
  EXPECT_EQ(json["iterates"][1]["quantities"], of_solution);
  EXPECT_EQ(json["iterates"][0]["quantities"][0]["position"], 0.5);
  EXPECT_EQ(json["iterates"][0]["quantities"][0]["value"], 0.5);
}

TEST(Verification, NumbersCarryTheirUnits)
{
  app::Verification v = example_with_quantity();
  EXPECT_TRUE(nlohmann::json::parse(app::verification_json(v))["units"].is_null());
  v.facts.dimension = 2;
  v.facts.units = {"mm", "N"};
  v.facts.quantity_units = {{"thrust", "N/mm"}};
  EXPECT_THAT(app::verification_text(v, ""),
              AllOf(HasSubstr(" MPa mm; bound / ||sigma|| = "), HasSubstr("thrust: 1 N/mm, guaranteed"),
                    HasSubstr("; bound 0.03 (N mm/mm)^(1/2)")));
  EXPECT_EQ(nlohmann::json::parse(app::verification_json(v))["units"]["quantities"]["thrust"], "N/mm");
}

TEST(Verification, AWrongIntervalOfAnyIterateViolatesTheGuarantee)
{
  app::Verification v = example_with_quantity();
  v.iterates[0].energy = with_interval(0.5, 0.25, 0.9375);
  EXPECT_THAT(
      app::violation(v),
      AllOf(HasSubstr("guarantee is violated: after Newton step 1 the interval [0.25, 0.9375] of \"thrust\""),
            HasSubstr("[0.96875, 1.03125]")));
  v = example_with_quantity();
  v.iterates[1].energy = with_interval(0.9, 1.0625, 1.25);
  EXPECT_THAT(app::violation(v), HasSubstr("after Newton step 2"));
  EXPECT_THAT(app::verification_text(v, ""),
              AllOf(HasSubstr("violated: the richer solution is in [0.96875, 1.03125]"),
                    Not(HasSubstr("so do the intervals"))));
  const auto json = nlohmann::json::parse(app::verification_json(v));
  EXPECT_EQ(json["guarantee"], "violated");
  EXPECT_EQ(json["quantities"][0]["holds"], false);
}

TEST(Verification, TheRicherSolutionHasAnIntervalItself)
{
  app::Verification v = example_with_quantity();
  v.iterates[1].energy = with_interval(0.9, 0.75, 0.984375);  // its value is outside, its interval is not
  EXPECT_EQ(app::violation(v), "");
  EXPECT_THAT(
      app::verification_text(v, ""),
      HasSubstr(
          "holds a part of [0.96875, 1.03125], that of the richer solution, whose value is at 107 % of it"));
}

TEST(Verification, WhatCannotBeComparedIsNoViolation)
{
  app::Verification v = example_with_quantity();
  for (app::VerifiedIterate& iterate : v.iterates)
  {
    iterate.energy = with_interval(0.5, 0.25, 0.75);
    iterate.energy->target = certify::EnergyTarget::computed_friction;
  }
  EXPECT_EQ(app::violation(v), "");
  EXPECT_THAT(app::verification_text(v, ""),
              AllOf(HasSubstr("not compared: both are of their computed friction"),
                    Not(HasSubstr("so do the intervals"))));
  auto json = nlohmann::json::parse(app::verification_json(v))["quantities"][0];
  EXPECT_TRUE(json["holds"].is_null());
  EXPECT_EQ(json["position"], 1.5);

  v.iterates[1].energy->quantities[0].reason = "contact alone holds a body";
  EXPECT_THAT(app::verification_text(v, ""), HasSubstr("thrust: 0.5, without error bar: contact alone"));
  json = nlohmann::json::parse(app::verification_json(v))["quantities"][0];
  EXPECT_TRUE(json["lower"].is_null() && json["position"].is_null());
  EXPECT_EQ(json["reason"], "contact alone holds a body");
  EXPECT_EQ(json["richer_value"], 1);

  v.richer_energy = certify::EnergyBound{.reason = "out of memory"};
  json = nlohmann::json::parse(app::verification_json(v))["iterates"][0]["quantities"][0];
  EXPECT_EQ(json["reason"], "out of memory");
  EXPECT_TRUE(json["richer_value"].is_null());
  v.richer_energy.reset();
  json = nlohmann::json::parse(app::verification_json(v))["iterates"][0]["quantities"][0];
  EXPECT_EQ(json["reason"], "there is no richer solution");
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
