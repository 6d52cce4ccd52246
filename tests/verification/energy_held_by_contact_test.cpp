/// @file energy_held_by_contact_test.cpp
/// The bound of the energy-norm error for bodies held by contact rather than displacement conditions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "verification/energy_effectivity.h"

namespace tribound::test
{

namespace
{

const problem::ContactLaw coulomb{Coulomb(0.5)};

/// A block on a floor, pressed unevenly from above and pushed along x. Without friction, symmetry rollers on
/// the left and, in 3D, at the back stop it from sliding.
template <int dim>
ProblemData<dim> resting_block(const problem::ContactLaw& law, problem::Field gap = 0.0)
{
  const bool slides = std::holds_alternative<Frictionless>(law);
  ProblemData<dim> data{.boundaries = {obstacle<dim>("bottom", law, std::move(gap)),
                                       loaded<dim>("top", 0.01, formula("-0.1 - 0.03*x"), 0.01)}};
  if (slides) data.boundaries.push_back(fixed<dim>("left", 0.0, free, free));
  if (slides && dim == 3) data.boundaries.push_back(fixed<dim>("back", free, free, 0.0));
  return data;
}

class HeldByContact : public ::testing::TestWithParam<int>
{
};

TEST_P(HeldByContact, IsABound2D)
{
  const int p = GetParam();
  const certify::RicherSpace richer{.refinements = 3, .degree = p + 1};
  const mesh::MeshData<2> mesh = block<2>({4, 2});
  expect_effectivity<2>("frictionless", resting_block<2>(Frictionless()), mesh, p, richer, 1.8);
  expect_effectivity<2>("Tresca", resting_block<2>(Tresca(0.06)), mesh, p, richer, 1.8);
  expect_effectivity<2>("lifting off", resting_block<2>(Tresca(0.06), formula("0.2*abs(x - 1)")), mesh, p,
                        richer, 2);
  ProblemData<2> heavy = resting_block<2>(Tresca(0.06));
  heavy.body_force = components<2>(formula("0"), formula("-0.1*(1 + x^2*y)"), formula("0"));
  expect_effectivity<2>("heavy", heavy, irregular<2>(mesh), p, richer, 2);
}

TEST_P(HeldByContact, IsABound3D)
{
  const int p = GetParam();
  const certify::RicherSpace richer{.refinements = p > 2 ? 1 : 2, .degree = p + 1};
  const mesh::MeshData<3> mesh = block<3>({2, 1, 1});
  expect_effectivity<3>("frictionless", resting_block<3>(Frictionless()), mesh, p, richer, 2.5);
  expect_effectivity<3>("Tresca", resting_block<3>(Tresca(0.06)), mesh, p, richer, 2.5);
}

TEST_P(HeldByContact, HoldsAtEveryIterate)
{
  const int p = GetParam();
  const problem::Field gap = formula("0.2*abs(x - 1)");
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.06))})
  {
    DiscreteProblem<2> c(block<2>({4, 2}), resting_block<2>(law, gap), {.degree = p});
    const RicherReference<2> reference(c, {.refinements = 3, .degree = p + 1});
    for (const int k : {1, 2, 3, 4})
    {
      c.method.newton.max_steps = k;
      const std::vector<double> u = c.solve().u;
      EXPECT_GE(effectivity<2>(reference, u, energy_bound(c, u)), 1) << k;
    }
  }
}

/// Pressed evenly, with a Poisson ratio of 0 or free to expand sideways.
template <int dim>
void expect_nothing_where_the_stress_is_constant(int p)
{
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.06)), coulomb})
  {
    ProblemData<dim> data = resting_block<dim>(law);
    data.boundaries[1] = loaded<dim>("top", 0, -0.1);
    if (!std::holds_alternative<Frictionless>(law)) data.material = lame(1.0, 0.0);
    const DiscreteProblem<dim> c(irregular<dim>(block<dim>({4, 2}, {2, 2, 2})), data,
                                 {.degree = p, .newton = {.tolerance = 1e-13}});
    const certify::EnergyBound eta = energy_bound(c, c.solve().u);
    ASSERT_EQ(eta.reason, "");
    EXPECT_LE(std::sqrt(2 * std::max(0.0, eta.gap - eta.contact)), 1e-11) << p;
    EXPECT_LE(eta.contact, 1e-15) << p;  // a square
  }
}

TEST_P(HeldByContact, IsNothingWhereTheStressIsConstant)
{
  expect_nothing_where_the_stress_is_constant<2>(GetParam());
  if (GetParam() <= 2) expect_nothing_where_the_stress_is_constant<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, HeldByContact, ::testing::Range(1, 4));

/// The reason that the bound gives for u = 0.
std::string reason(const ProblemData<2>& data, double height = 1)
{
  mesh::MeshData<2> mesh = mapped<2>(block<2>({4, 4}),
                                     [&](const Point<2>& x) -> Point<2> {
                                       return {x[0], height * x[1]};
                                     });
  const DiscreteProblem<2> c(std::move(mesh), data, {.degree = 2});
  return energy_bound(c, std::vector<double>(c.space.n_dofs(), 0.0)).reason;
}

