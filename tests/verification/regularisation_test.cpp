/// @file regularisation_test.cpp
/// The regularised variant, method section 7: identities and guarantee hold at every iterate for every delta,
/// the parts of the stress add up, and as delta tends to 0 everything tends to the plain method.

#include "tribound/adapt/regularisation.h"

#include <fmt/format.h>

#include <cmath>

#include "effectivity.h"
#include "tribound/adapt/level.h"
#include "tribound/base/norm.h"
#include "tribound/certify/bound/checks.h"

namespace tribound::test
{

namespace
{

/// A block on rollers, pressed down and pulled sideways; its contact tractions are about 0.1.
template <int dim>
NamedProblem<dim> pulled(const std::string& name, const problem::ContactLaw& law,
                         const problem::Field& gap = 0)
{
  ProblemData<dim> data{.boundaries = {fixed<dim>("left", 0, 0, free), loaded<dim>("top", 0, -0.1, 0.02),
                                       loaded<dim>("right", 0.04, 0.06), obstacle<dim>("bottom", law, gap)},
                        .body_force = components<dim, problem::Field>(0.02, formula("-0.05*y"), 0.01)};
  if (dim == 3) data.boundaries.push_back(fixed<dim>("back", free, free, 0));
  return {name, data};
}

template <int dim>
std::vector<NamedProblem<dim>> problems()
{
  return {pulled<dim>("frictionless", Frictionless(), formula("0.01*x^2")),
          pulled<dim>("Tresca", Tresca(0.03)), pulled<dim>("Coulomb", Coulomb(0.4), formula("0.004*x^2"))};
}

const ProblemData<2> tresca_problem = problems<2>()[1].data;

template <int dim>
mesh::MeshData<dim> bent_block()
{
  return distorted(block<dim>({4, 2}, {2, 1, 1}), 1);
}

constexpr double large_delta = 0.1;

adapt::Method method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-12}};
}

/// The largest defect over all iterates. When Newton's method has converged, it continues with delta / 4.
template <int dim>
double largest_defect(int p, const mesh::MeshData<dim>& mesh, const ProblemData<dim>& problem)
{
  const DiscreteProblem<dim> c(mesh, problem, method(p));
  double largest = 0;
  int n_converged = 0;
  const auto observer = [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    const double delta = iterate.step.delta;
    const certify::Stress<dim> stress =
        certify::equilibrate<dim>(c.form, iterate.u(), iterate.traction, 0, delta);
    EXPECT_FALSE(stress.reg.empty());
    largest = std::max(largest, certify::check_identities<dim>(c.form, iterate.traction, stress).largest());
    solve::NewtonAdvice advice = false;
    if (iterate.converged && ++n_converged < 3) advice.delta = delta / 4;
    return advice;
  };
  const solve::NewtonResult<dim> result = c.solve(large_delta, observer);
  EXPECT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_EQ(result.steps.front().delta, large_delta);
  EXPECT_EQ(result.steps.back().delta, large_delta / 16);
  return largest;
}

class Regularisation : public ::testing::TestWithParam<int>
{
};

template <int dim>
void expect_identities(int p)
{
  for (const NamedProblem<dim>& problem : problems<dim>())
  {
    const double defect = largest_defect<dim>(p, bent_block<dim>(), problem.data);
    fmt::print("{}D, p = {}, {}: largest defect {:.1e}\n", dim, p, problem.name, defect);
    EXPECT_LE(defect, p <= 2 ? 1e-11 : 1e-10) << problem.name;
  }
}

TEST_P(Regularisation, IdentitiesHoldAtEveryIterateIn2D)
{
  expect_identities<2>(GetParam());
}

TEST_P(Regularisation, IdentitiesHoldAtEveryIterateIn3D)
{
  expect_identities<3>(GetParam());
}

/// The block on another block, with non-matching meshes.
template <int dim>
void expect_identities_between_bodies(int p)
{
  Point<dim> lower = Point<dim>::Zero();
  lower[1] = -1;
  Point<dim> upper = Point<dim>::Ones();
  upper[0] = 2;
  upper[1] = 0;
  std::array<int, dim> cells{3, 1};
  if constexpr (dim == 3) cells[2] = 2;
  mesh::MeshData<dim> mesh =
      side_by_side(block<dim>({4, 2}, {2, 1, 1}), box<dim>(lower, upper, cells), "_below");
  mesh.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.03)),
        problem::ContactLaw(Coulomb(0.4)), problem::ContactLaw(problem::Tied())})
  {
    const ProblemData<dim> problem{
        .boundaries = {fixed<dim>("left", 0, 0), loaded<dim>("top", 0, -0.1, 0.02),
                       loaded<dim>("right", 0.04, 0.06), clamped<dim>("bottom_below")},
        .pairs = {pair<dim>("bottom", "top_below", law)}};
    EXPECT_LE(largest_defect<dim>(p, mesh, problem), p <= 2 ? 1e-11 : 1e-10) << problem::words(law);
  }
}

