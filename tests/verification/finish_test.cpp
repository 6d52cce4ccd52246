/// @file finish_test.cpp
/// The last level of a run: Newton's method converged there, systems solved anew where an identity asks for
/// it, and the stress that is zero.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "tribound/adapt/loop.h"
#include "tribound/case/resolve.h"
#include "tribound/mesh/gmsh.h"

namespace tribound::test
{

namespace
{

/// What an observer was told, and how the run ended.
template <int dim>
struct Told
{
  std::vector<int> numbers;
  std::vector<adapt::CertifiedLevel<dim>> levels;
  double unsettled = 0;  ///< |integral of T(u) - t^k| on the last level
  certify::Verdict verdict;
};

template <int dim>
Told<dim> run(const std::string& toml)
{
  const case_file::Config config = case_file::parse_config(toml);
  auto mesh = std::get<mesh::Mesh<dim>>(mesh::read_mesh(config.mesh));
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  Told<dim> told;
  const adapt::LoopObserver<dim> observer = {
      {},
      [&](const adapt::LevelView<dim>& view)
      {
        told.numbers.push_back(view.number);
        told.levels.push_back(view.level);
        const contact::NitscheForm<dim>& form = view.discrete.form;
        told.unsettled =
            (contact::contact_resultants<dim>(form, form.traction(view.level.u)).force -
             contact::contact_resultants<dim>(form, std::span<const Point<dim>>(view.level.traction)).force)
                .norm();
      }};
  const std::atomic<bool> stop = false;
  told.verdict = adapt::adapt<dim>(
      problem, config.method, config.adapt,
      std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, config.method), observer, stop);
  return told;
}

const std::string coulomb = "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.3 }\n";

std::string block(int p, const std::string& keys)
{
  return fmt::format(R"(
degree = {}
mesh.box = {{ lower = [0, 0], upper = [2, 1], cells = [8, 4] }}
boundary.left.displacement = [0, 0]
boundary.top.traction = [0.03, -0.1]
output.report = false
)",
                     p) +
         coulomb + keys;
}

const std::string elastic = "material = { E = 1, nu = 0.3 }\n";

/// The criterion stops every level but the last one early; there the forces of contact settle, and the bound
/// hardly moves.
TEST(Finish, ForcesAreThoseOfTheDiscreteSolution)
{
  const std::string adapt = elastic + "adapt = { tolerance = 0.05, max_levels = 40 }\n";
  const Told<2> early = run<2>(block(1, adapt + "newton.finish = false\n"));
  const Told<2> late = run<2>(block(1, adapt));
  ASSERT_EQ(early.numbers, late.numbers);
  EXPECT_EQ(late.verdict.status, certify::RunStatus::certified);
  EXPECT_FALSE(early.levels.back().converged);
  EXPECT_TRUE(late.levels.back().converged);
  EXPECT_GT(early.unsettled, 1e-6);
  EXPECT_LT(late.unsettled, 1e-9);
  for (std::size_t i = 0; i < early.levels.size(); ++i)
    EXPECT_EQ(late.levels[i].steps.size() - late.levels[i].finishing_steps, early.levels[i].steps.size());
  EXPECT_EQ(late.levels.front().finishing_steps, 0);
  EXPECT_GT(late.levels.back().finishing_steps, 0);
  EXPECT_NEAR(late.levels.back().estimate.total_sharp, early.levels.back().estimate.total_sharp,
              0.01 * early.levels.back().estimate.total_sharp);
  EXPECT_LE(late.levels.back().identities.largest(1), 1e-10);
}

/// The limit is found when the next mesh is there: the level is told of again.
TEST(Finish, ALevelThatTurnsOutToBeTheLastIsToldOfAgain)
{
  const Told<2> told = run<2>(block(2, elastic + "adapt = { tolerance = 1e-6, max_dofs = 1200 }\n"));
  EXPECT_EQ(told.verdict.status, certify::RunStatus::budget);
  ASSERT_GE(told.numbers.size(), 3u);
  EXPECT_EQ(told.numbers.back(), told.numbers[told.numbers.size() - 2]);
  EXPECT_FALSE(told.levels[told.levels.size() - 2].converged);
  EXPECT_TRUE(told.levels.back().converged);
}