TEST(HeldByContactReasons, NoTractionHoldsTheBody)
{
  const std::string nothing = "no contact traction was found that obeys the law and holds a body";
  EXPECT_EQ(reason(resting_block<2>(coulomb)), "");
  const auto loaded_by = [](const problem::ContactLaw& law, double x, double y)
  {
    ProblemData<2> data = resting_block<2>(law);
    data.boundaries[1] = loaded<2>("top", x, y);
    return data;
  };
  EXPECT_EQ(reason(loaded_by(Frictionless(), 0, 0.1)), nothing);  // is pulled off
  EXPECT_EQ(reason(loaded_by(coulomb, 0.049, -0.1)), "");         // friction holds it
  EXPECT_EQ(reason(loaded_by(coulomb, 0.051, -0.1)), nothing);    // slides
  EXPECT_EQ(reason(loaded_by(Tresca(0.03), 0.029, -0.1)), "");
  EXPECT_EQ(reason(loaded_by(Tresca(0.03), 0.031, -0.1)), nothing);
  EXPECT_EQ(reason(loaded_by(coulomb, 0.04, -0.1), 2.1), "");
  EXPECT_EQ(reason(loaded_by(coulomb, 0.04, -0.1), 2.6), nothing);  // overturns
  ProblemData<2> hardly = resting_block<2>(coulomb);
  hardly.boundaries.push_back(fixed<2>("left", 0.0, free));
  EXPECT_EQ(reason(hardly), "");
}

/// The block turned, on an uneven obstacle, with random loads that press it down.
ProblemData<2> random_rest(std::mt19937& random, const Tensor<2>& frame)
{
  const auto between = [&](double low, double high)
  { return std::uniform_real_distribution<double>(low, high)(random); };
  const Point<2> top = frame * Point<2>(between(-0.02, 0.02), between(-0.2, -0.1));
  const Point<2> right = frame * Point<2>(between(-0.03, 0.03), between(-0.1, 0.03));
  const Point<2> along = frame.col(0);
  const problem::Field gap =
      formula(fmt::format("{}*abs({}*x + {}*y - {})", between(0, 0.1), along[0], along[1], between(0, 2)));
  return {.boundaries = {obstacle<2>("bottom", Tresca(between(0.08, 0.15)), gap),
                         loaded<2>("top", top[0], top[1]), loaded<2>("right", right[0], right[1])}};
}

TEST(HeldByContactRandom, NoBoundFails)
{
  expect_no_failure<2>("random resting blocks", 30,
                       [](unsigned seed)
                       {
                         std::mt19937 random(seed);
                         const Tensor<2> frame = Eigen::Rotation2Dd(0.2 * seed).toRotationMatrix();
                         const auto turned = [&](const Point<2>& x) -> Point<2> { return frame * x; };
                         return DiscreteProblem<2>(
                             mapped<2>(irregular<2>(block<2>({4, 2}), seed), turned),
                             random_rest(random, frame),
                             {.degree = 1 + static_cast<int>(seed % 3), .newton = {.tolerance = 1e-11}});
                       });
}

/// The springs that stop free motions do not disturb multigrid.
TEST(HeldByContactSolver, MultigridGivesTheSameBound)
{
  const DiscreteProblem<3> c(block<3>({6, 3, 3}), resting_block<3>(Tresca(0.06)), {.degree = 2});
  const std::vector<double> u = c.solve().u;
  const auto bound = [&](algebra::LinearMethod method)
  { return certify::EnergyEstimator<3>(c.form, {.method = method})(u); };
  const certify::EnergyBound direct = bound(algebra::LinearMethod::direct);
  const certify::EnergyBound iterative = bound(algebra::LinearMethod::iterative);
  ASSERT_EQ(direct.reason, "");
  ASSERT_EQ(iterative.reason, "");
  EXPECT_NEAR(iterative.bound, direct.bound, 1e-9 * direct.bound);
}

/// One of two blocks is clamped; both stand on the floor.
TEST(HeldByContactBodies, OneOfTwo)
{
  const mesh::MeshData<2> two = side_by_side<2>(block<2>({4, 2}), box<2>({3, 0}, {4, 1}, {2, 2}), "'");
  ProblemData<2> data = resting_block<2>(Tresca(0.06));
  data.boundaries.push_back(clamped<2>("left"));
  data.boundaries.push_back(obstacle<2>("bottom'", Tresca(0.04)));
  data.boundaries.push_back(loaded<2>("top'", 0.02, -0.1));
  for (int p = 1; p <= 3; ++p)
    expect_effectivity<2>("two bodies", data, two, p, {.refinements = 3, .degree = p + 1}, 1.8);
}

}  // namespace

}  // namespace tribound::test