TEST_P(Regularisation, IdentitiesHoldBetweenBodies)
{
  expect_identities_between_bodies<2>(GetParam());
  if (GetParam() < 3) expect_identities_between_bodies<3>(GetParam());
}

/// ||a - b - c|| / ||scale||; b and c may be empty (zero).
double distance(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c,
                const std::vector<double>& scale)
{
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    square += std::pow(a[i] - (b.empty() ? 0 : b[i]) - (c.empty() ? 0 : c[i]), 2);
  return std::sqrt(square) / norm(scale);
}

/// The patch stresses depend linearly on their data. For the same iterate and t^k, sigma_dis is independent
/// of delta, and sigma_lin + sigma_reg is the plain sigma_lin. Without sigma_reg an identity fails.
template <int dim>
void expect_parts_to_add_up(int p)
{
  for (const NamedProblem<dim>& problem : problems<dim>())
  {
    SCOPED_TRACE(problem.name);
    DiscreteProblem<dim> c(bent_block<dim>(), problem.data, method(p));
    c.method.newton.max_steps = 2;
    const solve::NewtonResult<dim> result = c.solve(large_delta);
    const certify::Stress<dim> plain = certify::equilibrate<dim>(c.form, result.u, result.traction);
    certify::Stress<dim> stress =
        certify::equilibrate<dim>(c.form, result.u, result.traction, 0, large_delta);
    EXPECT_TRUE(plain.reg.empty());
    EXPECT_LE(distance(stress.dis, plain.dis, {}, plain.dis), 1e-12);
    EXPECT_LE(distance(plain.lin, stress.lin, stress.reg, plain.dis), 1e-12);
    EXPECT_GT(norm(stress.reg), 1e-4 * norm(plain.dis));
    stress.reg.clear();
    EXPECT_GT(certify::check_identities<dim>(c.form, result.traction, stress).contact, 1e-6);
  }
}

TEST_P(Regularisation, PartsOfTheStressAddUp)
{
  expect_parts_to_add_up<2>(GetParam());
  if (GetParam() < 3) expect_parts_to_add_up<3>(GetParam());
}

TEST_P(Regularisation, TheBoundHoldsForLargeDelta)
{
  for (const NamedProblem<2>& problem : problems<2>())
    for (const NamedMesh<2>& mesh :
         {NamedMesh<2>{"box 4x2", block<2>({4, 2})}, NamedMesh<2>{"distorted", bent_block<2>()}})
      for (const double delta : {0.5, 0.05})
      {
        const std::string name = fmt::format("{}, delta = {}", problem.name, delta);
        expect_guaranteed(effectivities<2>({GetParam(), {name, problem.data}, mesh, 1e-12}, delta), name);
      }
}

TEST(Regularisation3D, TheBoundHoldsForLargeDelta)
{
  for (const NamedProblem<3>& problem : problems<3>())
  {
    const std::string name = problem.name + ", delta = 0.2";
    expect_guaranteed(effectivities<3>({1, {name, problem.data}, {"distorted", bent_block<3>()}, 1e-12}, 0.2),
                      name);
  }
}

/// u, bound and eta_reg of the converged solution for T_delta.
struct Converged
{
  std::vector<double> u;
  certify::Estimate eta;
};

Converged converged(const DiscreteProblem<2>& c, double delta)
{
  solve::NewtonResult<2> result = c.solve(delta);
  EXPECT_EQ(result.status, solve::NewtonStatus::converged) << "delta = " << delta;
  certify::Estimate eta = certify::estimate<2>(
      c.form, result.u, certify::equilibrate<2>(c.form, result.u, result.traction, 0, delta));
  return {std::move(result.u), std::move(eta)};
}

