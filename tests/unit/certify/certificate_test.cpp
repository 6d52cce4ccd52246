/// @file certificate_test.cpp
/// The verdict: nothing is certified that must not be.

#include "tribound/certify/bound/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "support/discrete_case.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

certify::Bound bound_of(double total)
{
  certify::Bound bound;
  bound.total = bound.total_sharp = total;
  return bound;
}

contact::StressNorms norms_of(double sigma, double round_off = 0)
{
  return {.energy = sigma * sigma, .sigma = sigma, .round_off = round_off};
}

TEST(Judge, CertifiesAtTheTolerance)
{
  const certify::Verdict verdict = certify::judge(bound_of(0.02), {}, 2, norms_of(2.0), 0.01);
  EXPECT_EQ(verdict.status, certify::RunStatus::certified);
  EXPECT_EQ(verdict.reason, "");
}

TEST(Judge, AboveTheToleranceTheBoundStillHolds)
{
  const certify::Verdict verdict = certify::judge(bound_of(0.021), {}, 2, norms_of(2.0), 0.01);
  EXPECT_EQ(verdict.status, certify::RunStatus::budget);
  EXPECT_THAT(verdict.reason, HasSubstr("1.05 %"));
}

TEST(Judge, AViolatedIdentityIsNeverCertified)
{
  for (const auto member : {&certify::IdentityDefects::divergence, &certify::IdentityDefects::jump,
                            &certify::IdentityDefects::neumann, &certify::IdentityDefects::contact,
                            &certify::IdentityDefects::symmetry})
    for (const double defect : {1.1e-8, nan, std::numeric_limits<double>::infinity()})
    {
      certify::IdentityDefects defects;
      defects.*member = defect;
      EXPECT_EQ(certify::judge(bound_of(0), defects, 2, norms_of(1), 0.01).status,
                certify::RunStatus::not_certified);
    }
}

TEST(Judge, SymmetryIsNoIdentityOfDegreeOne)
{
  EXPECT_EQ(certify::judge(bound_of(0), {0, 0, 0, 0, 1}, 1, norms_of(1), 0.01).status,
            certify::RunStatus::certified);
}

TEST(Judge, NumbersThatAreNotFiniteAreNeverCertified)
{
  EXPECT_EQ(certify::judge(bound_of(nan), {}, 1, norms_of(1), 0.01).status,
            certify::RunStatus::not_certified);
  EXPECT_EQ(certify::judge(bound_of(1), {}, 1, norms_of(nan), 0.01).status,
            certify::RunStatus::not_certified);
}

TEST(Judge, ABodyWithoutStressIsCertifiedByABoundOfZeroOnly)
{
  EXPECT_EQ(certify::judge(bound_of(0), {}, 1, norms_of(0), 0.01).status, certify::RunStatus::certified);
  const certify::Verdict bounded = certify::judge(bound_of(1e-3), {}, 1, norms_of(0), 0.01);
  EXPECT_EQ(bounded.status, certify::RunStatus::budget);
  EXPECT_THAT(bounded.reason, HasSubstr("the stress is zero"));
}

TEST(Judge, WhatIsNothingButRoundingIsComparedWithRounding)
{
  certify::IdentityDefects defects;
  defects.divergence = 1.05;
  EXPECT_EQ(certify::judge(bound_of(1e-15), defects, 2, norms_of(2e-15, 1e-13), 0.01).status,
            certify::RunStatus::certified);
  EXPECT_EQ(certify::judge(bound_of(1e-15), defects, 2, norms_of(2e-13, 1e-13), 0.01).status,
            certify::RunStatus::not_certified);
  EXPECT_EQ(certify::judge(bound_of(2e-13), defects, 2, norms_of(1e-15, 1e-13), 0.01).status,
            certify::RunStatus::not_certified);
}

std::string block(const std::string& left, const std::string& contact)
{
  return "degree = 2\nmesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }\n"
         "material = { E = 1, nu = 0.3 }\nboundary.left.displacement = " +
         left + "\nboundary.bottom.contact = " + contact + "\n";
}

TEST(Statements, TheInterpolationOfTheDisplacementIsReported)
{
  // (y^3): the interpolant of degree 2 on [0, 1/2] has the error max |s (s - 1/4) (s - 1/2)| near 0.006.
  const DiscreteCase<2> cubic(block("[\"y^3\", 0]", "{ friction = \"none\" }"));
  const double error = certify::dirichlet_interpolation_error(cubic.form);
  EXPECT_GT(error, 0.005);
  EXPECT_LT(error, std::pow(0.25, 3) * 2 / (3 * std::sqrt(3.0)) * (1 + 1e-12));
  EXPECT_THAT(certify::statements(cubic.form, certify::ContactRule::resolved).not_covered,
              ::testing::Contains(HasSubstr("interpolation")));

  const DiscreteCase<2> square(block("[\"y^2\", 0]", "{ friction = \"none\" }"));
  EXPECT_LE(certify::dirichlet_interpolation_error(square.form), 1e-15);
  EXPECT_THAT(certify::statements(square.form, certify::ContactRule::resolved).not_covered,
              ::testing::Not(::testing::Contains(HasSubstr("interpolation"))));
}

