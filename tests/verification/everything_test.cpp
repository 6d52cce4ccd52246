/// @file everything_test.cpp
/// The guarantees in random problems that mix all that a case may contain: the bound is above the dual norm
/// of the residual, the energy bound above the distance from a much richer solution, intervals hold its
/// numbers.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/random_cases.h"
#include "support/random_everything.h"
#include "support/seen_range.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/energy/contact_weight.h"
#include "tribound/certify/energy/obstacle_facets.h"
#include "tribound/certify/energy/quantity_parts.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "verification/energy_effectivity.h"
#include "verification/quantities.h"

namespace tribound::test
{

namespace
{

[[nodiscard]] adapt::Method method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-11}};
}

/// At an early iterate and at the last.
template <int dim>
void expect_above_dual_norm(unsigned seed, int p, SeenRange& converged, SeenRange& others)
{
  const auto made = RandomEverything<dim>(seed, p, Roughness::any).make();
  const DiscreteProblem<dim> c(made.mesh, made.data, method(p));
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = dim == 2 ? 2 : 1, .degree = p + 2});
  const certify::Estimator<dim> estimator(c.form, certify::ContactRule::resolved);
  const int early = 1 + static_cast<int>(seed % 3);
  const auto check = [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    if (!iterate.converged && iterate.step.step != early) return false;
    const double below = dual_norm(iterate.u());
    for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
    {
      const auto stress = certify::equilibrate<dim>(c.form, iterate.u(), iterate.traction, 0, 0, kind);
      EXPECT_LE(certify::check_identities<dim>(c.form, iterate.traction, stress).largest(), 1e-9) << seed;
      const double eta = estimator(iterate.u(), stress).total_sharp;
      EXPECT_GE(eta, below) << dim << "D, seed " << seed << ", p = " << p << ", step " << iterate.step.step;
      (iterate.converged ? converged : others).add(eta / below);
    }
    return false;
  };
  (void)c.solve(0, check);
}

void report(int dim, const SeenRange& converged, const SeenRange& others)
{
  fmt::print("{}D: {} converged {:.3f} to {:.3f}, {} others {:.3f} to {:.3f}\n", dim, converged.count,
             converged.least, converged.most, others.count, others.least, others.most);
}

TEST(Everything, TheBoundIsAboveTheDualNorm)
{
  SeenRange converged;
  SeenRange others;
  for (unsigned seed = 0; seed < n_cases(9); ++seed)
    expect_above_dual_norm<2>(seed, 1 + static_cast<int>(seed % 3), converged, others);
  report(2, converged, others);
}

TEST(Everything, TheBoundIsAboveTheDualNorm3D)
{
  SeenRange converged;
  SeenRange others;
  for (unsigned seed = 0; seed < n_cases(3); ++seed)
    expect_above_dual_norm<3>(seed, 1 + static_cast<int>(seed % 2), converged, others);
  report(3, converged, others);
}

/// The value at the reference: of forces and moments with the weight that intervals name, unless equilibrium
/// gives the number itself.
template <int dim>
double value_at(const RicherReference<dim>& reference, const Quantity<dim>& quantity, bool is_exact)
{
  const contact::NitscheForm<dim>& form = reference.form();
  const bool is_contact =
      quantity.kind == QuantityKind::contact_force || quantity.kind == QuantityKind::contact_moment;
  if (!is_contact || is_exact)
    return certify::no_energy_bound<dim>(form, reference.u(), std::span(&quantity, 1), "only the value")
        .quantities.front()
        .value;
  const certify::ContactWeights<dim> weights(form, certify::ObstacleFacets<dim>(form).junctions());
  return certify::contact_work<dim>(
      form, form.traction(reference.u()),
      weights(form, certify::parts_of<dim>(form, quantity).resultants.front(), quantity.ramp).at_points);
}

/// What is known of energy bounds in random problems.
struct EnergySeen
{
  SeenRange effectivity;
  std::map<std::string, int> refused;
  int intervals = 0;
  std::map<std::string, int> missing;  ///< intervals

  void print(int dim) const
  {
    fmt::print("{}D: {} bounds {:.3f} to {:.3f}, {} intervals\n", dim, effectivity.count, effectivity.least,
               effectivity.most, intervals);
    for (const auto& [why, n] : refused) fmt::print("  {} without bound: {}\n", n, why);
    for (const auto& [why, n] : missing) fmt::print("  {} without interval: {}\n", n, why);
  }
};

