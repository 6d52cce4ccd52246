#include "tribound/io/record/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/tables.h"

namespace tribound
{
namespace
{

using nlohmann::json;

std::vector<std::string> lines(const std::string& text)
{
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

io::RunRecord uncertified_run()
{
  io::RunRecord run;
  run.facts = {"Block, \"Tresca\"", "case.toml", 2, 2, certify::PatchStress::rows, "tresca", 10.0};
  run.reason = "the bound is not computed";
  io::LevelRecord level;
  level.cells = 16;
  level.dofs = 24;
  level.newton = {{{1, 0.5, 1.0, 0, true, 0.25}, {}, false}, {{2, 1e-12, 0.5, 3, false, 0.125}, {}, true}};
  level.figures.energy = 0.1;
  level.figures.sigma_norm = 0.5;
  level.figures.max_displacement = 1.0 / 3.0;
  level.figures.contact = {"", {0.25, 2.0}, -2.0, 0.25, 0.375};
  level.figures.boundary_contact = {{"bottom", {0.25, 2.0}, -2.0, 0.25, 0.375}};
  level.times = {.stages = {.solve = 1.5}, .level = 2.0};
  run.levels = {level};
  return run;
}

io::RunRecord certified_run()
{
  io::RunRecord run = uncertified_run();
  run.status = certify::RunStatus::certified;
  run.reason.clear();
  io::LevelRecord& level = run.levels[0];
  level.bound = certify::Bound{{1, 2, 3, 4, 5, 6, 7, 8}, 20, 10};
  level.identities = certify::IdentityDefects{1e-14, 2e-14, 3e-14, 4e-14, 5e-14};
  level.newton[1].bound = level.bound;
  level.times.stages.certify = 0.25;
  return run;
}

TEST(Report, ConvergenceOfAnUncertifiedRunLeavesTheBoundEmpty)
{
  EXPECT_THAT(
      lines(io::convergence_csv(uncertified_run().levels)),
      ::testing::ElementsAre(
          "level,cells,dofs,newton_steps,osc,str,neu,lin1,cnt,frc,lin2n,lin2t,quad,alg,total,total_sharp,"
          "relative,energy,contact_normal,contact_tangential,t_solve,t_certify,t_level,energy_bound,"
          "energy_relative",
          "0,16,24,2,,,,,,,,,,,,,,0.1,-2,0.25,1.5,0,2,,"));
}

TEST(Report, ConvergenceOfACertifiedRun)
{
  EXPECT_EQ(lines(io::convergence_csv(certified_run().levels))[1],
            "0,16,24,2,1,2,3,4,5,6,7,8,0,0,20,10,20,0.1,-2,0.25,1.5,0.25,2,,");
}

TEST(Report, NewtonTable)
{
  EXPECT_THAT(lines(io::newton_csv(certified_run().levels)),
              ::testing::ElementsAre(
                  "level,step,residual,damping,osc,str,neu,lin1,cnt,frc,lin2n,lin2t,quad,alg,total,accepted",
                  "0,1,0.5,1,,,,,,,,,,,,0", "0,2,1e-12,0.5,1,2,3,4,5,6,7,8,0,0,20,1"));
}

TEST(Report, AStepWithoutABoundShowsItsLinearisationError)
{
  io::RunRecord run = certified_run();
  run.levels[0].newton[0].linearisation = certify::BoundComponents{.lin1 = 3, .lin2n = 2, .lin2t = 1};
  EXPECT_EQ(lines(io::newton_csv(run.levels))[1], "0,1,0.5,1,,,,3,,,2,1,,,,0");
}

TEST(Report, TimesOfEveryStage)
{
  io::RunRecord run = certified_run();
  run.levels[0].times.stages.bisect = 0.5;
  run.levels[0].times.stages.discretise = 0.25;
  run.levels[0].times.stages.transfer = 0.125;
  run.levels[0].times.stages.output = 0.0625;
  run.levels[0].times.solve_cpu = 1.75;
  run.levels[0].times.certify_cpu = 0.75;
  run.levels[0].times.output_cpu = 0.375;
  run.levels[0].times.level_cpu = 3.0;
  run.levels[0].times.factorisations = 3;
  const json expected = {{"solve", 1.5},        {"certify", 0.25},   {"bisect", 0.5},
                         {"discretise", 0.25},  {"transfer", 0.125}, {"output", 0.0625},
                         {"level", 2.0},        {"solve_cpu", 1.75}, {"certify_cpu", 0.75},
                         {"output_cpu", 0.375}, {"level_cpu", 3.0},  {"factorisations", 3}};
  const json certificate = json::parse(io::certificate_json(run));
  EXPECT_EQ(certificate["levels"][0]["times"], expected);
  EXPECT_EQ(certificate["times"]["factorisations"], 3);
}

io::RunRecord regularised_run()
{
  io::RunRecord run = certified_run();
  io::LevelRecord& level = run.levels[0];
  level.bound->global.reg1 = 9;
  level.bound->global.reg2n = 10;
  level.bound->global.reg2t = 11;
  level.newton[1].bound = level.bound;
  level.newton[1].step.delta = 0.125;
  level.delta_updates = 3;
  return run;
}

TEST(Report, ARegularisedRunHasItsColumnsAtTheEnd)
{
  EXPECT_THAT(
      lines(io::convergence_csv(regularised_run().levels)),
      ::testing::ElementsAre(
          lines(io::convergence_csv(certified_run().levels))[0] + ",reg1,reg2n,reg2t,delta,delta_updates",
          lines(io::convergence_csv(certified_run().levels))[1] + ",9,10,11,0.125,3"));
  const std::vector<std::string> plain = lines(io::newton_csv(certified_run().levels));
  EXPECT_THAT(lines(io::newton_csv(regularised_run().levels)),
              ::testing::ElementsAre(plain[0] + ",reg1,reg2n,reg2t,delta", plain[1] + ",,,,0",
                                     plain[2] + ",9,10,11,0.125"));
}

TEST(Report, CertificateOfARegularisedRun)
{
  const json certificate = json::parse(io::certificate_json(regularised_run()));
  EXPECT_EQ(certificate["components"]["reg2t"], 11.0);
  EXPECT_EQ(certificate["regularisation"]["delta"], 0.125);
  EXPECT_EQ(certificate["regularisation"]["updates"], 3);
  EXPECT_EQ(certificate["levels"][0]["newton"][1]["delta"], 0.125);
  const json plain = json::parse(io::certificate_json(certified_run()));
  EXPECT_FALSE(plain.contains("regularisation"));
  EXPECT_FALSE(plain["components"].contains("reg1"));
}

TEST(Report, TheCertificateHasTheLabelOfEveryUnit)
{
  io::RunRecord run = certified_run();
  EXPECT_TRUE(json::parse(io::certificate_json(run))["units"].is_null());
  run.facts.units = {"mm", "N"};
  run.facts.quantity_units = {{"thrust", "N/mm"}, {"safety", ""}};
  const json expected = {{"length", "mm"},
                         {"boundary", "mm"},
                         {"body", "mm^2"},
                         {"stress", "MPa"},
                         {"body_force", "N/mm^3"},
                         {"fracture_energy", "N/mm"},
                         {"force", "N/mm"},
                         {"moment", "N mm/mm"},
                         {"energy", "N mm/mm"},
                         {"stress_norm", "MPa mm"},
                         {"energy_norm", "(N mm/mm)^(1/2)"},
                         {"quantities", {{"thrust", "N/mm"}, {"safety", nullptr}}}};
  EXPECT_EQ(json::parse(io::certificate_json(run))["units"], expected);
  run.facts.dimension = 3;
  EXPECT_EQ(json::parse(io::certificate_json(run))["units"]["force"], "N");
}

TEST(Report, QuantitiesHaveTheirUnitsInTheTable)
{
  io::CaseFacts facts;
  facts.quantity_units = {{"thrust", "N/mm"}};
  const io::Json levels = io::Json::parse(
      R"([{"level": 0, "dofs": 8, "quantities": [{"name": "thrust", "value": 1.5, "lower": 1, "upper": 2,
           "exact": false, "rests_on": "duality gap"}]}])");
  EXPECT_THAT(lines(io::quantities_csv(levels, facts)),
              ::testing::ElementsAre("level,dofs,name,value,lower,upper,exact,rests_on,unit",
                                     "0,8,thrust,1.5,1,2,0,duality gap,N/mm"));
  EXPECT_EQ(lines(io::quantities_csv(levels, {}))[1], "0,8,thrust,1.5,1,2,0,duality gap,");
}

