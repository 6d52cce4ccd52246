/// @file energy_meridian_initial_test.cpp
/// The energy bound and the intervals of bodies of revolution with temperature and initial stress: exact
/// solutions, and random cases against much richer ones.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/fields.h"
#include "verification/heated_cylinder.h"
#include "verification/meridian_energy.h"

namespace tribound::test
{

namespace
{

constexpr double two_pi = 2 * std::numbers::pi;

problem::Region<2> heated(const std::string& name, const problem::Material& material, double alpha,
                          problem::Field temperature)
{
  problem::Region<2> region{.name = name, .material = material};
  region.material.expansion = alpha;
  region.temperature = std::move(temperature);
  return region;
}

/// Temperatures linear in z expand a body without stress, see axisymmetric_loads_test.cpp; tractions give it
/// constant stresses beside that.
TEST(EnergyMeridianInitial, FreeExpansionIsExact)
{
  constexpr double alpha = 1e-3;
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3, 4})
    {
      const double b = p == 1 ? 0 : 0.7;
      ProblemData<2> data{
          .boundaries = {fixed<2>("bottom", free, formula(fmt::format("{:.17g}*x^2", -alpha * b / 2))),
                         loaded<2>("right", 0.01, 0), loaded<2>("top", 0, 0.02)}};
      if (inner > 0) data.boundaries.push_back(loaded<2>("left", -0.01, 0));
      data.regions = {heated("box", lame(2, 0.3), alpha, formula(fmt::format("2 + {}*y", b)))};
      const MeridianProblem c(random_meridian(inner, 3, 7), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const certify::EnergyBound eta = bound_of(c, c.solve().u);
      EXPECT_EQ(eta.reason, "");
      EXPECT_LE(eta.bound, 1e-13) << inner << ", p = " << p;
    }
}

/// sigma_rr = r^k and sigma_tt = (k + 1) r^k are in equilibrium: nothing moves, whatever acts is in tau and
/// in the target alike.
TEST(EnergyMeridianInitial, StressInEquilibriumIsTheStress)
{
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3, 4})
    {
      const int k = p - 1;
      ProblemData<2> data{.boundaries = {fixed<2>("bottom", free, 0.0), loaded<2>("right", 1.0, 0.0)}};
      if (inner > 0) data.boundaries.push_back(loaded<2>("left", -std::pow(inner, k), 0.0));
      problem::Region<2> region{.name = "box", .material = lame(2, 0.3)};
      region.initial_stress[0] = formula(fmt::format("x^{}", k));
      region.initial_stress_zz = formula(fmt::format("{}*x^{}", k + 1, k));
      data.regions = {region};
      const MeridianProblem c(random_meridian(inner, 3, 7), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const certify::EnergyBound eta = bound_of(c, c.solve().u);
      EXPECT_EQ(eta.reason, "");
      EXPECT_LE(eta.bound, 1e-12) << inner << ", p = " << p;
    }
}

/// The energy norm of the distance of u from a solution that is known, and of this one.
std::pair<double, double> error_and_norm(const MeridianProblem& c, std::span<const double> u,
                                         const std::function<Point<2>(const Point<2>&)>& exact)
{
  const mesh::Refined<2> finer = mesh::refine_uniformly(c.mesh, 2);
  const fem::LagrangeSpace<2> space(finer.mesh, fem::max_degree);
  const auto norm = [&](std::span<const double> w)
  { return std::sqrt(contact::stress_norms<2>(c.problem.without_initial_stress(), space, w).energy); };
  const std::vector<double> truth = interpolate<2>(space, exact);
  std::vector<double> error = fem::nested_interpolant<2>(c.space, u, finer, space);
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= truth[i];
  return {norm(error), norm(truth)};
}

/// The bound is above the distance of u_h from the exact solution, and not far; the intervals hold `values`.
void expect_exact(const MeridianProblem& c, const std::function<Point<2>(const Point<2>&)>& exact,
                  const std::vector<problem::Quantity<2>>& quantities, std::vector<double> values)
{
  const int p = c.space.degree();
  const std::vector<double> u = c.solve().u;
  const certify::EnergyBound eta = certify::EnergyEstimator<2>(c.form, c.method.solver, quantities)(u);
  ASSERT_EQ(eta.reason, "");
  const auto [error, norm] = error_and_norm(c, u, exact);
  fmt::print("p = {}: error {:.2e}, relative {:.1e}, bound / error {:.3f}\n", p, error, error / norm,
             eta.bound / error);
  EXPECT_GE(eta.bound, error) << p;
  EXPECT_LE(eta.bound, 2.5 * error) << p;
  values.insert(values.begin(), two_pi * norm * norm);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const certify::QuantityInterval& interval = eta.quantities[i];
    EXPECT_EQ(interval.reason, "") << interval.name;
    const double rounding = 1e-9 * std::abs(values[i]);
    EXPECT_LE(interval.lower, values[i] + rounding) << interval.name << p;
    EXPECT_GE(interval.upper, values[i] - rounding) << interval.name << p;
    EXPECT_LE(interval.upper - interval.lower, 6 * error / norm * std::abs(values[i])) << interval.name << p;
  }
}

const problem::Quantity<2> energy{.name = "energy"};

