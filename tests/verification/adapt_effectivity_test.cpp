/// @file adapt_effectivity_test.cpp
/// The bound on the meshes that the adaptive algorithm makes, graded towards singularities and kinks, against
/// the dual norm of the residual: on every level, with the iterate at which Newton's method was stopped.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "support/t2d.h"
#include "tribound/adapt/loop.h"
#include "tribound/case/resolve.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/mesh/gmsh.h"

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

/// Adapts the mesh of the case and prints bound / dual norm on every level.
template <int dim>
Extremes effectivities(const std::string& text)
{
  case_file::Config config = case_file::parse_config(text);
  config.method.newton.damping = true;  // full steps cycle on some of the meshes
  auto mesh = std::get<mesh::Mesh<dim>>(mesh::read_mesh(config.mesh));
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  Extremes found;
  const adapt::LoopObserver<dim> observer = {
      {},
      [&](const adapt::LevelView<dim>& view)
      {
        certify::DualNorm<dim> dual_norm(view.discrete.form,
                                         {.refinements = 4 - dim, .degree = config.method.degree + 2});
        const double bound = view.level.estimate.total_sharp;
        const double below = dual_norm(view.level.u);
        std::cout << fmt::format("{}D p = {}  {:5} cells  {:.4e} / {:.4e} = {:.4f}", dim,
                                 config.method.degree, view.discrete.mesh.n_cells(), bound, below,
                                 bound / below)
                  << std::endl;
        found.smallest = std::min(found.smallest, bound / below);
        found.largest = std::max(found.largest, bound / below);
        ++found.levels;
      }};
  const std::atomic<bool> stop = false;
  const certify::Verdict verdict = adapt::adapt<dim>(
      problem, config.method, config.adapt,
      std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, config.method), observer, stop);
  EXPECT_THAT(verdict.reason, ::testing::HasSubstr("adapt.max_dofs"));
  return found;
}

std::string adaptive(int max_dofs)
{
  return fmt::format("adapt = {{ theta = 0.6, tolerance = 1e-9, max_levels = 60, max_dofs = {} }}\n",
                     max_dofs);
}

TEST(AdaptEffectivity, IsAtLeastOneOnEveryLevelTresca)
{
  for (int p = 1; p <= 3; ++p)
  {
    const Extremes found = effectivities<2>(t2d_toml(p, 4, 2) + adaptive(p == 1 ? 3000 : 1500 * p));
    EXPECT_GE(found.smallest, 1.0) << "p = " << p;
    EXPECT_LE(found.largest, 2.0) << "p = " << p;
    EXPECT_GE(found.levels, 8) << "p = " << p;
  }
}

TEST(AdaptEffectivity, IsAtLeastOneOnEveryLevelCoulombWithAGap)
{
  const std::string coulomb = R"toml(degree = 2
mesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
material = { E = 1.0, nu = 0.3 }
load.body = ["0.02*exp(x)", "-0.05*sin(3*x)"]
boundary.left.displacement = [0, 0]
boundary.top.traction = [0, "-0.1 - 0.05*x"]
boundary.bottom.contact = { friction = "coulomb", coefficient = 0.3, gap = "0.02*x^2" }
)toml";
  const Extremes found = effectivities<2>(coulomb + adaptive(3000));
  EXPECT_GE(found.smallest, 1.0);
  EXPECT_LE(found.largest, 2.0);
}

TEST(AdaptEffectivity, IsAtLeastOneOnEveryLevel3D)
{
  const std::string block = R"(mesh.box = { lower = [0, 0, 0], upper = [1, 1, 1], cells = [2, 2, 2] }
material = { E = 1.0, nu = 0.3 }
boundary.left.displacement = [0, 0, 0]
boundary.top.traction = [0, -0.1, 0]
boundary.right.traction = [0.04, 0.06, 0]
boundary.bottom.contact = { friction = "tresca", threshold = 0.03 }
)";
  const Extremes found = effectivities<3>("degree = 1\n" + block + adaptive(800));
  EXPECT_GE(found.smallest, 1.0);
  EXPECT_LE(found.largest, 2.2);
}

}  // namespace

}  // namespace tribound::test
