/// @file adapt_3d_test.cpp
/// The gain by adaptivity in 3D over uniform refinement: a body on a floor with friction, with a re-entrant
/// edge where the stress grows like r^-0.46.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "support/meshes.h"
#include "verification/run_adaptively.h"

namespace tribound::test
{

namespace
{

struct Level
{
  double dofs;
  double bound;
};

/// An L-shaped profile 2 x 2, 1 deep: a wall pressed on the floor, with an arm that is lifted.
std::vector<Level> run(int p, double theta, int max_dofs)
{
  const ProblemData<3> data{.boundaries = {fixed<3>("left", 0, free, free), fixed<3>("back", free, free),
                                           loaded<3>("top", 0, -0.1), loaded<3>("right", 0, 0.05),
                                           obstacle<3>("bottom", Tresca(0.03))}};
  const auto cut_out = [](const Point<3>& x) { return x[0] > 1 && x[1] > 1; };
  std::vector<Level> levels;
  const adapt::LoopObserver<3> observer = {
      {},
      [&](const adapt::LevelView<3>& view)
      {
        const auto free = fem::n_free_dofs(view.discrete.space, view.discrete.form.constraints());
        levels.push_back({double(free), view.level.estimate.total_sharp});
        std::cout << fmt::format("p = {} theta = {:<3} {:6} dofs  bound {:.4e}", p, theta, free,
                                 levels.back().bound)
                  << std::endl;
      }};
  const certify::Verdict verdict = run_adaptively<3>(
      without<3>(box<3>({0, 0, 0}, {2, 2, 1}, {2, 2, 1}), cut_out), data,
      {.degree = p, .stopping = {.finish = false}},
      {.tolerance = 1e-9, .marking = {.theta = theta}, .max_levels = 60, .max_dofs = max_dofs}, observer);
  EXPECT_EQ(verdict.status, certify::RunStatus::budget) << verdict.reason;  // the tolerance is out of reach
  return levels;
}

/// The slope of log(bound) over log(dofs) between the last level and that `back` before it.
double rate(const std::vector<Level>& levels, std::size_t back)
{
  const Level& a = levels.at(levels.size() - 1 - back);
  const Level& b = levels.back();
  return std::log(b.bound / a.bound) / std::log(b.dofs / a.dofs);
}

/// The bound of the last two levels at another number of degrees of freedom, along the line through both.
double bound_at(const std::vector<Level>& levels, double dofs)
{
  return levels.back().bound * std::pow(dofs / levels.back().dofs, rate(levels, 1));
}

/// At such an edge, isotropic cells reach N^(-1/3) for p = 1 and N^-0.54 for p = 2, uniform ones N^(-0.54/3).
TEST(Adapt3D, BeatsUniformMeshesAtAReEntrantEdge)
{
  for (int p = 1; p <= 2; ++p)
  {
    const std::vector<Level> adaptive = run(p, 0.6, 25000);
    const std::vector<Level> uniform = run(p, 1, 45000);
    const double of_uniform = bound_at(uniform, 2 * adaptive.back().dofs);
    EXPECT_LT(adaptive.back().bound, (p == 1 ? 0.95 : 0.7) * of_uniform) << "p = " << p;
    EXPECT_LT(rate(adaptive, 2), rate(uniform, 1) - 0.06) << "p = " << p;
  }
}

}  // namespace

}  // namespace tribound::test