problem::Quantity<2> mean(const std::string& boundary)
{
  return {.name = "u_r",
          .kind = problem::QuantityKind::mean_displacement,
          .boundary = boundary,
          .direction = e_r};
}

TEST(EnergyMeridianInitial, HeatedCylinder)
{
  const HeatedCylinder cylinder;
  const auto exact = [&](const Point<2>& x) -> Point<2> {
    return {cylinder.u_r(x[0]), 0};
  };
  ProblemData<2> data{.boundaries = {fixed<2>("bottom", free, 0.0), fixed<2>("top", free, 0.0)}};
  data.regions = {heated("box", lame(2, cylinder.nu), cylinder.alpha, cylinder.temperature())};
  for (const int p : {1, 2, 3})
    expect_exact({box<2>({1, 0}, {2, 0.5}, {4, 2}), data, {.degree = p, .newton = {.tolerance = 1e-13}}},
                 exact, {energy, mean("right")}, {exact({2, 0})[0]});
}

/// A ring that is pressed into another one by its temperature: the force and the displacements of a press
/// fit whose interference is what it would expand alone.
TEST(EnergyMeridianInitial, HeatedRingInAnother)
{
  constexpr double alpha = 1e-3;
  constexpr double theta = 5;
  constexpr double inner = 1;
  constexpr double joint = 2;
  constexpr double outer = 3;
  mesh::MeshData<2> mesh = side_by_side(box<2>({inner, 0}, {joint, 0.5}, {4, 2}),
                                        box<2>({joint, 0}, {outer, 0.5}, {4, 2}), "_outer");
  mesh.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
  ProblemData<2> data{.material = lame(1, 0.0)};
  for (const char* side : {"bottom", "top", "bottom_outer", "top_outer"})
    data.boundaries.push_back(fixed<2>(side, free, 0.0));
  data.regions = {heated("box", data.material, alpha, theta)};
  data.pairs = {pair<2>("left_outer", "right")};
  const auto stiffness = [](double a, double b) { return (b * b - a * a) / (b * b + a * a); };
  const double pressure = alpha * theta / (1 / stiffness(inner, joint) + 1 / stiffness(joint, outer));
  // Lame, nu = 0: u_r = -p b^2 (r + a^2 / r) / (b^2 - a^2) under p at b, of rings from a to b and from b to a
  const auto exact = [&](const Point<2>& x) -> Point<2>
  {
    const double other = std::pow(x[0] < joint ? inner : outer, 2);
    const double pressed = -pressure * joint * joint / (joint * joint - other) * (x[0] + other / x[0]);
    return {x[0] < joint ? alpha * theta * x[0] + pressed : pressed, 0};
  };
  const problem::Quantity<2> force{.name = "force",
                                   .kind = problem::QuantityKind::contact_force,
                                   .boundary = "left_outer",
                                   .direction = e_r};
  for (const int p : {1, 2, 3})
    expect_exact({mesh, data, {.degree = p, .newton = {.tolerance = 1e-13}}}, exact,
                 {energy, force, mean("right_outer")},
                 {two_pi * joint * 0.5 * pressure, exact({outer, 0})[0]});
}

std::vector<problem::Quantity<2>> forces_and(const std::string& boundary, const std::string& free_side)
{
  using problem::QuantityKind;
  return {energy,
          mean(free_side),
          {.name = "radial", .kind = QuantityKind::contact_force, .boundary = boundary, .direction = e_r},
          {.name = "axial", .kind = QuantityKind::contact_force, .boundary = boundary, .direction = e_z}};
}

TEST(EnergyMeridianInitial, NoBoundFailsInRandomCases)
{
  std::vector<double> found;
  for (unsigned seed = 0; seed < n_cases(8); ++seed)
  {
    RandomMeridian random{std::mt19937(seed)};
    const double inner = std::array{0.0, 0.05, 0.0, 0.5}[seed % 4];
    const int p = 1 + static_cast<int>(seed / 2) % 4;
    ProblemData<2> data =
        random.data(inner, seed % 3 == 0 ? problem::ContactLaw(Frictionless()) : Tresca(0.02));
    data.boundaries[1] = fixed<2>("top", free, -0.03);
    data.regions = {random.stressed("box", data)};
    MeridianProblem c(random_meridian(inner, 2 + static_cast<int>(seed % 2), seed), data,
                      {.degree = p, .newton = {.tolerance = 1e-11}});
    if (seed % 4 == 3) c.method.newton.max_steps = 1;
    found.push_back(expect_intervals(c, forces_and("bottom", "right"), c.solve().u,
                                     fmt::format("seed {}, p = {}, inner = {}", seed, p, inner)));
    if (seed % 4 != 1) continue;
    const MeridianProblem two = rings(seed, p, true);
    found.push_back(expect_intervals(two, forces_and("right", "right_outer"), two.solve().u,
                                     fmt::format("rings {}, p = {}", seed, p)));
  }
  std::ranges::sort(found);
  EXPECT_LE(found[found.size() / 2], 3);
  fmt::print("effectivity {:.3f}, {:.3f}, {:.3f}\n", found.front(), found[found.size() / 2], found.back());
}

}  // namespace

}  // namespace tribound::test
