/// @file two_bodies_3d_test.cpp
/// Contact between elastic bodies in 3D against the numbers of an independent program,
/// tests/verification/data/two_bodies.json. It uses another rule on the segments, which matters at kinks.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "unit/certify/transfer_testing.h"

namespace tribound::test
{

namespace
{

using nlohmann::json;

json cases(const char* key)
{
  std::ifstream file(TWO_BODIES_REFERENCE);
  return json::parse(file)[key];
}

problem::ContactLaw law(const std::string& name)
{
  if (name == "none") return Frictionless();
  if (name == "tresca") return Tresca(0.03);
  if (name == "coulomb") return Coulomb(0.5);
  return Tied();
}

/// The upper block on the lower one, both (0, 2) x (0, 1) and 1 high; z points upwards.
DiscreteProblem<3> blocks(const json& expected)
{
  mesh::MeshData<3> data =
      side_by_side(box<3>({0, 0, 0}, {2, 1, 1}, expected["n1"].get<std::array<int, 3>>()),
                   box<3>({0, 0, -1}, {2, 1, 0}, expected["n2"].get<std::array<int, 3>>()), "_below");
  data.interfaces = {{{{{"back"}, {"front_below"}}}}};
  const ProblemData<3> problem{.boundaries = {clamped<3>("left"), loaded<3>("front", 0, 0, -0.1),
                                              loaded<3>("right", 0.04, 0.02, 0.06), clamped<3>("back_below")},
                               .regions = {{.name = "box_below", .material = lame(expected["E2"], 0.3)}},
                               .pairs = {pair<3>("back", "front_below", law(expected["law"]))}};
  adapt::Method method{.degree = expected["p"]};
  method.newton.tolerance = 1e-12;
  method.solver.method = algebra::LinearMethod::direct;
  return {std::move(data), problem, method};
}

class TwoBodies3D : public ::testing::TestWithParam<int>
{
};

TEST_P(TwoBodies3D, HasTheForcesAndEnergies)
{
  const json expected = cases("three_d")[GetParam()];
  const std::string name = expected["law"];
  SCOPED_TRACE(name + ", p = " + expected["p"].dump() + ", points " + expected["points_per_segment"].dump());
  const DiscreteProblem<3> c = blocks(expected);
  EXPECT_EQ(c.form.segments().size(), expected["segments"].get<std::size_t>());
  const solve::NewtonResult<3> newton = c.solve();
  ASSERT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  const double tolerance = name == "tied" ? 1e-10 : 1e-3;
  const auto compare = [&](double value, const char* key)
  { EXPECT_NEAR(value, expected[key], tolerance * std::abs(expected[key].get<double>()) + 1e-12) << key; };

  const std::vector<double> energies = contact::cell_energies<3>(c.problem, c.space, newton.u);
  double energy = 0;
  std::array<double, 2> of_body{};
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
  {
    energy += energies[cell];
    of_body[c.mesh.region(cell)] += energies[cell];
  }
  compare(energy, "energy");
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_NEAR(of_body[b], expected["energy_per_body"][b], 2 * tolerance * energy);
  const contact::ContactResultants<3> sum = contact::contact_resultants<3>(c.form, c.form.traction(newton.u));
  compare(sum.normal, "T_n");
  compare(sum.force[0], "T_x");
  compare(sum.force[1], "T_y");
  double largest = 0;
  for (std::size_t i = 0; i < newton.u.size(); i += 3)
    largest = std::max(largest, Point<3>(newton.u.data() + i).norm());
  compare(largest, "max_abs_u");
}

INSTANTIATE_TEST_SUITE_P(AllCases, TwoBodies3D, ::testing::Range(0, 14));

/// Cases whose kinks of T make the rule on the segments, which has 64 points in the reference, matter more
/// than elsewhere.
bool depends_on_the_rule(const json& expected)
{
  const int iterate = expected["it"];
  return iterate == 2 || (expected["law"] == "none" && iterate == expected["last"]);
}

std::vector<contact::ContactSegment<3>> quartered(const DiscreteProblem<3>& c,
                                                  std::span<const contact::ContactSegment<3>> segments)
{
  const auto quarter = [](const fem::Part<2>& part, int k) -> fem::Part<2>
  {
    const Point<2> a = (part[0] + part[1]) / 2;
    const Point<2> b = (part[1] + part[2]) / 2;
    const Point<2> d = (part[2] + part[0]) / 2;
    const std::array<fem::Part<2>, 4> quarters = {
        {{part[0], a, d}, {a, part[1], b}, {d, b, part[2]}, {a, b, d}}};
    return quarters[k];
  };
  std::vector<contact::ContactSegment<3>> result;
  for (const contact::ContactSegment<3>& whole : segments)
    for (int k = 0; k < 4; ++k)
      result
          .emplace_back(contact::make_segment<3>(
              c.problem, c.mesh, c.form.gamma0(), *whole.contact,
              {whole.slave.number, quarter(*whole.slave.part, k)},
              contact::FacetPart<3>{whole.master->number, quarter(*whole.master->part, k)}))
          .pair = whole.pair;
  return result;
}

/// The bound, with the reference file's closed form for what is lost between the meshes.
certify::Estimate with_closed_form(const contact::NitscheForm<3>& form, const certify::Stress<3>& stress,
                                   certify::Estimate estimate)
{
  const certify::ContactTerms<3> terms(form, certify::ContactRule::reference);
  double mor = 0;
  double eta = 0;
  for (certify::BoundComponents& cell : estimate.cells) cell.mor = 0;
  for (const auto& [cell, transfers] : certify::facet_transfers<3>(form, terms, stress.tractions.running()))
    for (const certify::FacetTransfer<3>& transfer : transfers)
      for (const auto& pieces : transfer.groups)
        estimate.cells[cell].mor +=
            closed_form(form.space().mesh(), transfer.facet, form.space().degree(), pieces, std::numbers::pi);
  for (certify::BoundComponents& cell : estimate.cells)
  {
    cell.str_mor = cell.str + cell.mor;
    mor += std::pow(cell.mor, 2);
    eta += std::pow(cell.total_sharp(), 2);
  }
  estimate.global.mor = std::sqrt(mor);
  estimate.total_sharp = std::sqrt(eta);
  return estimate;
}

class TwoBodiesBound3D : public ::testing::TestWithParam<int>
{
};

TEST_P(TwoBodiesBound3D, HasTheComponents)
{
  const json expected = cases("three_d_bound")[GetParam()];
  const std::string name = expected["law"];
  SCOPED_TRACE(name + ", iterate " + expected["it"].dump());
  DiscreteProblem<3> c = blocks(expected);
  EXPECT_EQ(c.form.segments().size(), expected["segments"].get<std::size_t>());
  if (expected["it"] != expected["last"]) c.method.newton.max_steps = expected["it"];
  const solve::NewtonResult<3> newton = c.solve();
  const certify::Stress<3> stress =
      certify::equilibrate<3>(c.form, newton.u, newton.traction, 0, 0, certify::PatchStress::afw);
  EXPECT_LE(certify::check_identities<3>(c.form, newton.traction, stress).largest(), 1e-12);
  const certify::Estimate sharper =
      certify::estimate<3>(c.form, newton.u, stress, certify::ContactRule::reference);
  const certify::Estimate plain = with_closed_form(c.form, stress, sharper);

  const double eta = expected["eta"];
  const certify::BoundComponents& found = plain.global;
  const auto compare = [&](double value, const char* key, double tolerance, double of_the_rule)
  {
    const double limit = name == "tied" ? 1e-9 : depends_on_the_rule(expected) ? of_the_rule : tolerance;
    EXPECT_NEAR(value, expected[key], limit * std::abs(expected[key].get<double>()) + 1e-12 * eta) << key;
  };
  compare(plain.total_sharp, "eta", 1e-3, 1.5e-2);
  compare(found.str, "str", 1e-3, 3e-3);
  compare(found.mor, "mor", 1e-2, 5e-2);
  compare(found.lin1, "lin1", 5e-2, 0.16);
  compare(found.cnt, "cnt", 5e-2, 8e-2);
  compare(found.frc, "frc", 5e-2, 5e-2);
  compare(found.lin2n, "lin2n", 5e-2, 0.15);
  compare(found.lin2t, "lin2t", 5e-2, 5e-2);
  EXPECT_LE(sharper.global.mor, found.mor / 2);
  EXPECT_LE(sharper.total_sharp, plain.total_sharp);
  certify::DualNorm<3> dual_norm(c.form, {.refinements = 1, .degree = 3});
  const double below = dual_norm(newton.u);
  EXPECT_GE(certify::estimate<3>(c.form, newton.u, stress).total_sharp, below);
  EXPECT_GE(below,
            (1 - (name == "tied" ? 1e-8 : 1e-3)) * expected["dual_below"].get<double>());  // not refined
}

class TwoBodiesFinerRule3D : public ::testing::TestWithParam<int>
{
};

/// With the rule on 16 parts of each segment: quantities that do not depend on the segments themselves.
TEST_P(TwoBodiesFinerRule3D, HasStressAndLinearisation)
{
  const json expected = cases("three_d_bound")[GetParam()];
  EXPECT_TRUE(depends_on_the_rule(expected));
  SCOPED_TRACE(expected["law"].get<std::string>() + ", iterate " + expected["it"].dump());
  DiscreteProblem<3> c = blocks(expected);
  if (expected["it"] != expected["last"]) c.method.newton.max_steps = expected["it"];
  const contact::NitscheForm<3> form(c.problem, c.space, c.form.gamma0(),
                                     quartered(c, quartered(c, c.form.segments())));
  const solve::NewtonResult<3> newton = solve::solve<3>(form, {}, c.method.newton, c.method.solver);
  const certify::BoundComponents found =
      certify::estimate<3>(
          form, newton.u,
          certify::equilibrate<3>(form, newton.u, newton.traction, 0, 0, certify::PatchStress::afw),
          certify::ContactRule::reference)
          .global;
  EXPECT_NEAR(found.str, expected["str"], 1e-3 * expected["str"].get<double>());
  EXPECT_NEAR(found.lin1, expected["lin1"], 5e-2 * expected["lin1"].get<double>() + 1e-12);
}

INSTANTIATE_TEST_SUITE_P(AllCases, TwoBodiesBound3D, ::testing::Range(0, 10));
INSTANTIATE_TEST_SUITE_P(CasesWithKinks, TwoBodiesFinerRule3D, ::testing::Values(2, 3, 5, 8));

}  // namespace

}  // namespace tribound::test
