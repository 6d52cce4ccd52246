/// @file finish_test.cpp
/// The last level of a run: convergence of Newton's method, systems solved again if an identity requires it,
/// and zero stress.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/meshes.h"
#include "verification/run_adaptively.h"

namespace tribound::test
{

namespace
{

/// What an observer was told, and how the run ended.
struct Told
{
  std::vector<int> numbers;
  std::vector<adapt::CertifiedLevel<2>> levels;
  double unsettled = 0;  ///< |integral of T(u) - t^k| on the last level
  certify::Verdict verdict;
};

Told run(const mesh::MeshData<2>& mesh, const ProblemData<2>& data, const adapt::Method& method,
         const adapt::AdaptOptions& options = {})
{
  Told told;
  const adapt::LoopObserver<2> observer = {
      {},
      [&](const adapt::LevelView<2>& view)
      {
        told.numbers.push_back(view.number);
        told.levels.push_back(view.level);
        const contact::NitscheForm<2>& form = view.discrete.form;
        told.unsettled = (contact::contact_resultants<2>(form, form.traction(view.level.u)).force -
                          contact::contact_resultants<2>(form, view.level.traction).force)
                             .norm();
      }};
  told.verdict = run_adaptively<2>(mesh, data, method, options, observer);
  return told;
}

/// A block on a rough floor.
Told run(const adapt::Method& method, const adapt::AdaptOptions& options,
         const problem::Material& material = lame(1, 0.3))
{
  return run(
      block<2>({8, 4}),
      {.boundaries = {clamped<2>("left"), loaded<2>("top", 0.03, -0.1), obstacle<2>("bottom", Coulomb(0.3))},
       .material = material},
      method, options);
}

/// The criterion stops every level early except the last; there the contact forces settle, and the bound
/// hardly changes.
TEST(Finish, ForcesAreThoseOfTheDiscreteSolution)
{
  const adapt::AdaptOptions options{.tolerance = 0.05, .max_levels = 40};
  const Told early = run({.degree = 1, .stopping = {.finish = false}}, options);
  const Told late = run({.degree = 1}, options);
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
  EXPECT_LE(late.levels.back().identities.largest(), 1e-10);
}

/// The limit is noticed once the next mesh exists: the level is reported again.
TEST(Finish, ALevelThatTurnsOutToBeTheLastIsToldOfAgain)
{
  const Told told = run({.degree = 2}, {.tolerance = 1e-6, .max_dofs = 1200});
  EXPECT_EQ(told.verdict.status, certify::RunStatus::budget);
  ASSERT_GE(told.numbers.size(), 3u);
  EXPECT_EQ(told.numbers.back(), told.numbers[told.numbers.size() - 2]);
  EXPECT_FALSE(told.levels[told.levels.size() - 2].converged);
  EXPECT_TRUE(told.levels.back().converged);
}

/// If no mesh follows, the criterion need not be evaluated; what it would have decided is reported.
TEST(Finish, OnTheLastMeshOfAllOneIterateIsBounded)
{
  for (const int p : {1, 2})
  {
    const adapt::AdaptOptions options{.tolerance = 1e-6, .max_levels = 2};
    const Told early = run({.degree = p, .stopping = {.finish = false}}, options);
    const Told late = run({.degree = p}, options);
    EXPECT_EQ(late.numbers, (std::vector{0, 1, 2}));
    const adapt::CertifiedLevel<2>& last = late.levels.back();
    EXPECT_TRUE(last.converged);
    EXPECT_EQ(std::ranges::count_if(last.steps, [](const auto& step) { return step.bound.has_value(); }), 1);
    EXPECT_TRUE(last.steps.back().bound && last.steps.back().accepted);
    EXPECT_GT(last.finishing_steps, 0);
    // The criterion may take one more step, as it computes a bound only if an estimate of it lets the
    // iterate pass.
    EXPECT_NEAR(static_cast<int>(last.steps.size()) - last.finishing_steps,
                static_cast<int>(early.levels.back().steps.size()), 1);
    const double bound = early.levels.back().estimate.total_sharp;
    EXPECT_NEAR(last.estimate.total_sharp, bound, 0.02 * bound);
    EXPECT_LE(last.identities.largest(), 1e-10);
  }
}

/// The allowed steps are enough for the criterion, but not for a residual of 1e-14.
TEST(Finish, WhatDoesNotConvergeStaysAsItIs)
{
  const adapt::AdaptOptions options{.tolerance = 0.9, .max_levels = 0};
  const Told early =
      run({.degree = 1, .newton = {.tolerance = 1e-14}, .stopping = {.finish = false}}, options);
  const int steps = static_cast<int>(early.levels.back().steps.size());
  const Told late = run({.degree = 1, .newton = {.tolerance = 1e-14, .max_steps = steps}}, options);
  EXPECT_EQ(late.verdict.status, certify::RunStatus::certified) << late.verdict.reason;
  // Up to rounding: the order of summation in a system depends on its place in memory.
  double difference = 0;
  for (std::size_t i = 0; i < late.levels.back().u.size(); ++i)
    difference = std::max(difference, std::abs(late.levels.back().u[i] - early.levels.back().u[i]));
  EXPECT_EQ(difference <= 1e-15, !late.levels.back().converged);
}

/// Loosely solved systems leave the stress out of equilibrium.
Told with_tolerance(double tolerance)
{
  return run({.degree = 1,
              .newton = {.tolerance = tolerance},
              .solver = {.method = algebra::LinearMethod::iterative, .tolerance = tolerance, .gamma_alg = 0}},
             {.tolerance = 0.9, .max_levels = 0});
}

TEST(Finish, WhatALooseSolverLeavesIsInTheBound)
{
  const Told told = with_tolerance(1e-3);
  EXPECT_EQ(told.verdict.status, certify::RunStatus::certified) << told.verdict.reason;
  EXPECT_FALSE(told.levels.back().tightened);
  EXPECT_GT(told.levels.back().estimate.global.alg, 1e-7 * told.levels.back().estimate.total_sharp);
  EXPECT_LE(told.levels.back().identities.largest(), 1e-12);
}

TEST(Finish, SystemsAreSolvedAnewWhereTheyLeaveALargePartOfTheBound)
{
  const Told told = with_tolerance(0.9);
  EXPECT_EQ(told.verdict.status, certify::RunStatus::certified) << told.verdict.reason;
  EXPECT_TRUE(told.levels.back().tightened);
  EXPECT_LE(told.levels.back().estimate.global.alg, 1e-9 * told.levels.back().estimate.total_sharp);
}

/// A body in rigid motion has no stress: rounding is compared with rounding.
TEST(Finish, ARigidMotionIsCertified)
{
  for (int p = 1; p <= 4; ++p)
    for (const auto& [u_x, u_y] : {std::pair("0.001", "0.002"), std::pair("-0.01*y", "0.01*x")})
      for (const double nu : {0.3, 0.4999})
      {
        const Told told = run(block<2>({4, 2}),
                              {.boundaries = {fixed<2>("left", formula(u_x), formula(u_y)),
                                              fixed<2>("right", formula(u_x), formula(u_y)),
                                              obstacle<2>("bottom", Coulomb(0.3), 1)},
                               .material = lame(1, nu)},
                              {.degree = p});
        EXPECT_EQ(told.verdict.status, certify::RunStatus::certified)
            << "p = " << p << ", u_x = " << u_x << ", nu = " << nu << ": " << told.verdict.reason;
        EXPECT_TRUE(certify::is_round_off(told.levels.back().estimate, told.levels.back().norms));
      }
}

/// Nothing loads the body: errors of gap and threshold formulas between points have no effect on it.
TEST(Finish, ABodyAtRestIsCertifiedOnItsFirstMesh)
{
  const problem::Field gap = formula("0.1*x^2*exp(-x)");
  for (int p = 1; p <= 3; ++p)
    for (const problem::ContactLaw& law :
         {problem::ContactLaw(Frictionless()), problem::ContactLaw(Coulomb(0.3)),
          problem::ContactLaw(Tresca(formula("1+sin(x)"))),
          problem::ContactLaw(Tresca(formula("abs(x-0.3)")))})
    {
      const Told told = run(block<2>({4, 2}),
                            {.boundaries = {clamped<2>("left"), obstacle<2>("bottom", law, gap)},
                             .material = lame(2.1e11, 0.3)},
                            {.degree = p});
      EXPECT_EQ(told.verdict.status, certify::RunStatus::certified) << told.verdict.reason;
      EXPECT_EQ(told.levels.size(), 1u);
      EXPECT_EQ(told.levels.back().estimate.total_sharp, 0);
    }
  // A gap that is negative between all points of the rule is not such a case.
  const Told pressed = run(
      block<2>({4, 2}),
      {.boundaries = {clamped<2>("left"),
                      obstacle<2>("bottom", Frictionless(), formula("x > 0.9 && x < 0.901 ? -0.001 : 0.1"))}},
      {.degree = 2}, {.max_levels = 0});
  EXPECT_GT(pressed.levels.back().estimate.total_sharp, 0);
}

/// When Newton's method fails, it says that contact may be the cause if only contact holds the block.
TEST(Finish, AFailureNamesWhatContactAloneHolds)
{
  const auto failure = [](const problem::BoundaryCondition<2>& left)
  {
    return run(block<2>({4, 2}),
               {.boundaries = {left, loaded<2>("top", 0.05, -0.1), obstacle<2>("bottom", Coulomb(0.6))}},
               {.degree = 1, .newton = {.max_steps = 1}, .other_starts = false}, {.max_levels = 0})
        .verdict;
  };
  const certify::Verdict on_floor = failure(loaded<2>("left", 0, 0));
  EXPECT_EQ(on_floor.status, certify::RunStatus::failed);
  EXPECT_NE(on_floor.reason.find("; the contact that holds a body may have opened or slid"),
            std::string::npos)
      << on_floor.reason;
  EXPECT_EQ(failure(clamped<2>("left")).reason.find("slid"), std::string::npos);
}

/// Moved onto the tip of a wedge: contact on a ten-thousandth of a side, where no rule has a point.
TEST(Finish, ANarrowContactIsNoRigidMotion)
{
  const Told told =
      run(box<2>({0, 0}, {0.958, 1.98}, {2, 4}),
          {.boundaries = {fixed<2>("left", 0, -1.948e-06),
                          obstacle<2>("bottom", Frictionless(), formula("0.03639*abs(x/0.958-0.178)"))},
           .material = lame(0.236, 0.49)},
          {.degree = 2}, {.tolerance = 0.0256, .max_levels = 0});
  EXPECT_NE(told.verdict.status, certify::RunStatus::certified);
  EXPECT_GE(told.levels.back().estimate.total_sharp, 1.32859e-9);  // the dual norm, computed elsewhere
}

/// There is no certificate if rounding hides a stress that loads or displacements require.
TEST(Finish, AStressDrownedInRoundingIsNotZero)
{
  const problem::Material rubber = lame(1, 0.499999999999);
  EXPECT_EQ(run({.degree = 2}, {}, rubber).verdict.status, certify::RunStatus::not_certified);
  const Told squeezed =
      run(block<2>({8, 4}),
          {.boundaries = {clamped<2>("left"), fixed<2>("right", 0.1, 0), obstacle<2>("bottom", Coulomb(0.3))},
           .material = rubber},
          {.degree = 2});
  EXPECT_EQ(squeezed.verdict.status, certify::RunStatus::not_certified);
}

}  // namespace

}  // namespace tribound::test