/// Tresca's law in place of Coulomb's, whose bound is for another problem than the reference.
template <int dim>
void replace_coulomb(ProblemData<dim>& data)
{
  const auto replace = [](problem::ContactLaw& law)
  {
    if (const auto* coulomb = std::get_if<Coulomb>(&law)) law = Tresca(0.02 * coulomb->coefficient);
  };
  for (problem::BoundaryCondition<dim>& boundary : data.boundaries)
    if (boundary.contact) replace(boundary.contact->law);
  for (problem::ContactPair<dim>& pair : data.pairs) replace(pair.contact.law);
}

/// u and a wave where displacements are free: bounds hold for any function, and one far from equilibrium
/// needs all their parts.
template <int dim>
std::vector<double> disturbed(const DiscreteProblem<dim>& c, std::vector<double> u)
{
  double size = 0;
  for (const double x : u) size = std::max(size, 0.3 * std::abs(x));
  const std::vector<Point<dim>> nodes = c.space.node_points();
  for (std::size_t i = 0; i < u.size(); ++i)
    if (c.form.constraints().fixed[i] == 0)
      u[i] += size * std::sin(3 * nodes[i / dim].sum() + static_cast<double>(i % dim));
  return u;
}

template <int dim>
void expect_bounds_of(const DiscreteProblem<dim>& c, const Quantities<dim>& asked, std::span<const double> u,
                      std::optional<RicherReference<dim>>& reference, EnergySeen& seen)
{
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u, asked);
  if (!bound.reason.empty())
  {
    ++seen.refused[bound.reason];
    return;
  }
  EXPECT_LE(bound.cell_balance, 1e-11);
  const certify::RicherSpace richer{.refinements = dim == 2 ? 2 : 1,
                                    .degree = std::min(c.space.degree() + 2, 4)};
  if (!reference) reference.emplace(c, richer);
  const double found = bound.bound / reference->distance(u);
  EXPECT_GE(found, 1);
  seen.effectivity.add(found);
  for (std::size_t i = 0; i < asked.size(); ++i)
  {
    const QuantityInterval& interval = bound.quantities[i];
    if (!interval.reason.empty())
    {
      ++seen.missing[interval.reason];
      continue;
    }
    ++seen.intervals;
    // by Newton's method
    const double accuracy = 1e-9 * std::max({std::abs(interval.lower), std::abs(interval.upper), 1e-2});
    expect_contains(interval, value_at<dim>(*reference, asked[i], interval.exact), {}, accuracy);
  }
}

/// Whether the solution has a bound.
template <int dim>
bool expect_energy_bounds(unsigned seed, int p, EnergySeen& seen, EnergySeen& seen_disturbed)
{
  SCOPED_TRACE(fmt::format("{}D, seed {}, p = {}", dim, seed, p));
  auto made = RandomEverything<dim>(seed, p, Roughness::enclosed).make();
  replace_coulomb(made.data);
  const DiscreteProblem<dim> c(made.mesh, made.data, method(p));
  const std::vector<double> u = c.solve().u;
  const Quantities<dim> asked = all_quantities<dim>(made.data);
  std::optional<RicherReference<dim>> reference;
  expect_bounds_of<dim>(c, asked, u, reference, seen);
  if (!reference) return false;
  expect_bounds_of<dim>(c, asked, disturbed(c, u), reference, seen_disturbed);
  return true;
}

template <int dim>
void expect_energy_bounds_of(unsigned n)
{
  EnergySeen seen;
  EnergySeen seen_disturbed;
  unsigned n_bounded = 0;
  for (unsigned seed = 0; n_bounded < n_cases(n); ++seed)
    if (expect_energy_bounds<dim>(seed, 1 + static_cast<int>(seed % (dim == 2 ? 3 : 2)), seen,
                                  seen_disturbed))
      ++n_bounded;
  seen.print(dim);
  fmt::print("disturbed: ");
  seen_disturbed.print(dim);
}

TEST(Everything, NoEnergyBoundOrIntervalFails)
{
  expect_energy_bounds_of<2>(6);
}

TEST(Everything, NoEnergyBoundOrIntervalFails3D)
{
  expect_energy_bounds_of<3>(2);
}

}  // namespace

}  // namespace tribound::test
