#include "app/result/judged_steps.h"

#include <gmock/gmock.h>

#include "tribound/io/file/json.h"

namespace tribound::test
{
namespace
{

using app::JudgementRecord;
using testing::HasSubstr;

/// A step whose error is between `lower` and `upper`, relative, with the bound over the distance.
JudgementRecord judged(double t, double lower, double upper, double bound = 0.05)
{
  JudgementRecord step;
  step.t = t;
  step.load_step = static_cast<int>(t);
  step.sharpness = 0.1;
  step.target = "the exact solution";
  certify::Judgement& judgement = step.judgement.emplace();
  judgement.bound = bound;
  judgement.displacement.distance = 1;
  judgement.displacement.relative = {lower, upper};
  return step;
}

JudgementRecord without_bound(double t)
{
  JudgementRecord step;
  step.t = t;
  step.reason = "bonds soften";
  return step;
}

TEST(JudgedSteps, TheStatusIsTheWorst)
{
  const auto status = [](std::vector<JudgementRecord> steps, std::optional<double> accept = {})
  {
    for (JudgementRecord& step : steps) step.accept = accept;
    return app::common_status(steps);
  };
  EXPECT_EQ(status({judged(1, 0.1, 0.2)}), "judged");
  EXPECT_EQ(status({judged(1, 0.1, 0.2), judged(2, 0.1, 0.3)}), "judged");
  EXPECT_EQ(status({judged(1, 0.1, 0.2, 0.2), judged(2, 0.1, 0.3)}), "wide");
  EXPECT_EQ(status({judged(1, 0.1, 0.2), without_bound(2)}), "no bound");
  EXPECT_EQ(status({judged(1, 0.1, 0.2, 0.2), without_bound(2)}), "wide");
  EXPECT_EQ(status({judged(1, 0.1, 0.2), judged(2, 0.1, 0.3)}, 0.3), "accepted");
  EXPECT_EQ(status({judged(1, 0.1, 0.2), judged(2, 0.1, 0.3)}, 0.25), "undecided");
  EXPECT_EQ(status({judged(1, 0.1, 0.2), judged(2, 0.3, 0.4), without_bound(3)}, 0.25), "rejected");
  EXPECT_EQ(status({judged(1, 0.1, 0.2), without_bound(2)}, 0.25), "no bound");
}

TEST(JudgedSteps, TheWorstStepHasTheLargestError)
{
  const double unknown = std::numeric_limits<double>::infinity();
  const auto worst = [](const std::vector<JudgementRecord>& steps) { return app::worst_step(steps); };
  EXPECT_EQ(worst({judged(1, 0.1, 0.2), judged(2, 0.1, 0.3), judged(3, 0.2, 0.25)}), 1U);
  EXPECT_EQ(worst({without_bound(1), judged(2, 0.1, 0.3)}), 1U);
  EXPECT_EQ(worst({judged(1, 0.1, 0.3), judged(2, 0.1, unknown), without_bound(3)}), 1U);
  EXPECT_EQ(worst({without_bound(1), without_bound(2)}), 0U);
}

TEST(JudgedSteps, ARowForEach)
{
  const std::vector<JudgementRecord> steps = {judged(1, 0.1, 0.2), judged(2, 0.125, 0.25, 0.5),
                                              without_bound(3), without_bound(4)};
  const std::string text = app::judged_steps_text(steps, "out/judge");
  EXPECT_THAT(text, HasSubstr("errors        step  t    displacement    status\n"));
  EXPECT_THAT(text, HasSubstr("                 1  1    10 % to 20 %    judged\n"));
  EXPECT_THAT(text, HasSubstr("                 2  2  12.5 % to 25 %      wide\n"));
  EXPECT_THAT(text, HasSubstr("                 4  4        no bound  no bound\n"));
  EXPECT_THAT(text, HasSubstr("in steps      1, 2: against the exact solution\n"));
  EXPECT_THAT(text, HasSubstr("in steps      3, 4: not bounded: bonds soften\n"));
  EXPECT_THAT(text, HasSubstr("in step       2: wide: the bound is 0.5 of the distance"));
  const nlohmann::json object = app::judged_steps_object(steps);
  EXPECT_EQ(object["status"], "wide");
  EXPECT_EQ(object["worst"], 2);
  EXPECT_EQ(object["steps"].size(), 4U);
  EXPECT_EQ(object["steps"][2]["reason"], "bonds soften");
  EXPECT_EQ(object["steps"][1], nlohmann::json(app::judgement_object(steps[1])));
}

}  // namespace
}  // namespace tribound::test
