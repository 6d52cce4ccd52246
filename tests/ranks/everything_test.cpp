/// @file everything_test.cpp
/// Random problems that mix all that a case may contain: all ranks together against each alone.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/random_cases.h"
#include "support/random_everything.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/bound/korn.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/pairing/partners.h"
#include "tribound/mesh/share_out.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{
namespace
{

/// A number, and the size that its rounding is measured by.
struct Measured
{
  std::string name;
  double value;
  double size;
};

/// The bounds of Newton's solution, and the intervals of all quantities.
template <int dim>
std::vector<Measured> certified(const mesh::Mesh<dim>& mesh, const ProblemData<dim>& data, int p,
                                const certify::FriedrichsConstant& friedrichs, double korn)
{
  const problem::Problem<dim> problem = data.on(mesh);
  const fem::LagrangeSpace<dim> space(mesh, p);
  const adapt::Method method{.degree = p, .newton = {.tolerance = 1e-12}};
  const contact::NitscheForm<dim> form(problem, space, method.gamma_0());
  const solve::NewtonResult<dim> newton = solve::solve<dim>(form, {}, method.newton, method.solver);
  EXPECT_EQ(newton.status, solve::NewtonStatus::converged);
  const auto stress = certify::equilibrate<dim>(form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<dim>(form, newton.traction, stress).largest(), 1e-9);
  const certify::Estimate eta =
      certify::Estimator<dim>(form, certify::ContactRule::resolved, friedrichs)(newton.u, stress);
  const double size = contact::stress_norms<dim>(problem, space, newton.u).sigma + eta.total_sharp;
  std::vector<Measured> result = {{"bound", eta.total_sharp, size}};
  const certify::EnergyBound bound =
      adapt::energy_bound<dim>(form, method, newton.u, all_quantities<dim>(data), korn);
  result.push_back({"energy bound: " + bound.reason, bound.bound, bound.bound + size});
  for (const certify::QuantityInterval& interval : bound.quantities)
  {
    if (!interval.reason.empty()) continue;
    const double largest = std::max({std::abs(interval.lower), std::abs(interval.upper), 1e-3});
    result.push_back({interval.name + ", lower", interval.lower, largest});
    result.push_back({interval.name + ", upper", interval.upper, largest});
  }
  return result;
}

template <int dim>
void expect_same_on_ranks(unsigned seed, int p)
{
  SCOPED_TRACE(fmt::format("{}D, seed {}, p = {}", dim, seed, p));
  const Roughness roughness = seed % 2 == 0 ? Roughness::enclosed : Roughness::any;
  const auto made = RandomEverything<dim>(seed, p, roughness).make();
  const mesh::Mesh<dim> whole(made.mesh);
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<dim> part = contact::with_partners<dim>(
      mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr), made.data.pairs);
  // Constants come from the first mesh, before it is shared out.
  const auto friedrichs = certify::friedrichs_constant<dim>(made.data.on(whole), whole);
  const double korn = certify::korn_constant(made.data.on(whole), whole);
  const std::vector<Measured> alone = certified<dim>(whole, made.data, p, friedrichs, korn);
  const std::vector<Measured> together = certified<dim>(part, made.data, p, friedrichs, korn);
  ASSERT_EQ(together.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i)
  {
    EXPECT_EQ(together[i].name, alone[i].name);
    EXPECT_NEAR(together[i].value, alone[i].value, 1e-8 * alone[i].size) << alone[i].name;
  }
}

TEST(Everything, IsThatOfTheWhole)
{
  for (unsigned seed = 0; seed < n_cases(2); ++seed)
    expect_same_on_ranks<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(1); ++seed)
    expect_same_on_ranks<3>(seed + 1, 1 + static_cast<int>(seed % 2));
}

}  // namespace
}  // namespace tribound::test
