/// @file adapt_effectivity_test.cpp
/// The bound against the dual norm of the residual on adaptive meshes, graded towards singularities and
/// kinks: on every level, for the iterate at which Newton's method was stopped.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "support/meshes.h"
#include "tribound/certify/truth/true_error.h"
#include "verification/run_adaptively.h"

namespace tribound::test
{

namespace
{

struct Extremes
{
  double smallest = 1e300;
  double largest = 0;
  int levels = 0;
};

/// Adapts the mesh and prints bound / dual norm on every level.
template <int dim>
Extremes effectivities(const mesh::MeshData<dim>& mesh, const ProblemData<dim>& data,
                       const adapt::Method& method, long max_dofs)
{
  Extremes found;
  const adapt::LoopObserver<dim> observer = {
      {},
      [&](const adapt::LevelView<dim>& view)
      {
        certify::DualNorm<dim> dual_norm(view.discrete.form,
                                         {.refinements = 4 - dim, .degree = method.degree + 2});
        const double bound = view.level.estimate.total_sharp;
        const double below = dual_norm(view.level.u);
        std::cout << fmt::format("{}D p = {}  {:5} cells  {:.4e} / {:.4e} = {:.4f}", dim, method.degree,
                                 view.discrete.mesh.n_cells(), bound, below, bound / below)
                  << std::endl;
        found.smallest = std::min(found.smallest, bound / below);
        found.largest = std::max(found.largest, bound / below);
        ++found.levels;
      }};
  const certify::Verdict verdict = run_adaptively<dim>(
      mesh, data, method,
      {.tolerance = 1e-9, .marking = {.theta = 0.6}, .max_levels = 60, .max_dofs = max_dofs}, observer);
  EXPECT_THAT(verdict.reason, ::testing::HasSubstr("adapt.max_dofs"));
  return found;
}

TEST(AdaptEffectivity, IsAtLeastOneOnEveryLevelTresca)
{
  for (int p = 1; p <= 3; ++p)
  {
    const Extremes found =
        effectivities<2>(block<2>({4, 2}), pressed_block<2>(), {.degree = p, .newton = {.tolerance = 1e-12}},
                         p == 1 ? 3000 : 1500 * p);
    EXPECT_GE(found.smallest, 1.0) << "p = " << p;
    EXPECT_LE(found.largest, 2.0) << "p = " << p;
    EXPECT_GE(found.levels, 8) << "p = " << p;
  }
}

TEST(AdaptEffectivity, IsAtLeastOneOnEveryLevelCoulombWithAGap)
{
  const ProblemData<2> coulomb{
      .boundaries = {clamped<2>("left"), loaded<2>("top", 0, formula("-0.1 - 0.05*x")),
                     obstacle<2>("bottom", Coulomb(0.3), formula("0.02*x^2"))},
      .body_force = {formula("0.02*exp(x)"), formula("-0.05*sin(3*x)")}};
  const Extremes found = effectivities<2>(block<2>({4, 2}), coulomb, {.degree = 2}, 3000);
  EXPECT_GE(found.smallest, 1.0);
  EXPECT_LE(found.largest, 2.0);
}

TEST(AdaptEffectivity, IsAtLeastOneOnEveryLevel3D)
{
  const ProblemData<3> data{.boundaries = {clamped<3>("left"), loaded<3>("top", 0, -0.1),
                                           loaded<3>("right", 0.04, 0.06),
                                           obstacle<3>("bottom", Tresca(0.03))}};
  const Extremes found = effectivities<3>(box<3>({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), data, {}, 800);
  EXPECT_GE(found.smallest, 1.0);
  EXPECT_LE(found.largest, 2.2);
}

}  // namespace

}  // namespace tribound::test
