/// @file initial_stress_test.cpp
/// Temperature and initial stress: free expansion without stress, constrained bars, the numbers of an
/// independent program, bounds above the dual norm.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "support/two_blocks.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/mesh/refine.h"
#include "verification/energy_effectivity.h"
#include "verification/loads_reference.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

/// A region that is all of block().
template <int dim>
problem::Region<dim> heated(problem::Material material, double alpha, problem::Field temperature,
                            problem::Field reference = 0.0)
{
  material.expansion = alpha;
  problem::Region<dim> region{.name = "box", .material = material};
  region.temperature = std::move(temperature);
  region.reference_temperature = std::move(reference);
  return region;
}

problem::BoundaryCondition<2> slider(const std::string& name, const problem::Field& prescribed)
{
  return obstacle<2>(name, problem::Slider(), prescribed);
}

problem::BoundaryCondition<2> on_springs(const std::string& name, double normal, double tangential)
{
  problem::BoundaryCondition<2> condition;
  condition.name = name;
  condition.spring = problem::Spring<2>{normal, tangential};
  return condition;
}

TEST(InitialStress, AgreesWithThePrototype)
{
  const problem::Region<2> region = heated<2>(lame(1, 0.3), 0.02, formula("1 + x*y"));
  expect_reference("thermal",
                   {.boundaries = {clamped<2>("left"), loaded<2>("right", 0.04, 0.06),
                                   loaded<2>("top", 0.0, -0.1), obstacle<2>("bottom", problem::Coulomb(0.5))},
                    .regions = {region}});
  expect_reference("everything", {.boundaries = {on_springs("left", 2, 1), loaded<2>("right", 0.04, 0.06),
                                                 slider("top", formula("-0.03 + 0.01*x")),
                                                 obstacle<2>("bottom", problem::Coulomb(0.5))},
                                  .regions = {region}});
}

/// The free expansion of a body with alpha theta = a + b . x, in 3D and plane stress: eps = alpha theta I,
/// u_i = (a + b . x) x_i - b_i |x|^2 / 2. In plane strain alpha is (1 + nu) times as large in the plane.
template <int dim>
Point<dim> expansion(double a, const Point<dim>& b, const Point<dim>& x)
{
  return (a + b.dot(x)) * x - x.squaredNorm() / 2 * b;
}

