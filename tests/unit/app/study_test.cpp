#include "app/result/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

namespace tribound
{
namespace
{

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A level with an energy error of 1 / dofs, a bound of 3 / dofs and a dual norm of 2 / dofs.
app::StudiedLevel level(int number, long dofs, int newton_steps)
{
  app::StudiedLevel result;
  result.record.level = number;
  result.record.cells = dofs / 2;
  result.record.dofs = dofs;
  result.record.newton.resize(newton_steps);
  result.record.figures.sigma_norm = 2;
  const double size = 1.0 / static_cast<double>(dofs);
  result.record.bound = certify::Bound{{.str = 2 * size}, 4 * size, 3 * size};
  result.record.times = {.stages = {.solve = 0.5, .certify = 0.25}, .level = 1.0};
  result.error = certify::SolutionError{size, 1.5 * size};
  result.dual_norm = 2 * size;
  return result;
}

app::Study example()
{
  app::Study study;
  study.facts = {"Block", "case.toml", 2, 1, certify::PatchStress::rows, "tresca", 10.0};
  study.gamma_lin = 0.1;
  study.marking = "doerfler";
  study.theta = 0.6;
  study.variants = {
      {"adaptive", certify::RunStatus::certified, {}, {level(0, 16, 3), level(1, 64, 2), level(2, 256, 2)}},
      {"adaptive_converged", certify::RunStatus::certified, {}, {level(0, 16, 5), level(1, 64, 4)}},
      {"uniform", certify::RunStatus::budget, "too large", {level(0, 16, 3)}}};
  study.variants[0].levels[1].error->energy *= 1.03;
  study.reference = app::StudyReference{2, level(7, 4096, 1).record, 0.002, true, {}};
  study.reference->level.figures.energy = 0.125;
  study.times = {{"adaptive", 1.5}};
  return study;
}

std::vector<std::vector<std::string>> cells(const std::string& csv)
{
  std::vector<std::vector<std::string>> rows;
  std::istringstream stream(csv);
  for (std::string line; std::getline(stream, line);)
  {
    rows.emplace_back();
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

TEST(Study, CsvHasARowPerVariantAndLevel)
{
  const auto rows = cells(app::study_csv(example()));
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_THAT(rows[0],
              ElementsAre("variant", "level", "cells", "dofs", "newton_steps", "osc", "str", "neu", "lin1",
                          "cnt", "frc", "lin2n", "lin2t", "quad", "alg", "total", "total_sharp", "relative",
                          "energy_error", "stress_error", "dual_norm", "effectivity", "effectivity_stress",
                          "energy_bound", "energy_effectivity", "intervals_agree", "rate_error", "rate_bound",
                          "t_solve", "t_certify", "t_level"));
  EXPECT_THAT(rows[1], ElementsAre("adaptive", "0", "8", "16", "3", "0", "0.125", "0", "0", "0", "0", "0",
                                   "0", "0", "0", "0.25", "0.1875", "0.09375", "0.0625", "0.09375", "0.125",
                                   "1.5", "2", "", "", "", "", "", "0.5", "0.25", "1"));
  EXPECT_NEAR(std::stod(rows[3][27]), -1, 1e-14);  // the rate of the bound
  EXPECT_EQ(rows[6][0], "uniform");
}

TEST(Study, OfTheRegularisedVariantHasItsColumnsAtTheEnd)
{
  const auto plain = cells(app::study_csv(example()));
  app::Study study = example();
  for (app::StudyVariant& variant : study.variants)
    for (app::StudiedLevel& level : variant.levels) level.record.delta_updates = 2;
  study.variants[0].levels[0].record.bound->global.reg2n = 0.25;
  study.variants[0].levels[0].record.newton.back().step.delta = 0.125;
  const auto rows = cells(app::study_csv(study));
  std::vector<std::string> columns = plain[0];
  columns.insert(columns.end(), {"reg1", "reg2n", "reg2t", "delta", "delta_updates"});
  EXPECT_EQ(rows[0], columns);
  EXPECT_EQ(rows[1].size(), columns.size());
  EXPECT_THAT(std::span(rows[1]).last(5), ElementsAre("0", "0.25", "0", "0.125", "2"));
}

TEST(Study, WhatIsNotKnownIsEmptyInTheTableAndNullInJson)
{
  app::Study study = example();
  study.reference.reset();
  app::StudiedLevel& first = study.variants[0].levels[0];
  first.error.reset();
  first.dual_norm.reset();
  const auto row = cells(app::study_csv(study))[1];
  for (const int column : {18, 19, 20, 21, 22, 23, 24, 25, 26, 27}) EXPECT_EQ(row[column], "") << column;
  const auto json = nlohmann::json::parse(app::study_json(study));
  EXPECT_TRUE(json["reference"].is_null());
  for (const char* name : {"energy_error", "stress_error", "dual_norm", "effectivity", "effectivity_stress"})
    EXPECT_TRUE(json["variants"]["adaptive"]["levels"][0][name].is_null()) << name;
  EXPECT_TRUE(json["variants"]["uniform"]["rates"]["error"].is_null());  // only one level
}

TEST(Study, JsonHasTheFieldsOfTheTable)
{
  const app::Study study = example();
  const auto json = nlohmann::json::parse(app::study_json(study));
  EXPECT_EQ(json["d"], 2);
  EXPECT_EQ(json["gamma_lin"], 0.1);
  EXPECT_EQ(json["guarantee"], "holds");
  EXPECT_EQ(json["reference"]["degree"], 2);
  EXPECT_EQ(json["reference"]["energy"], 0.125);
  EXPECT_EQ(json["reference"]["fine_enough"], true);
  EXPECT_EQ(json["variants"]["uniform"]["status"], "budget");
  EXPECT_EQ(json["variants"]["uniform"]["reason"], "too large");
  EXPECT_NEAR(json["variants"]["adaptive"]["rates"]["bound"].get<double>(), -1, 1e-14);
  auto header = cells(app::study_csv(study))[0];
  header.erase(header.begin());
  const auto& first = json["variants"]["adaptive"]["levels"][0];
  EXPECT_EQ(first.size(), header.size());
  for (const std::string& name : header) EXPECT_TRUE(first.contains(name)) << name;
}

TEST(Study, ComparesWithAndWithoutTheCriterion)
{
  const auto json = nlohmann::json::parse(app::study_json(example()));
  ASSERT_EQ(json["newton_table"].size(), 3u);
  EXPECT_EQ(json["newton_table"][1]["adaptive"], 2);
  EXPECT_EQ(json["newton_table"][1]["adaptive_converged"], 4);
  EXPECT_TRUE(json["newton_table"][2]["adaptive_converged"].is_null());
  EXPECT_TRUE(json["newton_table"][0]["uniform_converged"].is_null());
  ASSERT_EQ(json["difference"]["adaptive"].size(), 3u);
  EXPECT_EQ(json["difference"]["adaptive"][0], 0.0);
  EXPECT_NEAR(json["difference"]["adaptive"][1].get<double>(), 0.03, 1e-14);
  EXPECT_TRUE(json["difference"]["adaptive"][2].is_null());  // without the criterion there is no mesh as fine
  EXPECT_TRUE(json["difference"]["uniform"].is_null());
}

TEST(Study, ComparesErrorsAtTheSameNumberOfUnknowns)
{
  const app::StudyVariant with{
      "adaptive", certify::RunStatus::certified, {}, {level(0, 16, 1), level(1, 100, 1)}};
  const app::StudyVariant without{"adaptive_converged",
                                  certify::RunStatus::certified,
                                  {},
                                  {level(0, 16, 1), level(1, 60, 1), level(2, 128, 1)}};
  const auto differences = app::error_differences(with, without);
  ASSERT_EQ(differences.size(), 2u);
  EXPECT_EQ(differences[0], 0.0);
  EXPECT_NEAR(differences[1].value(), 0, 1e-14);  // the error is 1 / dofs in both
}

TEST(Study, TextShowsTablesRatesAndTheReference)
{
  EXPECT_THAT(app::study_text(example(), "out"),
              AllOf(HasSubstr("adaptive: certified\n"), HasSubstr("uniform: budget, too large\n"),
                    HasSubstr("Newton steps per level\n"), HasSubstr("bound -1.000"),
                    HasSubstr("adaptive: changes the energy error by at most 3 % (level 1)"),
                    HasSubstr("reference     degree 2 on 2048 cells, 4096 degrees of freedom"),
                    Not(HasSubstr("coarser")), HasSubstr("effectivity 1.500 to 1.500"),
                    HasSubstr("results       out\n")));
}

TEST(Study, NamesTheUnits)
{
  app::Study study = example();
  EXPECT_THAT(app::study_text(study, ""), Not(HasSubstr("error in")));
  EXPECT_TRUE(nlohmann::json::parse(app::study_json(study))["units"].is_null());
  study.facts.dimension = 2;
  study.facts.units = {"m", "MN"};
  EXPECT_THAT(app::study_text(study, ""), HasSubstr("\nerror in (MN m/m)^(1/2)\n"));
  EXPECT_EQ(nlohmann::json::parse(app::study_json(study))["units"]["force"], "MN/m");
}

TEST(Study, AReferenceThatIsTooCoarseIsSaidToBe)
{
  app::Study study = example();
  study.reference->fine_enough = false;
  study.reference->reason = "study.max_reference_dofs";
  EXPECT_THAT(app::study_text(study, "out"),
              AllOf(HasSubstr("coarser than asked for (0.002)"), HasSubstr("study.max_reference_dofs")));
}

TEST(Study, AnEffectivityBelowOneViolatesTheGuarantee)
{
  app::Study study = example();
  EXPECT_EQ(app::violation(study), "");
  study.variants[1].levels[1].dual_norm = 1;
  EXPECT_THAT(app::violation(study),
              AllOf(HasSubstr("guarantee is violated"), HasSubstr("adaptive_converged on level 1")));
  EXPECT_EQ(nlohmann::json::parse(app::study_json(study))["guarantee"], "violated");
  EXPECT_THAT(app::study_text(study, ""), HasSubstr("guarantee     the guarantee is violated"));
}

}  // namespace
}  // namespace tribound
