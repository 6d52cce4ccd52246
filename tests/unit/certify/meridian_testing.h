#pragma once

/// @file meridian_testing.h
/// Axisymmetric problems for tests of the equilibrated stress.

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "support/fields.h"
#include "support/meridian_problem.h"
#include "support/meshes.h"
#include "support/problem_data.h"

namespace tribound::test
{

/// Any values, with those prescribed.
inline std::vector<double> any_displacement(const MeridianProblem& c, unsigned seed)
{
  std::vector<double> u = random_free_vector(c.form.constraints(), 0.1, seed);
  c.form.prescribe(u);
  return u;
}

/// How the mesh meets the axis.
enum class Axis
{
  none,
  vertex,
  edges
};

inline mesh::MeshData<2> skew_mesh(Axis axis, int n)
{
  const auto map = [axis](const Point<2>& x) -> Point<2>
  {
    const Point<2> bent(x[0] * (1 + 0.2 * std::sin(3 * x[1])), x[1] + 0.1 * std::sin(2 * x[0]));
    if (axis == Axis::edges) return bent;
    if (axis == Axis::none) return {1.3 + bent[0], bent[1]};
    return {bent[0] + x[1], bent[1] - 0.7 * x[0]};
  };
  return renumbered(mapped(box<2>({0, 0}, {1, 1}, {n, n}), map), 3);
}

/// Pressed onto an obstacle below, with loads that are no constants; `held`: at the top.
inline ProblemData<2> pressed(bool held, const problem::ContactLaw& law = Coulomb(0.3))
{
  const problem::BoundaryCondition<2> top =
      held ? fixed<2>("top", free, formula("-0.05 + 0.01*x"))
           : loaded<2>("top", formula("0.02*x"), formula("-0.1*(1 + x*y)"));
  return {.boundaries = {top, loaded<2>("right", formula("0.03*y"), formula("0.02*x*y")),
                         obstacle<2>("bottom", law, formula("0.002*x^2"))},
          .body_force = {formula("0.02*y*x^2"), formula("0.1*x - 0.04*y^3")}};
}

/// Tests of meshes on and off the axis and of all degrees.
class OnMeridians : public ::testing::TestWithParam<std::tuple<Axis, int>>
{
 protected:
  [[nodiscard]] Axis axis() const { return std::get<0>(GetParam()); }
  [[nodiscard]] int degree() const { return std::get<1>(GetParam()); }
};

inline const auto meridians =
    ::testing::Combine(::testing::Values(Axis::none, Axis::vertex, Axis::edges), ::testing::Range(1, 5));

}  // namespace tribound::test
