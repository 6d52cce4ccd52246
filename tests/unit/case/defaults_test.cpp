// The defaults in the tables of docs/case-format.md against the program.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "tribound/case/config.h"
#include "unit/case/case_format.h"

namespace tribound::test
{
namespace
{

/// 2 000 000, in the notation of the tables.
std::string with_spaces(long n)
{
  std::string text = std::to_string(n);
  for (int i = static_cast<int>(text.size()) - 3; i > 0; i -= 3) text.insert(i, " ");
  return text;
}

std::string choice(const Row& row, int number)
{
  return fmt::format("`\"{}\"`", quoted(row.type, "\"").at(number));
}

template <class T>
std::string unlimited(const std::optional<T>& limit, const char* text)
{
  return limit ? fmt::format("{}", *limit) : text;
}

/// Defaults of keys in the notation of the tables, by name of the key.
std::map<std::string, std::function<std::string(const case_file::Config&, const Row&)>> defaults()
{
  const auto truth = [](bool value) { return std::string(value ? "true" : "false"); };
  return {
      {"title", [](const case_file::Config& c, const Row&) { return "`\"" + c.title + "\"`"; }},
      {"purpose", [](const case_file::Config& c, const Row&) { return "`\"" + c.purpose + "\"`"; }},
      {"degree", [](const case_file::Config& c, const Row&) { return std::to_string(c.method.degree); }},
      {"material.plane", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.materials[0].plane)); }},
      {"material.alpha",
       [](const case_file::Config& c, const Row&) { return c.materials[0].alpha ? "given" : "none"; }},
      {"load.body",
       [](const case_file::Config& c, const Row&) { return c.loads.empty() ? "zero" : "given"; }},
      {"load.temperature",
       [](const case_file::Config& c, const Row&) { return c.loads.empty() ? "none" : "given"; }},
      {"load.reference_temperature", [](const case_file::Config&, const Row&)
       { return case_file::LoadConfig().reference_temperature.is_zero() ? "0" : "not 0"; }},
      {"load.initial_stress",
       [](const case_file::Config& c, const Row&) { return c.loads.empty() ? "zero" : "given"; }},
      {"boundary.top.contact.friction", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.boundaries[0].contact->law.index())); }},
      {"boundary.top.contact.gap", [](const case_file::Config& c, const Row&)
       { return c.boundaries[0].contact->gap->is_zero() ? "0" : "not 0"; }},
      {"contact.0.friction", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.contacts[0].contact.law.index())); }},
      {"contact.0.gap", [](const case_file::Config& c, const Row&)
       { return c.contacts[0].contact.gap ? "given" : "`\"geometry\"`"; }},
      {"contact.0.pairing", [](const case_file::Config& c, const Row&)
       { return c.contacts[0].direction.empty() ? "`\"normal\"`" : "given"; }},
      {"contact.0.reach", [](const case_file::Config& c, const Row&)
       { return std::isinf(c.contacts[0].reach) ? "no limit" : "given"; }},
      {"nitsche.gamma0",
       [](const case_file::Config&, const Row&) {
         return fmt::format("{}; {} for degree 4", contact::default_gamma0(3), contact::default_gamma0(4));
       }},
      {"newton.stopping", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.method.stopping.criterion)); }},
      {"newton.gamma_lin",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.method.stopping.gamma_lin); }},
      {"newton.tolerance",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.method.newton.tolerance); }},
      {"newton.max_steps",
       [](const case_file::Config& c, const Row&) { return std::to_string(c.method.newton.max_steps); }},
      {"newton.finish",
       [=](const case_file::Config& c, const Row&) { return truth(c.method.stopping.finish); }},
      {"newton.damping",
       [=](const case_file::Config& c, const Row&) { return truth(c.method.newton.damping); }},
      {"regularisation.delta", [](const case_file::Config& c, const Row&)
       { return fmt::format("{}", c.method.regularisation->delta); }},
      {"regularisation.factor", [](const case_file::Config& c, const Row&)
       { return fmt::format("{}", c.method.regularisation->factor); }},
      {"regularisation.gamma_reg", [](const case_file::Config& c, const Row&)
       { return fmt::format("{}", c.method.regularisation->gamma_reg); }},
      {"regularisation.max_updates", [](const case_file::Config& c, const Row&)
       { return std::to_string(c.method.regularisation->max_updates); }},
      {"adapt.tolerance",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.adapt.tolerance); }},
      {"adapt.marking", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.adapt.marking.strategy)); }},
      {"adapt.theta",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.adapt.marking.theta); }},
      {"adapt.separate_contact",
       [=](const case_file::Config& c, const Row&) { return truth(c.adapt.marking.separate_contact); }},
      {"adapt.max_levels",
       [](const case_file::Config& c, const Row&) { return with_spaces(c.adapt.max_levels); }},
      {"adapt.max_dofs",
       [](const case_file::Config& c, const Row&) { return with_spaces(c.adapt.max_dofs); }},
      {"adapt.max_cells",
       [](const case_file::Config& c, const Row&) { return unlimited(c.adapt.max_cells, "no limit"); }},
      {"adapt.max_time",
       [](const case_file::Config& c, const Row&) { return unlimited(c.adapt.max_time, "no limit"); }},
      {"adapt.max_memory", [](const case_file::Config& c, const Row&)
       { return unlimited(c.adapt.max_memory, "9/10 of the machine's"); }},
      {"adapt.energy_tolerance", [](const case_file::Config& c, const Row&)
       { return unlimited(c.adapt.bars.energy_tolerance, "no demand"); }},
      {"adapt.goal",
       [](const case_file::Config& c, const Row&) { return c.adapt.bars.goal.empty() ? "none" : "given"; }},
      {"adapt.goal_tolerance", [](const case_file::Config& c, const Row&)
       { return unlimited(c.adapt.bars.goal_tolerance, "no demand"); }},
      {"quantity.0.name", [](const case_file::Config& c, const Row&)
       { return c.quantities[0].name == "mean_displacement top" ? "kind and boundary" : "another"; }},
      {"quantity.0.boundary", [](const case_file::Config& c, const Row&)
       { return c.quantities[0].boundary == "top" ? "all contact boundaries" : "another"; }},
      {"quantity.0.direction", [](const case_file::Config& c, const Row&)
       { return c.quantities[0].direction.empty() ? "`\"normal\"`" : "given"; }},
      {"quantity.0.point", [](const case_file::Config& c, const Row&)
       { return c.quantities[0].point.empty() ? "the origin" : "given"; }},
      {"quantity.0.ramp", [](const case_file::Config& c, const Row&)
       { return c.quantities[0].ramp == 0 ? "a tenth of the box around the boundary" : "given"; }},
      {"adapt.measure", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.adapt.measure)); }},
      {"certify.energy", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.adapt.bars.levels)); }},
      {"certify.contact_rule", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.method.contact_rule)); }},
      {"certify.stress", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.method.stress)); }},
      {"solver.method", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.method.solver.method)); }},
      {"solver.package", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.method.solver.package)); }},
      {"solver.tolerance",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.method.solver.tolerance); }},
      {"solver.gamma_alg",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.method.solver.gamma_alg); }},
      {"solver.max_iterations",
       [](const case_file::Config& c, const Row&) { return with_spaces(c.method.solver.max_iterations); }},
      {"study.reference_degree", [](const case_file::Config& c, const Row&)
       { return unlimited(c.study.reference_degree, "min(`degree` + 1, 4)"); }},
      {"study.reference_factor",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.study.reference_factor); }},
      {"study.max_reference_dofs",
       [](const case_file::Config& c, const Row&) { return with_spaces(c.study.max_reference_dofs); }},
      {"study.dual_norm_dofs",
       [](const case_file::Config& c, const Row&) { return with_spaces(c.study.dual_norm_dofs); }},
      {"study.figures", [=](const case_file::Config& c, const Row&) { return truth(c.study.figures); }},
      {"judge.sharpness",
       [](const case_file::Config& c, const Row&) { return fmt::format("{}", c.judge.sharpness); }},
      {"model", [](const case_file::Config& c, const Row&) { return c.is_axisymmetric ? "given" : "none"; }},
      {"not_covered",
       [](const case_file::Config& c, const Row&) { return c.not_covered.empty() ? "none" : "given"; }},
      {"output.directory",
       [](const case_file::Config& c, const Row&) { return "`\"" + c.output.directory.string() + "\"`"; }},
      {"output.vtu", [=](const case_file::Config& c, const Row&) { return truth(c.output.vtu); }},
      {"output.levels", [](const case_file::Config& c, const Row& row)
       { return choice(row, static_cast<int>(c.output.levels)); }},
      {"output.report", [=](const case_file::Config& c, const Row&) { return truth(c.output.report); }},
      {"output.mesh", [=](const case_file::Config& c, const Row&) { return truth(c.output.mesh); }},
      {"output.checkpoint", [=](const case_file::Config& c, const Row&)
       { return truth(c.output.checkpoints != case_file::Checkpoints::none); }},
      {"output.moment_about", [](const case_file::Config& c, const Row&)
       { return c.output.moment_about.empty() ? "centroid of the body" : "given"; }},
  };
}

TEST(CaseFormat, DefaultsAreThoseOfTheProgram)
{
  const auto values = defaults();
  for (const Row& row : documented_keys())
  {
    if (row.standard.empty()) continue;
    const auto value = values.find(row.name());
    ASSERT_NE(value, values.end()) << row.name() << " has a default that this test does not know";
    const std::string table = row.table == "load" ? "" : row.table;
    EXPECT_EQ(value->second(case_file::parse_config(valid_case(table)), row), row.standard) << row.name();
  }
}

}  // namespace
}  // namespace tribound::test