/// |T_delta - T| <= delta / 4 on the part of Gamma_C where P is nearer than delta to a kink, and zero
/// elsewhere: everything tends to the plain method at least as fast as delta.
TEST_P(Regularisation, TendsToThePlainMethod)
{
  for (const NamedProblem<2>& problem : problems<2>())
  {
    SCOPED_TRACE(problem.name);
    const DiscreteProblem<2> c(bent_block<2>(), problem.data, method(GetParam()));
    const Converged plain = converged(c, 0);
    EXPECT_EQ(plain.eta.global.regularisation(), 0);
    for (const double delta : {0.1, 1e-2, 1e-3, 1e-4, 1e-6})
    {
      const Converged regularised = converged(c, delta);
      const double apart = distance(regularised.u, plain.u, {}, plain.u);
      const double reg = regularised.eta.global.regularisation();
      fmt::print(
          "p = {}, {}, delta = {:g}: |u_delta - u| / |u| = {:.1e}, eta_reg = {:.1e}, bound {:.6f}, plain "
          "{:.6f}\n",
          GetParam(), problem.name, delta, apart, reg, regularised.eta.total_sharp, plain.eta.total_sharp);
      EXPECT_LE(apart, delta);
      EXPECT_LE(reg, delta);
      EXPECT_NEAR(regularised.eta.total_sharp, plain.eta.total_sharp, delta);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, Regularisation, ::testing::Range(1, 4));

/// The outer loop on one mesh: delta shrinks by the factor each time, and both criteria hold at the end.
TEST(RegularisedLevel, EndsWhereBothCriteriaHold)
{
  for (const adapt::Stopping stopping : {adapt::Stopping::adaptive, adapt::Stopping::tolerance})
  {
    SCOPED_TRACE(static_cast<int>(stopping));
    const DiscreteProblem<2> c(bent_block<2>(), tresca_problem,
                               {.degree = 2,
                                .newton = {.tolerance = 1e-12},
                                .stopping = {.criterion = stopping},
                                .regularisation = {{.delta = 2, .factor = 0.5, .gamma_reg = 0.01}}});
    const adapt::CertifiedLevel<2> level = adapt::solve_and_certify<2>(c.form, {}, c.method);
    ASSERT_TRUE(level.solved()) << level.failure;
    EXPECT_TRUE(adapt::regularisation_is_negligible(level.estimate.global, 0.01));
    EXPECT_TRUE(adapt::linearisation_is_negligible(level.estimate.global, 0.1));
    EXPECT_LE(level.identities.largest(), 1e-10);
    EXPECT_GT(*level.delta_updates, 0);
    int n_updates = 0;
    double delta = level.steps[1].step.delta;
    EXPECT_EQ(level.steps[0].step.delta, 0) << "the first step shows the size of the traction";
    for (std::size_t k = 2; k < level.steps.size(); ++k)
    {
      if (level.steps[k].step.delta == delta) continue;
      EXPECT_DOUBLE_EQ(level.steps[k].step.delta, 0.5 * delta);
      delta = level.steps[k].step.delta;
      ++n_updates;
    }
    EXPECT_EQ(n_updates, *level.delta_updates);
    EXPECT_EQ(level.delta, delta) << "carried to the next mesh";
    const adapt::CertifiedLevel<2> again =
        adapt::solve_and_certify<2>(c.form, level.u, c.method, {}, level.delta);
    EXPECT_EQ(again.steps[0].step.delta, delta);
    EXPECT_EQ(again.delta_updates, 0);
  }
}

TEST(RegularisedLevel, KeepsToTheLimitOfUpdates)
{
  const DiscreteProblem<2> c(bent_block<2>(), tresca_problem,
                             {.degree = 1,
                              .newton = {.tolerance = 1e-12},
                              .regularisation = {{.delta = 5, .gamma_reg = 1e-9, .max_updates = 2}}});
  const adapt::CertifiedLevel<2> level = adapt::solve_and_certify<2>(c.form, {}, c.method);
  ASSERT_TRUE(level.solved()) << level.failure;
  EXPECT_EQ(level.delta_updates, 2);
  EXPECT_GT(level.estimate.global.regularisation(), 0) << "which the bound contains";
}

TEST(MeanContactTraction, IsTheRootMeanSquare)
{
  const DiscreteProblem<2> c(block<2>({4, 2}), tresca_problem);
  const std::vector<Point<2>> t(c.form.n_contact_points(), Point<2>(0.3, -0.4));
  EXPECT_NEAR(adapt::mean_contact_traction<2>(c.form, t), 0.5, 1e-14);
  const DiscreteProblem<2> without(block<2>({4, 2}), {.boundaries = {clamped<2>("left")}});
  EXPECT_EQ(adapt::mean_contact_traction<2>(without.form, {}), 0);
}

}  // namespace

}  // namespace tribound::test
