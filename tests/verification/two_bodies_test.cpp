/// @file two_bodies_test.cpp
/// Contact between elastic bodies against the numbers of an independent program,
/// tests/verification/data/two_bodies.json.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

namespace
{

using nlohmann::json;

json reference()
{
  std::ifstream file(TWO_BODIES_REFERENCE);
  return json::parse(file);
}

/// Bodies at a distance with given gaps are the same problem as bodies that touch.
constexpr double apart = 0.5;

struct Stack
{
  struct Block
  {
    double left, right, bottom, top;
    std::array<int, 2> cells;
  };
  std::vector<Block> blocks;
  std::vector<double> stiffness;
  std::vector<problem::BoundaryCondition<2>> conditions;
  std::vector<problem::ContactPair<2>> pairs;
};

std::string suffix(std::size_t body)
{
  return body == 0 ? "" : "_" + std::to_string(body);
}

problem::ContactPair<2> between(std::size_t upper, problem::ContactLaw law, problem::Field gap = 0.0)
{
  return {{"bottom" + suffix(upper)}, {"top" + suffix(upper + 1)}, problem::Contact(std::move(law), gap)};
}

/// The numbers in a name such as B2_coulomb_8x4_6x3.
Stack b2(const std::string& name)
{
  const bool has_gap = name.ends_with("gap");
  const bool is_coarse = name.ends_with("4x2_3x2");
  const std::array<int, 2> upper = has_gap     ? std::array{6, 3}
                                   : is_coarse ? std::array{4, 2}
                                               : std::array{8, 4};
  const std::array<int, 2> lower = has_gap     ? std::array{5, 2}
                                   : is_coarse ? std::array{3, 2}
                                               : std::array{6, 3};
  problem::ContactLaw law = Coulomb(0.5);
  if (name.starts_with("B2_none")) law = Frictionless();
  if (name.starts_with("B2_tresca")) law = Tresca(0.03);
  if (name.starts_with("B2_tied")) law = problem::Tied();
  return {
      {{0, 2, 0, 1, upper}, {0, 2, -1, 0, lower}},
      {1, 1},
      {clamped<2>("left"), loaded<2>("top", 0, -0.1), loaded<2>("right", 0.04, 0.06), clamped<2>("bottom_1")},
      {between(0, law, has_gap ? formula("0.06*(x - 1)^2") : problem::Field(0.0))}};
}

Stack q2(const std::string& name)
{
  const double e2 = name.ends_with("0.0001") ? 1e-4 : name.ends_with("10000") ? 1e4 : 1;
  return {{{0, 2, 0, 1, {8, 4}}, {-0.5, 2.5, -1, 0, {7, 3}}},
          {1, e2},
          {fixed<2>("left", 0.0, free), loaded<2>("top", 0, formula("-0.1*(1.2 - 0.4*x)")),
           loaded<2>("right", 0.06, 0), clamped<2>("bottom_1")},
          {between(0, Coulomb(0.3))}};
}

Stack b3()
{
  return {{{0, 2, 0, 1, {8, 4}}, {0.2, 2.2, -0.5, 0, {5, 3}}, {-0.2, 2.4, -1.5, -0.5, {6, 3}}},
          {1, 3, 0.5},
          {fixed<2>("left", 0.0, free), loaded<2>("top", 0.06, -0.1), loaded<2>("right_1", -0.11, 0),
           clamped<2>("bottom_2")},
          {between(0, Coulomb(0.3)), between(1, Coulomb(0.2))}};
}

Stack stack_of(const std::string& name)
{
  return name.starts_with("B2") ? b2(name) : name.starts_with("Q2") ? q2(name) : b3();
}

mesh::MeshData<2> mesh_of(const Stack& stack)
{
  mesh::MeshData<2> data;
  for (std::size_t b = 0; b < stack.blocks.size(); ++b)
  {
    const auto& [left, right, bottom, top, cells] = stack.blocks[b];
    const double down = apart * static_cast<double>(b);
    mesh::MeshData<2> next = box<2>({left, bottom - down}, {right, top - down}, cells);
    data = b == 0 ? std::move(next) : side_by_side(std::move(data), next, suffix(b));
  }
  return data;
}

struct Assembly
{
  explicit Assembly(const json& expected)
      : Assembly(stack_of(expected["name"]), expected["p"], expected["gamma0"])
  {
  }
  Assembly(Stack bodies, int degree, double gamma0)
      : stack(std::move(bodies)),
        mesh(mesh_of(stack)),
        problem(mesh, regions(), stack.conditions, stack.pairs),
        space(mesh, degree),
        form(problem, space, gamma0)
  {
  }