template <int dim>
void expect_free(problem::PlaneModel plane, int p)
{
  const double nu = 0.3;
  const double alpha = 1e-3;
  const Point<dim> b = p == 1 ? Point<dim>(Point<dim>::Zero()) : Point<dim>(Point<dim>::LinSpaced(0.7, -0.4));
  const std::string theta = fmt::format("20 + 2 + {}*x + {}*y{}", b[0], b[1],
                                        dim == 3 ? fmt::format(" + {}*z", b[dim - 1]) : std::string());
  ProblemData<dim> data{.boundaries = {}};
  data.regions = {heated<dim>(lame(2.0, nu, plane), alpha, formula(theta), 20.0)};
  const double in_plane = dim == 2 && plane == problem::PlaneModel::strain ? 1 + nu : 1;
  // the values of the exact solution in two components on the left, of all in 3D, hold the body
  const auto component = [&](int i)
  {
    const auto value = [=](std::span<const double> x, int, std::span<double> values)
    {
      for (std::size_t q = 0; q < values.size(); ++q)
        values[q] = expansion<dim>(2 * alpha * in_plane, alpha * in_plane * b,
                                   Eigen::Map<const Point<dim>>(&x[dim * q]))[i];
    };
    return problem::Field(problem::FieldFunction{.values = value, .degree = 2});
  };
  data.boundaries = {problem::with_displacement<dim>(
      "left",
      components<dim, std::optional<problem::Field>>(component(0), component(1), component(dim - 1)))};
  const DiscreteProblem<dim> c(renumbered(block<dim>({2, 2}, {1, 1, 1}), 3), data,
                               {.degree = p, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> solved = c.solve();
  const std::vector<Point<dim>> nodes = c.space.node_points();
  double error = 0;
  for (Index i = 0; i < c.space.n_nodes(); ++i)
    error = std::max(error, (Point<dim>(&solved.u[dim * i]) -
                             expansion<dim>(2 * alpha * in_plane, alpha * in_plane * b, nodes[i]))
                                .norm());
  EXPECT_LE(error, 1e-14);
  const contact::StressNorms norms = contact::stress_norms<dim>(c.problem, c.space, solved.u);
  EXPECT_LE(norms.sigma, 1e-15);
  const auto stress = certify::equilibrate<dim>(c.form, solved.u, solved.traction);
  const certify::Estimate bound = certify::estimate<dim>(c.form, solved.u, stress);
  EXPECT_LE(bound.total_sharp, 2e-15);
}

TEST(InitialStress, FreeExpansionHasNoStress)
{
  for (int p = 1; p <= 4; ++p)
  {
    SCOPED_TRACE(p);
    expect_free<2>(problem::PlaneModel::strain, p);
    expect_free<2>(problem::PlaneModel::stress, p);
    if (p <= 3) expect_free<3>(problem::PlaneModel::strain, p);
  }
}

/// A bar between walls, free to the sides: sigma_xx = -E alpha theta in 3D and plane stress; in plane strain
/// divided by 1 - nu. Alternatively under an initial stress xx = -s, which only walls can bear.
template <int dim>
void expect_constrained(problem::PlaneModel plane, bool is_heated)
{
  const double E = 2;
  const double nu = 0.3;
  ProblemData<dim> data;
  data.regions = {heated<dim>(lame(E, nu, plane), is_heated ? 1e-3 : 0, 7.0, 2.0)};
  if (!is_heated) data.regions[0].initial_stress[0] = -0.01;
  const double expected =
      is_heated ? -E * 1e-3 * 5 / (dim == 2 && plane == problem::PlaneModel::strain ? 1 - nu : 1) : -0.01;
  data.boundaries = {obstacle<dim>("left"), fixed<dim>("right", 0.0, free, free),
                     fixed<dim>("bottom", free, 0.0, free)};
  if (dim == 3) data.boundaries.push_back(fixed<dim>("back", free, free, 0.0));
  const DiscreteProblem<dim> c(renumbered(block<dim>({2, 2}, {2, 1, 1}), 3), data,
                               {.degree = 2, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> solved = c.solve();
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : c.form.contact_states(solved.u, k))
      EXPECT_NEAR(state.pressure, -expected, 1e-12);
  const contact::StressNorms norms = contact::stress_norms<dim>(c.problem, c.space, solved.u);
  EXPECT_NEAR(norms.sigma, -expected * std::sqrt(2.0), 1e-12);  // the volume is 2
  const certify::Balance balance =
      certify::balance<dim>(c.form, solved.u, solved.traction, Point<dim>::Zero());
  EXPECT_NEAR(balance.rows.back().force[0], 0, 1e-12);
}

TEST(InitialStress, BearsAgainstWalls)
{
  for (const bool is_heated : {true, false})
  {
    expect_constrained<2>(problem::PlaneModel::strain, is_heated);
    expect_constrained<2>(problem::PlaneModel::stress, is_heated);
    expect_constrained<3>(problem::PlaneModel::strain, is_heated);
  }
}

/// A strip of temperature, whose ends lie inside cells, in a body at rest: the norm of the stress is at most
/// that of the initial stress.
TEST(InitialStress, NormDoesNotExceedThatOfTheStress)
{
  for (const int p : {1, 2, 3})
  {
    const ProblemData<2> data{
        .boundaries = {clamped<2>("left")},
        .regions = {heated<2>(lame(1.0, 0.3), 0.1, formula("abs(x - 0.8) < 0.17 ? 1 : 0"), 0.0)}};
    const DiscreteProblem<2> c(renumbered(block<2>({4, 2}, {2, 1}), 3), data, {.degree = p});
    const double beta = problem::thermal_modulus(c.problem.material(0));
    const double exact = beta * std::sqrt(2 * 0.34);  // the strip has the height 1
    const double norm =
        contact::stress_norms<2>(c.problem, c.space, std::vector<double>(c.space.n_dofs(), 0.0)).sigma;
    EXPECT_LE(norm, exact * (1 + 1e-9)) << p;
    EXPECT_GE(norm, 0.8 * exact) << p;
  }
}

/// Two blocks between walls with initial stresses s along y, on meshes that do not match: sigma_yy is their
/// mean in both, and the means of both sides on the interface have to be taken of C eps(u) + sigma_0.
template <int dim>
void expect_in_series(const problem::ContactLaw& law, int p)
{
  const auto region = [](const char* name, double s)
  {
    problem::Region<dim> result{.name = name, .material = lame(1.0, 0.0)};
    result.initial_stress[1] = s;
    return result;
  };
  ProblemData<dim> data{
      .boundaries = {fixed<dim>("top", free, 0.0, free), fixed<dim>("bottom_below", free, 0.0, free)},
      .regions = {region("box", -0.3), region("box_below", -0.1)},
      .pairs = {pair<dim>("bottom", "top_below", law)}};
  for (const char* side : {"left", "left_below"})
    data.boundaries.push_back(fixed<dim>(side, 0.0, free, free));
  if (dim == 3)
    for (const char* side : {"back", "back_below"})
      data.boundaries.push_back(fixed<dim>(side, free, free, 0.0));
  const DiscreteProblem<dim> c(two_blocks<dim>(), data, {.degree = p, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> solved = c.solve();
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : c.form.contact_states(solved.u, k))
      EXPECT_NEAR(state.traction[1], -0.2 * state.normal[1], 1e-12);
  const auto stress = certify::equilibrate<dim>(c.form, solved.u, solved.traction);
  EXPECT_LE(certify::estimate<dim>(c.form, solved.u, stress).total_sharp, 1e-12);
}

TEST(InitialStress, DiffersOnBothSidesOfAnInterface)
{
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.1)), problem::ContactLaw(Tied())})
    for (int p = 1; p <= 3; ++p)
    {
      SCOPED_TRACE(p);
      expect_in_series<2>(law, p);
      if (p < 3) expect_in_series<3>(law, p);
    }
}

