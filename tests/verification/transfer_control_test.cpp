/// @file transfer_control_test.cpp
/// Controlled load paths on meshes that become finer along them: damage or displacements control t, beyond
/// its peak.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "verification/transfer_paths.h"

namespace tribound::transfers
{
namespace
{

/// On a path controlled by damage, t stays as found on the coarser mesh. The next steps and the search for
/// the peak continue from functions on the finer mesh.
TEST(Transfer, PathsUnderControl)
{
  const problem::ContactLaw law = problem::JointLaw({.tension = {0.05, 0.003}, .coefficient = 0.5});
  for (const bool by_displacement : {false, true})
  {
    const double tolerance = by_displacement ? 0.047 : 0.05;
    Peeled<2> run(law, false, 2, {.tolerance = tolerance});
    adapt::PathProgram program{.targets = {0.2, 0.4},
                               .following = adapt::Following::damage,
                               .damage_step = 0.15,
                               .enough_damage = 0.7};
    if (by_displacement)
    {
      program.following = adapt::Following::displacement;
      program.displacement = {.gauges = {{.boundary = "right", .component = 1}}, .step = 0.01, .until = 0.12};
    }
    const Followed path = followed<2>(run, program, adapt::make_strategy<2>({.tolerance = tolerance}));
    EXPECT_EQ(path.end.failure, "");
    EXPECT_THAT(path.end.notes, testing::IsEmpty());
    EXPECT_EQ(path.verdict.status, certify::RunStatus::certified) << path.verdict.reason;
    EXPECT_GT(path.t.size(), 5U);
    EXPECT_GT(path.cells.back(), path.cells.front());
    EXPECT_EQ(run.path.last()->control, by_displacement ? "displacement" : "damage");
  }
}

/// A block on a bond that is broken from x = 1.2 on, lifted at its top by 0.04 t: t has a peak and then
/// falls.
ProblemData<2> torn()
{
  ProblemData<2> data{
      .boundaries = {problem::with_displacement<2>("top", {problem::Field(0.0), test::formula("0.04*t")}),
                     test::obstacle<2>("bottom", problem::JointLaw({.tension = {0.05, 0.0005}}))}};
  data.boundaries.back().contact->broken = test::formula("x > 1.2");
  return data;
}

adapt::PathProgram beyond_the_peak()
{
  return {.targets = {0.2, 0.4},
          .following = adapt::Following::damage,
          .damage_step = 0.1,
          .enough_damage = 0.95};
}

/// Its peak is within a hundredth of that on a mesh that is fine from the beginning. With these meshes; on
/// others a step beyond the peak may stay, as below.
TEST(Transfer, APeakIsThatOfAFineMesh)
{
  const adapt::PathProgram program = beyond_the_peak();
  adapt::Method method = method_of(2);
  method.stress = certify::PatchStress::afw;
  const mesh::Mesh<2> coarse(peeled_mesh<2>(false));
  const problem::Problem<2> problem = torn().on(coarse);
  adapt::LoadPath<2> on_fine(problem, method, {}, refined<2>(refined<2>(coarse)));
  const adapt::PathEnd fine = adapt::follow<2>(on_fine, program, {}, {});
  ASSERT_TRUE(fine.peak);

  adapt::LoadPath<2> path(problem, method, {.tolerance = 0.06}, mesh::Mesh<2>(peeled_mesh<2>(false)));
  adapt::PathEnd end;
  const certify::Verdict verdict =
      adapt::transfer<2>(path, program, adapt::make_strategy<2>({.tolerance = 0.06, .max_levels = 12}),
                         {.path_end = [&](const adapt::PathEnd& e) { end = e; }});
  EXPECT_EQ(end.failure, "");
  EXPECT_TRUE(certify::is_bound(verdict.status)) << verdict.reason;
  EXPECT_THAT(end.notes, testing::IsEmpty());
  ASSERT_TRUE(end.peak);
  EXPECT_NEAR(end.peak->t, fine.peak->t, 0.01 * fine.peak->t);
}

/// The peak on the finer mesh may be below the t found on the coarser one. Then the finer mesh has no
/// solution, or one on another branch, and the step stays on the coarser mesh.
TEST(Transfer, AStepBeyondThePeakOfTheFinerMeshStays)
{
  const adapt::Method method = method_of(1);
  const problem::Problem<2> problem = torn().on(mesh::Mesh<2>(peeled_mesh<2>(false)));
  const auto notes = [&](double tolerance)
  {
    adapt::LoadPath<2> path(problem, method, {.tolerance = tolerance}, mesh::Mesh<2>(peeled_mesh<2>(false)));
    adapt::PathEnd end;
    const certify::Verdict verdict =
        adapt::transfer<2>(path, beyond_the_peak(), adapt::make_strategy<2>({.tolerance = tolerance}),
                           {.path_end = [&](const adapt::PathEnd& e) { end = e; }});
    EXPECT_EQ(end.failure, "");
    EXPECT_EQ(verdict.status, end.notes.empty() ? certify::RunStatus::certified : certify::RunStatus::budget);
    EXPECT_GT(path.last()->number, 10);
    EXPECT_NEAR(end.peak.value_or(adapt::Peak()).t, 0.74, 0.01);
    return end.notes;
  };
  // The tolerance determines on which meshes a step is beyond the peak.
  std::vector<std::string> all;
  for (const double tolerance : {0.07, 0.1, 0.12, 0.18, 0.25})
    std::ranges::move(notes(tolerance), std::back_inserter(all));
  EXPECT_THAT(all, testing::Each(testing::HasSubstr("stays on the coarser mesh: ")));
  EXPECT_THAT(all, testing::Contains(testing::HasSubstr("the solution is on another branch")));
  EXPECT_THAT(all, testing::Contains(testing::HasSubstr("above newton.tolerance")));
}

}  // namespace
}  // namespace tribound::transfers