  [[nodiscard]] std::vector<problem::Region<2>> regions() const
  {
    std::vector<problem::Region<2>> all;
    for (std::size_t b = 0; b < stack.blocks.size(); ++b)
      all.push_back({.name = "box" + suffix(b), .material = lame(stack.stiffness[b], 0.3)});
    return all;
  }

  Stack stack;
  mesh::Mesh<2> mesh;
  problem::Problem<2> problem;
  fem::LagrangeSpace<2> space;
  contact::NitscheForm<2> form;
};

class TwoBodies : public ::testing::TestWithParam<int>
{
};

/// Numbers below 1e-12 of the total are rounding.
void expect_near(double value, double expected, double tolerance, double scale, const std::string& what)
{
  EXPECT_NEAR(value, expected, tolerance * std::abs(expected) + 1e-12 * scale) << what;
}

void expect_components(const certify::Estimate& estimate, const json& expected, double tolerance,
                       const std::string& what)
{
  const double total = expected["total"];
  const certify::BoundComponents& eta = estimate.global;
  const std::vector<std::pair<const char*, double>> values = {{"osc", eta.osc},
                                                              {"str", eta.str},
                                                              {"Neu", eta.neu},
                                                              {"lin1", eta.lin1},
                                                              {"mor", eta.mor},
                                                              {"cnt", eta.cnt},
                                                              {"frc", eta.frc},
                                                              {"lin2n", eta.lin2n},
                                                              {"lin2t", eta.lin2t},
                                                              {"str_plus_tau", eta.stress()},
                                                              {"total", estimate.total_sharp},
                                                              {"total_plain", estimate.total}};
  const double rounding = tolerance > 1e-9 ? 10 * total : total;  // with a large contrast
  for (const auto& [name, value] : values)
    expect_near(value, expected[name], tolerance, rounding, what + name);
}

void expect_per_body(const Assembly& c, const certify::Estimate& estimate, const json& expected,
                     double tolerance, double scale, const std::string& what)
{
  std::vector<double> squares(expected.size(), 0.0);
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    squares[c.mesh.region(cell)] += std::pow(estimate.cells[cell].total_sharp(), 2);
  for (std::size_t b = 0; b < squares.size(); ++b)
    expect_near(std::sqrt(squares[b]), expected[b]["tot"], tolerance, scale, what + "body");
}

void expect_iterate(const Assembly& c, const solve::NewtonResult<2>& newton, const json& expected,
                    double tolerance, const std::string& what)
{
  const contact::StressNorms norms = contact::stress_norms<2>(c.problem, c.space, newton.u);
  expect_near(norms.energy, expected["energy"], tolerance, 0, what + "energy");
  expect_near(norms.sigma, expected["sigma_norm"], tolerance, 0, what + "||sigma||");
  for (std::size_t k = 0; k < c.stack.pairs.size(); ++k)
  {
    const json& pair = expected["pairs"][k];
    const int tag = problem::group_number(c.stack.pairs[k].slave[0], c.mesh.boundary_names(), {}, "boundary");
    const contact::ContactResultants<2> sum =
        contact::contact_resultants<2>(c.form, c.form.traction(newton.u), tag);
    const double scale = std::abs(pair["contact_normal"].get<double>());
    expect_near(sum.normal, pair["contact_normal"], tolerance, scale, what + "normal");
    expect_near(sum.tangential, pair["contact_tangential"], tolerance, scale, what + "tangential");
    expect_near(sum.abs_tangential, pair["abs_tangential"], tolerance, scale, what + "|tangential|");
    EXPECT_EQ(std::ranges::count(c.form.segments(), static_cast<int>(k), &contact::ContactSegment<2>::pair),
              pair["segments"].get<int>());
  }
  const certify::Stress<2> stress =
      certify::equilibrate<2>(c.form, newton.u, newton.traction, 0, 0, certify::PatchStress::afw);
  EXPECT_LE(certify::check_identities<2>(c.form, newton.traction, stress).largest(), 1e-10);
  const json& components = expected["components"];
  const double total = components["total"];
  const certify::Estimate plain =
      certify::estimate<2>(c.form, newton.u, stress, certify::ContactRule::reference);
  expect_components(plain, components, tolerance, what);
  expect_per_body(c, plain, expected["per_body"], tolerance, total, what);
  const certify::Estimate resolved = certify::estimate<2>(c.form, newton.u, stress);
  // The independent program takes 64 equal parts of each segment, whatever kinks lie in them.
  expect_near(resolved.total_sharp, components["total_resolved"], 2e-6, 0, what + "total_resolved");
  if (expected["dual_norm_below"].is_null()) return;
  certify::DualNorm<2> dual_norm(c.form, {.refinements = 2, .degree = c.space.degree() + 2});
  const double below = dual_norm(newton.u);
  EXPECT_GE(resolved.total_sharp, below) << what;
  // The two programs integrate kinks of T by different rules.
  expect_near(below, expected["dual_norm_below"], what.starts_with("B2_tied") ? 1e-8 : 1e-3, 0,
              what + "dual norm");
}

TEST_P(TwoBodies, ReproducesTheIndependentProgram)
{
  const json expected = reference()["cases"][GetParam()];
  const std::string name = expected["name"];
  const Assembly c(expected);
  EXPECT_EQ(fem::n_free_dofs(c.space, c.form.constraints()), expected["free_dofs"].get<int>());
  const double tolerance = name.ends_with("0.0001") ? 1e-7 : 1e-9;
  for (const auto& [key, iterate] : expected["iterates"].items())
  {
    const bool is_last = key == "last";
    solve::NewtonOptions options{.tolerance = name.ends_with("0.0001") ? 2e-11 : 1e-13};
    if (!is_last) options.max_steps = iterate["k"];
    const solve::NewtonResult<2> newton =
        solve::solve<2>(c.form, {}, options, {.method = algebra::LinearMethod::direct});
    if (is_last)
    {
      EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
      EXPECT_LE(newton.steps.size(), expected["newton_iterations"].get<std::size_t>() + 1);
    }
    expect_iterate(c, newton, iterate, tolerance,
                   name + ", p = " + std::to_string(c.space.degree()) + ", " + key + ": ");
  }
}

/// Meshes that lose so much of the traction between them that without mor there is no bound.
TEST(TwoBodiesBound, NeedsWhatIsLostBetweenTheMeshes)
{
  struct Expected
  {
    int degree;
    double gamma0, without, with;
  };
  for (const auto& [degree, gamma0, without, with] :
       {Expected{3, contact::default_gamma0(3), 0.918, 1.302}, Expected{4, 48, 0.800, 1.358}})
  {
    Stack stack = q2("Q2");
    stack.blocks[0].cells = {4, 2};
    stack.blocks[1].cells = {3, 2};
    const Assembly c(stack, degree, gamma0);
    const solve::NewtonResult<2> newton =
        solve::solve<2>(c.form, {}, {.tolerance = 1e-12}, {.method = algebra::LinearMethod::direct});
    certify::Estimate estimate = certify::estimate<2>(
        c.form, newton.u,
        certify::equilibrate<2>(c.form, newton.u, newton.traction, 0, 0, certify::PatchStress::afw));
    certify::DualNorm<2> dual_norm(c.form, {.refinements = 2, .degree = degree + 2});
    const double below = dual_norm(newton.u);
    EXPECT_NEAR(estimate.total_sharp / below, with, 2e-3) << degree;
    double squares = 0;
    for (certify::BoundComponents& cell : estimate.cells)
    {
      cell.mor = 0;
      squares += std::pow(cell.total_sharp(), 2);
    }
    EXPECT_NEAR(std::sqrt(squares) / below, without, 2e-3) << degree;
  }
}

INSTANTIATE_TEST_SUITE_P(AllCases, TwoBodies, ::testing::Range(0, 19));

}  // namespace

}  // namespace tribound::test
