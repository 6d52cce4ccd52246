/// @file load_path_effectivity_test.cpp
/// The bound against the dual norm of the residual at every step of load paths, at the first Newton iterates
/// and the last, with history-dependent interfaces that break and slip.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/bonded_path.h"
#include "verification/path_bound.h"

namespace tribound::test
{
namespace
{

template <int dim>
void expect_guaranteed(const problem::ContactLaw& law, int degree, bool pairs, SeenRange& seen,
                       bool water = false)
{
  SCOPED_TRACE(
      fmt::format("{}D, {}, degree {}, {}", dim, problem::words(law), degree, pairs ? "pair" : "obstacle"));
  mesh::Mesh<dim> mesh(peeled_mesh<dim>(pairs));
  const problem::Problem<dim> problem =
      (water ? peeled_under_water<dim>(law, pairs) : peeled<dim>(law, pairs)).on(mesh);
  adapt::Method method{.degree = degree};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  adapt::LoadPath<dim> path(problem, method, {}, std::move(mesh));
  std::vector<double> before;
  for (const double t : path_of_t)
    ASSERT_EQ(path.advance(t,
                           [&](const adapt::LoadStep<dim>& step)
                           {
                             SCOPED_TRACE(fmt::format("step {}", step.number));
                             expect_above_dual_norm<dim>(step, before, seen);
                             before = step.level.u;
                           }),
              "");
}

TEST(LoadPathBound, IsAboveTheDualNormIn2D)
{
  for (const int degree : {1, 2, 3})
  {
    SeenRange seen;
    for (const problem::ContactLaw& law : bonded_laws())
      for (const bool pairs : {false, true})
        if (degree < 3 || !pairs) expect_guaranteed<2>(law, degree, pairs, seen);
    fmt::print("2D, p = {}: {} iterates {:.3f} to {:.3f}\n", degree, seen.count, seen.least, seen.most);
  }
}

TEST(LoadPathBound, IsAboveTheDualNormIn3D)
{
  for (const int degree : {1, 2})
  {
    SeenRange seen;
    const std::vector<problem::ContactLaw> laws = bonded_laws();
    for (std::size_t i = 0; i < laws.size(); ++i)
      if (degree == 1 ? i != 0 : i == 3) expect_guaranteed<3>(laws[i], degree, i % 2 == 1, seen);
    fmt::print("3D, p = {}: {} iterates {:.3f} to {:.3f}\n", degree, seen.count, seen.least, seen.most);
  }
}

/// On meshes to which the history was transferred in the middle of the path.
TEST(LoadPathBound, IsAboveTheDualNormAfterTransfer)
{
  SeenRange seen;
  for (const problem::ContactLaw& law : bonded_laws())
    for (const bool pairs : {false, true})
    {
      SCOPED_TRACE(fmt::format("{}, {}", problem::words(law), pairs ? "pair" : "obstacle"));
      mesh::Mesh<2> mesh(peeled_mesh<2>(pairs));
      const problem::Problem<2> problem = peeled<2>(law, pairs).on(mesh);
      adapt::Method method{.degree = 2};
      method.stopping.criterion = adapt::Stopping::last_bounded;
      adapt::LoadPath<2> path(problem, method, {.tolerance = 1e-3}, std::move(mesh));
      expect_above_dual_norm_after_transfer<2>(path, seen);
    }
  fmt::print("2D, carried: {} iterates {:.3f} to {:.3f}\n", seen.count, seen.least, seen.most);
}

/// Kinks of the pressure lie inside facets: the drain and the tip of the crack.
TEST(LoadPathBound, IsAboveTheDualNormWithWaterInTheJoint)
{
  const std::vector<problem::ContactLaw> laws = bonded_laws();
  SeenRange seen;
  for (const problem::ContactLaw& law : laws)
    for (const bool pairs : {false, true}) expect_guaranteed<2>(law, pairs ? 1 : 2, pairs, seen, true);
  fmt::print("2D: {} iterates {:.3f} to {:.3f}\n", seen.count, seen.least, seen.most);
  SeenRange in_3d;
  expect_guaranteed<3>(laws[0], 1, false, in_3d, true);
  expect_guaranteed<3>(laws[3], 1, true, in_3d, true);
  fmt::print("3D: {} iterates {:.3f} to {:.3f}\n", in_3d.count, in_3d.least, in_3d.most);
}

}  // namespace
}  // namespace tribound::test
