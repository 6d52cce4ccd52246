/// @file weak_symmetry_test.cpp
/// The weakly symmetric stress of axisymmetric problems: its identities, and that it is near.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/energy/balanced_solution.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "unit/certify/weak_symmetry_testing.h"

namespace tribound::test
{

namespace
{

mesh::MeshData<2> far_from_axis(int n)
{
  return mapped(skew_mesh(Axis::none, n),
                [](const Point<2>& x) -> Point<2> {
                  return {18.7 + x[0], x[1]};
                });
}

/// What holds the top: both components, one, or nothing.
std::vector<problem::BoundaryCondition<2>> tops()
{
  return {fixed<2>("top", 0.0, formula("-0.05 + 0.01*x")), fixed<2>("top", free, formula("-0.05 + 0.01*x")),
          fixed<2>("top", 0.0, free), loaded<2>("top", formula("0.02*x"), formula("-0.1*(1 + x*y)"))};
}

void expect_identities(const mesh::MeshData<2>& data, int degree)
{
  for (const problem::BoundaryCondition<2>& top : tops())
  {
    ProblemData<2> of = pressed(false);
    of.boundaries[0] = top;
    const MeridianProblem c(data, of, {.degree = degree});
    const Equilibrium state = in_equilibrium(c, c.form.traction(any_displacement(c, 2)));
    const certify::IdentityDefects defects =
        certify::check_identities<2>(c.form, state.t, weakly_symmetric(c, state));
    EXPECT_TRUE(defects.is_symmetric);
    EXPECT_LE(defects.divergence, 1e-11);
    EXPECT_LE(defects.jump, 1e-11);
    EXPECT_LE(defects.neumann, 1e-11);
    EXPECT_LE(defects.contact, 1e-11);
    EXPECT_LE(defects.symmetry, 1e-11);
  }
}

class WeakSymmetry : public OnMeridians
{
};

TEST_P(WeakSymmetry, Balances)
{
  expect_identities(skew_mesh(axis(), 4), degree());
}

INSTANTIATE_TEST_SUITE_P(Meshes, WeakSymmetry, meridians);

class WeakSymmetryByDegree : public ::testing::TestWithParam<int>
{
};

TEST_P(WeakSymmetryByDegree, BalancesFarFromTheAxis)
{
  expect_identities(far_from_axis(4), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, WeakSymmetryByDegree, ::testing::Range(1, 5));

}  // namespace

}  // namespace tribound::test