/// The interpolant on contact is no farther from the given stress than the form says.
TEST(InitialStress, InterpolationIsBounded)
{
  for (const char* const field : {"sin(6*x)", "x^5*y + x^2", "x < 0.6 ? 1 : x", "x < 1 ? 1 : 3", "exp(3*x)"})
    for (int p = 1; p <= 4; ++p)
    {
      const DiscreteProblem<2> c(block<2>({4, 2}),
                                 {.boundaries = {clamped<2>("left"), obstacle<2>("bottom")},
                                  .regions = {heated<2>(lame(1, 0.3), 1, formula(field))}},
                                 {.degree = p});
      for (std::size_t k = 0; k < c.form.segments().size(); ++k)
      {
        const auto interpolated = c.form.initial_tractions().at_points(k);
        double largest = 0;
        for (int q = 0; q < c.form.n_segment_points(); ++q)
        {
          const Point<2> given = c.problem.initial_stress(0, c.form.contact_points(k)[q].x) * Point<2>(0, -1);
          largest = std::max(largest, (interpolated.col(q) - given).norm());
        }
        EXPECT_LE(largest, c.form.initial_tractions().deviation(k) + 1e-14) << field << ", p = " << p;
        const double jump = std::string(field) == "x < 1 ? 1 : 3" ? 12 : 0;  // of both sides, on either
        EXPECT_LE(c.form.initial_tractions().deviation(k), 1e3 * largest + jump + 1e-12)
            << field << ", p = " << p;
      }
    }
}