/// The steps that are allowed are enough for the criterion, not for a residual of 1e-14.
TEST(Finish, WhatDoesNotConvergeStaysAsItIs)
{
  const std::string keys =
      elastic + "adapt = { tolerance = 0.9, max_levels = 0 }\nnewton.tolerance = 1e-14\n";
  const Told<2> early = run<2>(block(1, keys + "newton.finish = false\n"));
  const std::size_t steps = early.levels.back().steps.size();
  const Told<2> late = run<2>(block(1, keys + "newton.max_steps = " + std::to_string(steps) + "\n"));
  EXPECT_EQ(late.verdict.status, certify::RunStatus::certified) << late.verdict.reason;
  EXPECT_EQ(late.levels.back().u == early.levels.back().u, !late.levels.back().converged);
}

/// Systems solved to three digits leave the stress out of equilibrium.
TEST(Finish, SystemsAreSolvedAnewWhereAnIdentityIsViolated)
{
  const Told<2> told = run<2>(
      block(1, elastic + "solver = { method = \"iterative\", tolerance = 1e-3 }\nnewton.tolerance = 1e-3\n"
                         "adapt = { tolerance = 0.9, max_levels = 0 }\n"));
  EXPECT_EQ(told.verdict.status, certify::RunStatus::certified) << told.verdict.reason;
  EXPECT_TRUE(told.levels.back().tightened);
  EXPECT_LE(told.levels.back().identities.largest(1), certify::identity_limit);
}

/// A body that is carried away as a whole has no stress: rounding is compared with rounding.
TEST(Finish, ARigidMotionIsCertified)
{
  for (int p = 1; p <= 4; ++p)
    for (const char* u : {"[0.001, 0.002]", "[\"-0.01*y\", \"0.01*x\"]"})
      for (const char* nu : {"0.3", "0.4999"})
      {
        const Told<2> told = run<2>(fmt::format(R"(
degree = {}
mesh.box = {{ lower = [0, 0], upper = [2, 1], cells = [4, 2] }}
material = {{ E = 1, nu = {} }}
boundary.left.displacement = {}
boundary.right.displacement = {}
boundary.bottom.contact = {{ friction = "coulomb", coefficient = 0.3, gap = 1 }}
)",
                                                p, nu, u, u));
        EXPECT_EQ(told.verdict.status, certify::RunStatus::certified)
            << "p = " << p << ", u = " << u << ", nu = " << nu << ": " << told.verdict.reason;
        EXPECT_TRUE(certify::is_round_off(told.levels.back().estimate, told.levels.back().norms));
      }
}

/// Carried into the tip of a wedge: contact on a ten-thousandth of a side, where the point of no rule lies.
TEST(Finish, ANarrowContactIsNoRigidMotion)
{
  const Told<2> told = run<2>(R"toml(
degree = 2
mesh.box = { lower = [0, 0], upper = [0.958, 1.98], cells = [2, 4] }
material = { E = 0.236, nu = 0.49 }
boundary.left.displacement = [0, -1.948e-06]
boundary.bottom.contact = { gap = "0.03639*abs(x/0.958-0.178)" }
adapt = { tolerance = 0.0256, max_levels = 0 }
)toml");
  EXPECT_NE(told.verdict.status, certify::RunStatus::certified);
  EXPECT_GE(told.levels.back().estimate.total_sharp, 1.32859e-9);  // the dual norm, computed elsewhere
}

/// Rounding that hides a stress that loads or displacements need makes no certificate.
TEST(Finish, AStressDrownedInRoundingIsNotZero)
{
  const std::string rubber = "material = { E = 1, nu = 0.499999999999 }\n";
  EXPECT_EQ(run<2>(block(2, rubber)).verdict.status, certify::RunStatus::not_certified);
  EXPECT_EQ(run<2>(std::string(R"(
degree = 2
mesh.box = { lower = [0, 0], upper = [2, 1], cells = [8, 4] }
boundary.left.displacement = [0, 0]
boundary.right.displacement = [0.1, 0]
)") + rubber + coulomb)
                .verdict.status,
            certify::RunStatus::not_certified);
}

}  // namespace

}  // namespace tribound::test