certify::Balance small_balance()
{
  return {{1, 0.5},
          {{certify::BalanceKind::load, "box", "body force", {0, -3}, {1.5}},
           {certify::BalanceKind::reaction, "left", "displacement", {0, 3}, {-1.5}},
           {certify::BalanceKind::sum, "", "", {0, 0}, {0}}}};
}

TEST(Report, CertificateHasTheBalance)
{
  io::RunRecord run = certified_run();
  EXPECT_TRUE(json::parse(io::certificate_json(run)).at("balance").is_null());
  run.levels[0].balance = small_balance();
  const json balance = json::parse(io::certificate_json(run))["balance"];
  EXPECT_EQ(balance["about"], json({1, 0.5}));
  EXPECT_EQ(balance["rows"][0], json({{"kind", "load"},
                                      {"name", "box"},
                                      {"source", "body force"},
                                      {"force", {0, -3}},
                                      {"moment", {1.5}}}));
  EXPECT_EQ(balance["rows"][1]["moment"], json({-1.5}));
  EXPECT_EQ(balance["rows"][2]["kind"], "sum");
}

TEST(Report, CertificateNamesTheEffectiveCase)
{
  io::RunRecord run = certified_run();
  EXPECT_TRUE(json::parse(io::certificate_json(run)).at("case").is_null());
  run.effective = {"abc", {"degree=2"}, {{"block.msh", "0123"}}};
  EXPECT_EQ(json::parse(io::certificate_json(run))["case"],
            json({{"file", "case.toml"},
                  {"sha256", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
                  {"files", {{{"file", "block.msh"}, {"sha256", "0123"}}}},
                  {"overrides", {"degree=2"}}}));
}

TEST(Report, CertificateOfAnUncertifiedRun)
{
  const json certificate = json::parse(io::certificate_json(uncertified_run()));
  EXPECT_EQ(certificate["schema"], "1");
  EXPECT_EQ(certificate["title"], "Block, \"Tresca\"");
  EXPECT_EQ(certificate["status"], "uncertified");
  EXPECT_EQ(certificate["reason"], "the bound is not computed");
  EXPECT_EQ(certificate["d"], 2);
  EXPECT_EQ(certificate["p"], 2);
  for (const char* unknown : {"bound", "bound_plain", "relative", "components", "identities"})
    EXPECT_TRUE(certificate.at(unknown).is_null()) << unknown;
  EXPECT_EQ(certificate["max_displacement"].get<double>(), 1.0 / 3.0) << "numbers must survive the text";
  EXPECT_EQ(certificate["contact"]["normal"], -2.0);
  EXPECT_EQ(certificate["contact"]["boundaries"]["bottom"]["abs_tangential"], 0.375);
  EXPECT_EQ(certificate["levels"].size(), 1u);
  EXPECT_EQ(certificate["levels"][0]["newton"][1]["linear_iterations"], 3);
}

TEST(Report, CertificateOfACertifiedRun)
{
  const json certificate = json::parse(io::certificate_json(certified_run()));
  EXPECT_EQ(certificate["status"], "certified");
  EXPECT_TRUE(certificate["reason"].is_null());
  EXPECT_EQ(certificate["bound"], 10.0);
  EXPECT_EQ(certificate["bound_plain"], 20.0);
  EXPECT_EQ(certificate["relative"], 20.0);
  EXPECT_EQ(certificate["components"]["lin2t"], 8.0);
  EXPECT_EQ(certificate["identities"]["jump"], 2e-14);
}

TEST(Report, CertificateComparesThePathWithItsCheck)
{
  io::RunRecord run = certified_run();
  run.levels[0].load_step.emplace();
  run.levels[0].load_step->dissipated = 0.5;
  EXPECT_FALSE(json::parse(io::certificate_json(run)).contains("history_check"));

  io::LoadStepRecord last;
  last.control = "damage";
  last.dissipated = 0.75;
  run.path.peak = adapt::Peak{.t = 100, .number = 1};
  run.check = io::HistoryCheck{.cells = 64, .steps = 3, .last = last};
  run.check->end.notes = {"ended early"};
  json check = json::parse(io::certificate_json(run)).at("history_check");
  EXPECT_EQ(check["cells"], 64);
  EXPECT_EQ(check["steps"], 3);
  EXPECT_TRUE(check.at("failure").is_null());
  EXPECT_EQ(check["notes"], json({"ended early"}));
  EXPECT_EQ(check["control"], json({{"path", "load"}, {"check", "damage"}}));
  EXPECT_EQ(check["compared"].size(), 5U);
  EXPECT_EQ(check["compared"]["dissipated"], json({{"path", 0.5}, {"check", 0.75}, {"difference", 0.25}}));
  EXPECT_EQ(check["compared"]["peak_t"],
            json({{"path", 100.0}, {"check", nullptr}, {"difference", nullptr}}));
  EXPECT_THAT(check["note"].get<std::string>(), testing::HasSubstr("not guaranteed"));

  run.check->end.failure = "out of memory";
  check = json::parse(io::certificate_json(run)).at("history_check");
  EXPECT_EQ(check["failure"], "out of memory");
  EXPECT_TRUE(check.at("compared").is_null());
}

TEST(Report, SlidingIsJudgedWhereFrictionIsCoulombs)
{
  io::RunRecord run = certified_run();
  EXPECT_TRUE(json::parse(io::certificate_json(run))["contact"]["boundaries"]["bottom"]["sliding"].is_null());
  run.levels[0].figures.boundary_contact[0].coefficient = 0.5;
  const json certificate = json::parse(io::certificate_json(run));
  for (const json& level : {certificate, certificate["levels"][0]})
  {
    const json& sliding = level["contact"]["boundaries"]["bottom"]["sliding"];
    EXPECT_EQ(sliding["coefficient"], 0.5);
    EXPECT_EQ(sliding["sliding_factor"], 0.125);
    EXPECT_EQ(sliding["safety_factor"], 4.0);
  }
}

TEST(Report, SlidingWithoutAForce)
{
  io::Resultants contact{"base", {0.0, 2.0}, -2.0, -0.25, 0.25, 0.5};
  EXPECT_EQ(io::sliding(contact)->safety_factor, 4.0) << "the sign of the tangent is of no importance";
  contact.tangential = 1e-11;  // round-off
  EXPECT_FALSE(io::sliding(contact)->safety_factor.has_value());
  contact.tangential = 1e-9;
  EXPECT_TRUE(io::sliding(contact)->safety_factor.has_value());
  contact.coefficient = 0.0;
  EXPECT_EQ(io::sliding(contact)->safety_factor, 0.0);
  contact.normal = 0.0;  // lifted off
  EXPECT_FALSE(io::sliding(contact).has_value());
}

TEST(Report, ForcesHaveTheDigitsThatAreKnown)
{
  EXPECT_EQ(io::known_digits(1234.5678, 0.01), 1234.57);
  EXPECT_EQ(io::known_digits(-1234.5678, 3), -1235);
  EXPECT_EQ(io::known_digits(2.5e-7, 1e-6), 0.0);
  EXPECT_EQ(io::known_digits(1 / 3.0, 0), 1 / 3.0);
  EXPECT_EQ(io::known_digits(0, 0), 0.0);
  EXPECT_TRUE(std::isnan(io::known_digits(std::nan(""), 1)));

  const io::Resultants dam{"base", {}, -1000, 600, 600, 0.75, 1};
  EXPECT_EQ(io::sliding(dam)->sliding_factor, 0.6);
  EXPECT_EQ(io::sliding(dam)->safety_factor, 1.25);
  const io::Resultants without_water{"base", {}, -1000, 0.8, 0.8, 0.75, 1};
  EXPECT_FALSE(io::sliding(without_water)->safety_factor.has_value());
}

TEST(Report, CertificateWithoutALevelHasNoFigures)
{
  io::RunRecord run;
  run.status = certify::RunStatus::failed;
  run.reason = "singular matrix";
  const json certificate = json::parse(io::certificate_json(run));
  EXPECT_EQ(certificate["status"], "failed");
  EXPECT_FALSE(certificate.contains("energy"));
  EXPECT_TRUE(certificate["levels"].empty());
}

TEST(Report, CertificateSaysWhatItCovers)
{
  io::RunRecord run = certified_run();
  run.tolerance = 0.01;
  run.statements = {
      {"the residual"}, "Tresca", {{"poincare", 0.25}}, {{"geometry", "straight"}}, {"the model"}};
  const json certificate = json::parse(io::certificate_json(run));
  EXPECT_EQ(certificate["tolerance"], 0.01);
  EXPECT_EQ(certificate["covered"], json({"the residual"}));
  EXPECT_EQ(certificate["law"], "Tresca");
  EXPECT_EQ(certificate["constants"]["poincare"], 0.25);
  EXPECT_EQ(certificate["assumptions"]["geometry"], "straight");
  EXPECT_EQ(certificate["not_covered"], json({"the model"}));
}

TEST(Report, NamesThatAreNotUtf8DoNotSpoilTheCertificate)
{
  io::RunRecord run = uncertified_run();
  run.facts.title = "\xff block";
  EXPECT_EQ(json::parse(io::certificate_json(run))["title"], "\xef\xbf\xbd block");
}

}  // namespace
}  // namespace tribound
