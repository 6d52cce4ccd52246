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

#include "support/discrete_problem.h"
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
  const certify::Verdict verdict = certify::judge(bound_of(0.02), {}, norms_of(2.0), 0.01);
  EXPECT_EQ(verdict.status, certify::RunStatus::certified);
  EXPECT_EQ(verdict.reason, "");
}

TEST(Judge, AboveTheToleranceTheBoundStillHolds)
{
  const certify::Verdict verdict = certify::judge(bound_of(0.021), {}, norms_of(2.0), 0.01);
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
      EXPECT_EQ(certify::judge(bound_of(0), defects, norms_of(1), 0.01).status,
                certify::RunStatus::not_certified);
    }
}

TEST(Judge, SymmetryIsNoIdentityOfDegreeOne)
{
  EXPECT_EQ(certify::judge(bound_of(0), {0, 0, 0, 0, 1, false}, norms_of(1), 0.01).status,
            certify::RunStatus::certified);
}

TEST(Judge, NumbersThatAreNotFiniteAreNeverCertified)
{
  EXPECT_EQ(certify::judge(bound_of(nan), {}, norms_of(1), 0.01).status, certify::RunStatus::not_certified);
  EXPECT_EQ(certify::judge(bound_of(1), {}, norms_of(nan), 0.01).status, certify::RunStatus::not_certified);
}

TEST(Judge, ABodyWithoutStressIsCertifiedByABoundOfZeroOnly)
{
  EXPECT_EQ(certify::judge(bound_of(0), {}, norms_of(0), 0.01).status, certify::RunStatus::certified);
  const certify::Verdict bounded = certify::judge(bound_of(1e-3), {}, norms_of(0), 0.01);
  EXPECT_EQ(bounded.status, certify::RunStatus::budget);
  EXPECT_THAT(bounded.reason, HasSubstr("the stress is zero"));
}

TEST(Judge, WhatIsNothingButRoundingIsComparedWithRounding)
{
  certify::IdentityDefects defects;
  defects.divergence = 1.05;
  EXPECT_EQ(certify::judge(bound_of(1e-15), defects, norms_of(2e-15, 1e-13), 0.01).status,
            certify::RunStatus::certified);
  EXPECT_EQ(certify::judge(bound_of(1e-15), defects, norms_of(2e-13, 1e-13), 0.01).status,
            certify::RunStatus::not_certified);
  EXPECT_EQ(certify::judge(bound_of(2e-13), defects, norms_of(1e-15, 1e-13), 0.01).status,
            certify::RunStatus::not_certified);
}

/// Moved by u_x on its left side.
DiscreteProblem<2> moved_block(const problem::Field& u_x, const problem::ContactLaw& law = Frictionless())
{
  return {block<2>({4, 2}),
          {.boundaries = {fixed<2>("left", u_x, 0), obstacle<2>("bottom", law)}},
          {.degree = 2}};
}

TEST(Statements, TheInterpolationOfTheDisplacementIsReported)
{
  // (y^3): the interpolant of degree 2 on [0, 1/2] has the error max |s (s - 1/4) (s - 1/2)| near 0.006.
  const DiscreteProblem<2> cubic = moved_block(formula("y^3"));
  const double error = certify::dirichlet_interpolation_error(cubic.form);
  EXPECT_GT(error, 0.005);
  EXPECT_LT(error, std::pow(0.25, 3) * 2 / (3 * std::sqrt(3.0)) * (1 + 1e-12));
  EXPECT_THAT(certify::statements(cubic.form, certify::ContactRule::resolved).not_covered,
              ::testing::Contains(HasSubstr("interpolation")));

  const DiscreteProblem<2> square = moved_block(formula("y^2"));
  EXPECT_LE(certify::dirichlet_interpolation_error(square.form), 1e-15);
  EXPECT_THAT(certify::statements(square.form, certify::ContactRule::resolved).not_covered,
              ::testing::Not(::testing::Contains(HasSubstr("interpolation"))));
}

TEST(Statements, ThePlainContactRuleIsNoBoundAtKinks)
{
  const DiscreteProblem<2> c = moved_block(0);
  const auto kink = ::testing::Contains(HasSubstr("kink"));
  EXPECT_THAT(certify::statements(c.form, certify::ContactRule::reference).not_covered, kink);
  EXPECT_THAT(certify::statements(c.form, certify::ContactRule::resolved).not_covered, ::testing::Not(kink));
}

/// The value at a node where u_D jumps is that of one side, and the interpolant on the other is a ramp.
TEST(Statements, AJumpOfTheDisplacementAtANodeIsReported)
{
  for (const int degree : {1, 2, 3})
    for (const char* jump : {"y > 0.5 ? 0.1 : 0", "y > 0.5 ? 0.1*sin(9*y) : 0"})
    {
      const DiscreteProblem<2> plane(box<2>({0, 0}, {1, 1}, {2, 2}),
                                     {.boundaries = {fixed<2>("left", formula(jump), 0)}},
                                     {.degree = degree});
      const DiscreteProblem<3> space(box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1}),
                                     {.boundaries = {fixed<3>("left", formula(jump), 0)}},
                                     {.degree = degree});
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
  for (const char* u_x : {"max(0, y - 0.5)", "x <= 0 ? 0.1*y : 3", "y > 0.5 ? y - 0.5 : 0"})
  {
    const DiscreteProblem<2> c(box<2>({0, 0}, {1, 1}, {2, 2}),
                               {.boundaries = {fixed<2>("left", formula(u_x), 0)}});
    EXPECT_LE(certify::dirichlet_interpolation_bound(c.form), 1e-13) << u_x;
  }
}

TEST(Statements, SayForWhichLaw)
{
  using ::testing::AllOf;
  const DiscreteProblem<2> tresca = moved_block(0, Tresca(0.1));
  EXPECT_THAT(certify::statements(tresca.form, certify::ContactRule::resolved).law,
              HasSubstr("exists and is unique"));
  const DiscreteProblem<2> coulomb = moved_block(0, Coulomb(0.1));
  EXPECT_THAT(certify::statements(coulomb.form, certify::ContactRule::resolved).law,
              AllOf(HasSubstr("existence is known for small"), HasSubstr("uniqueness is not known")));
}

/// The right-hand side of a block that is held at the bottom and loaded on top, and what its certificate does
/// not cover.
struct Loaded
{
  std::vector<double> load;
  std::vector<std::string> not_covered;
};

Loaded pulled(const problem::Field& pull)
{
  const DiscreteProblem<2> c(box<2>({0, 0}, {1, 1}, {3, 2}),
                             {.boundaries = {clamped<2>("bottom"), loaded<2>("top", 0, pull)}});
  return {{c.form.load().begin(), c.form.load().end()},
          certify::statements(c.form, certify::ContactRule::resolved).not_covered};
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
  const Loaded known = pulled(formula("1 - 2*x"));
  const Loaded unknown = pulled(problem::Field(function));
  function.degree = 1;
  const Loaded polynomial = pulled(problem::Field(function));
  EXPECT_EQ(unknown.load, known.load);
  EXPECT_EQ(polynomial.load, known.load);
  EXPECT_THAT(unknown.not_covered, Contains(HasSubstr("functions without enclosure")));
  EXPECT_THAT(polynomial.not_covered, Not(Contains(HasSubstr("functions without enclosure"))));
  EXPECT_EQ(polynomial.not_covered, known.not_covered);
}

}  // namespace

}  // namespace tribound::test