/// What rules miss of the initial stress, on contact and in cells, is in the bounds.
TEST(InitialStress, WhatIsMissedCounts)
{
  const problem::Material material = lame(1, 0.3);
  const DiscreteProblem<2> c(
      block<2>({4, 2}),
      {.boundaries = {clamped<2>("left"), obstacle<2>("bottom", problem::Coulomb(0.5))},
       .regions = {heated<2>(material, 0.1, formula("sin(6*x)"))}},
      {.degree = 2, .newton = {.tolerance = 1e-12}});
  const solve::NewtonResult<2> solved = c.solve();
  double on_contact = 0;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
    on_contact += c.form.segments()[k].h * c.form.segments()[k].measure *
                  std::pow(c.form.initial_tractions().deviation(k), 2);
  double in_cells = 0;
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    in_cells += std::pow(c.form.data().initial_stress().remainder(cell).oscillation, 2);
  ASSERT_GT(std::min(on_contact, in_cells), 1e-8);
  const auto stress = certify::equilibrate<2>(c.form, solved.u, solved.traction);
  const certify::BoundComponents bound = certify::estimate<2>(c.form, solved.u, stress).global;
  EXPECT_GE(bound.cnt, std::sqrt(on_contact));
  EXPECT_GE(bound.frc, 1.5 * std::sqrt(on_contact));
  EXPECT_GE(bound.str, std::sqrt(in_cells));
  const certify::EnergyBound energy = certify::EnergyEstimator<2>(c.form, {})(solved.u);
  ASSERT_EQ(energy.reason, "");
  EXPECT_GE(energy.oscillation, std::sqrt(in_cells / (2 * material.mu)));
}

/// Heated by 10 degrees and held, plane strain has sigma_zz = nu (sigma_xx + sigma_yy) - E alpha 10.
TEST(InitialStress, ActsAcrossThePlane)
{
  const problem::Material material = lame(2, 0.3);
  const mesh::Mesh<2> mesh(block<2>({1, 1}));
  const auto rest = [&](const problem::Region<2>& region) {
    return io::out_of_plane_rest<2>(ProblemData<2>{.regions = {region}}.on(mesh), 0, {0.5, 0.5});
  };
  EXPECT_NEAR(rest(heated<2>(material, 1e-3, 10.0)), -2 * 1e-3 * 10, 1e-15);
  problem::Region<2> across = heated<2>(material, 0, 0.0);
  across.initial_stress_zz = -5.0;
  EXPECT_EQ(rest(across), -5);
  EXPECT_EQ(rest(heated<2>(material, 0, 0.0)), 0);
}

TEST(InitialStress, MissedMomentsAddToTheNormAndTheRestToItsSquare)
{
  EXPECT_DOUBLE_EQ((contact::StressRemainder{.oscillation = 3, .projection = 1}.added_to(3)), 5);
}

TEST(InitialStress, OfHighDegreeIsRefusedOnBonds)
{
  const auto form = [](const char* field)
  {
    const problem::JointLaw law(problem::Joint{.tension = {.strength = 1, .fracture_energy = 1}});
    const DiscreteProblem<2> c(block<2>({3, 2}),
                               {.boundaries = {clamped<2>("left"), obstacle<2>("bottom", law)},
                                .regions = {heated<2>(lame(1, 0.3), 1, formula(field))}},
                               {.degree = 2});
  };
  EXPECT_NO_THROW(form("x^2 - y"));
  EXPECT_THROW(form("x^3"), InputError);
}

/// A temperature that is a polynomial of any degree, oscillates, jumps or is steep, and initial stresses.
template <int dim>
problem::Region<dim> random_region(RandomCase<dim>& random, const problem::Material& material)
{
  const double size = random.between(-0.1, 0.1);
  const std::array<std::string, 6> fields = {"x",        "x*y - y^2",          "x^3*y - x",
                                             "sin(4*x)", "x < 0.613 ? y : -1", "exp(2*y)*cos(x)"};
  problem::Region<dim> region = heated<dim>(
      material, 0.1, formula(fmt::format("{}*({})", 10 * size, fields[random.random() % fields.size()])));
  for (problem::Field& entry : region.initial_stress)
    if (random.happens(2))
      entry = formula(fmt::format("{}*({})", size, fields[random.random() % fields.size()]));
  return region;
}