TEST(Statements, ThePlainContactRuleIsNoBoundAtKinks)
{
  const DiscreteCase<2> c(block("[0, 0]", "{ friction = \"none\" }"));
  const auto kink = ::testing::Contains(HasSubstr("kink"));
  EXPECT_THAT(certify::statements(c.form, certify::ContactRule::reference).not_covered, kink);
  EXPECT_THAT(certify::statements(c.form, certify::ContactRule::resolved).not_covered, ::testing::Not(kink));
}

/// The value at a node where u_D jumps is that of one side, and the interpolant on the other is a ramp.
TEST(Statements, AJumpOfTheDisplacementAtANodeIsReported)
{
  for (const int degree : {1, 2, 3})
    for (const std::string formula : {"y > 0.5 ? 0.1 : 0", "y > 0.5 ? 0.1*sin(9*y) : 0"})
    {
      const DiscreteCase<2> plane("degree = " + std::to_string(degree) +
                                      "\nmaterial = { E = 1, nu = 0.3 }\n" +
                                      "boundary.left.displacement = [\"" + formula + "\", 0]\n",
                                  box<2>({0, 0}, {1, 1}, {2, 2}));
      const DiscreteCase<3> space("degree = " + std::to_string(degree) +
                                      "\nmaterial = { E = 1, nu = 0.3 }\n" +
                                      "boundary.left.displacement = [\"" + formula + "\", 0, 0]\n",
                                  box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1}));
      EXPECT_GE(certify::dirichlet_interpolation_bound(plane.form), 0.0977);
      EXPECT_GE(certify::dirichlet_interpolation_bound(space.form), 0.0977);
      EXPECT_GE(certify::dirichlet_interpolation_bound(plane.form),
                certify::dirichlet_interpolation_error(plane.form));
      EXPECT_GE(certify::dirichlet_interpolation_bound(space.form),
                certify::dirichlet_interpolation_error(space.form));
      EXPECT_THAT(certify::statements(plane.form, certify::ContactRule::resolved).not_covered,
                  ::testing::Contains(HasSubstr("interpolation")));
    }
}

/// Kinks at nodes, and a side in the plane of a jump: in the space all the same.
TEST(Statements, DisplacementsInTheSpaceAreSaidToBe)
{
  for (const std::string formula : {"max(0, y - 0.5)", "x <= 0 ? 0.1*y : 3", "y > 0.5 ? y - 0.5 : 0"})
  {
    const DiscreteCase<2> c(
        "degree = 1\nmaterial = { E = 1, nu = 0.3 }\nboundary.left.displacement = [\"" + formula + "\", 0]\n",
        box<2>({0, 0}, {1, 1}, {2, 2}));
    EXPECT_LE(certify::dirichlet_interpolation_bound(c.form), 1e-13) << formula;
  }
}

TEST(Statements, SayForWhichLaw)
{
  const DiscreteCase<2> tresca(block("[0, 0]", "{ friction = \"tresca\", threshold = 0.1 }"));
  EXPECT_THAT(certify::statements(tresca.form, certify::ContactRule::resolved).law,
              HasSubstr("exists and is unique"));
  const DiscreteCase<2> coulomb(block("[0, 0]", "{ friction = \"coulomb\", coefficient = 0.1 }"));
  EXPECT_THAT(certify::statements(coulomb.form, certify::ContactRule::resolved).law,
              HasSubstr("small friction"));
}

/// The right-hand side of a block that is held at the bottom and loaded on top, and what its certificate does
/// not cover.
struct Loaded
{
  std::vector<double> load;
  std::vector<std::string> not_covered;
};

Loaded loaded(const problem::Field& pull)
{
  const mesh::Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {3, 2}));
  const problem::Problem<2> problem(
      mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}},
      {problem::with_displacement<2>("bottom", {0.0, 0.0}), problem::with_traction<2>("top", {0.0, pull})});
  const fem::LagrangeSpace<2> space(mesh, 1);
  const contact::NitscheForm<2> form(problem, space, 10);
  return {{form.load().begin(), form.load().end()},
          certify::statements(form, certify::ContactRule::resolved).not_covered};
}

TEST(Statements, AFunctionOfWhichOnlyValuesAreKnownIsNotCovered)
{
  using ::testing::Contains;
  using ::testing::Not;
  problem::FieldFunction function;
  function.values = [](std::span<const double> x, int dim, std::span<double> values)
  {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1 - 2 * x[dim * i];
  };
  const Loaded formula = loaded(problem::Field("1 - 2*x", {}));
  const Loaded unknown = loaded(problem::Field(function));
  function.degree = 1;
  const Loaded polynomial = loaded(problem::Field(function));
  EXPECT_EQ(unknown.load, formula.load);
  EXPECT_EQ(polynomial.load, formula.load);
  EXPECT_THAT(unknown.not_covered, Contains(HasSubstr("functions without enclosure")));
  EXPECT_THAT(polynomial.not_covered, Not(Contains(HasSubstr("functions without enclosure"))));
  EXPECT_EQ(polynomial.not_covered, formula.not_covered);
}

}  // namespace

}  // namespace tribound::test