/// The bounds of both stresses at an early and at the last iterate.
template <int dim>
void expect_bounded(unsigned seed, int p)
{
  RandomCase<dim> random{std::mt19937(seed)};
  random.is_on_another = random.happens(3);
  random.matches = random.happens(2);
  ProblemData<dim> data = random.data();
  data.regions = {random_region(random, data.material)};
  DiscreteProblem<dim> c(random.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-11}});
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = 2, .degree = p + 2});
  for (const int steps : {1, c.method.newton.max_steps})
  {
    c.method.newton.max_steps = steps;
    const solve::NewtonResult<dim> newton = c.solve();
    const double below = dual_norm(newton.u);
    for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
    {
      const certify::Estimate eta = certify::estimate<dim>(
          c.form, newton.u, certify::equilibrate<dim>(c.form, newton.u, newton.traction, 0, 0, kind));
      EXPECT_GE(eta.total_sharp, below) << dim << "D, seed " << seed << ", p = " << p;
      fmt::print("{}D, seed {}, p = {}, step {}: {:.3f}\n", dim, seed, p, newton.steps.size(),
                 eta.total_sharp / below);
    }
  }
}

TEST(InitialStress, NoBoundFails)
{
  for (unsigned seed = 0; seed < n_cases(24); ++seed) expect_bounded<2>(seed, 1 + static_cast<int>(seed % 4));
  for (unsigned seed = 0; seed < n_cases(4); ++seed) expect_bounded<3>(seed, 1 + static_cast<int>(seed % 2));
}

/// The energy bound against the distance from a much richer solution, the intervals against its numbers.
template <int dim>
void expect_energy_bounded(unsigned seed, int p)
{
  RandomCase<dim> random{std::mt19937(seed)};
  random.is_on_another = random.happens(4);
  ProblemData<dim> data = random.data();
  const mesh::MeshData<dim> mesh = random.mesh();
  data.regions = {random_region(random, data.material)};
  const DiscreteProblem<dim> c(mesh, data, {.degree = p, .newton = {.tolerance = 1e-12}});
  const std::vector<double> u = c.solve().u;
  Asked<dim> asked(random.is_held_above, random.is_on_another);
  asked.values[1] = [](const auto& c, auto u) { return contact::load_work<dim>(c.form, u); };
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u, asked.quantities);
  if (!bound.reason.empty())
  {
    fmt::print("{}D, seed {}, p = {}: {}\n", dim, seed, p, bound.reason);
    return;
  }
  const certify::RicherSpace richer{.refinements = dim == 2 ? 2 : 1, .degree = std::min(p + 2, 4)};
  const double found = effectivity<dim>(RicherReference<dim>(c, richer), u, bound);
  fmt::print("{}D, seed {}, p = {}: {:.3f}\n", dim, seed, p, found);
  EXPECT_GE(found, 1) << seed;
  const DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, richer.refinements).mesh), data,
                                  {.degree = richer.degree, .newton = {.tolerance = 1e-11}});
  const std::vector<double> truth = rich.solve().u;
  for (std::size_t i = 0; i < asked.values.size(); ++i)
    expect_contains(bound.quantities[i], asked.values[i](rich, truth), fmt::format(", seed {}", seed), 1e-10);
}

TEST(InitialStress, NoEnergyBoundFails)
{
  for (unsigned seed = 0; seed < n_cases(16); ++seed)
    expect_energy_bounded<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(3); ++seed)
    expect_energy_bounded<3>(seed, 1 + static_cast<int>(seed % 2));
}

}  // namespace

}  // namespace tribound::test
