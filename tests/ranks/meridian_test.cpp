/// @file meridian_test.cpp
/// Random bodies of revolution: all ranks together against each alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "support/random_cases.h"
#include "support/random_meridian_problem.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

using Numbers = std::vector<std::pair<std::string, double>>;

Numbers certified(const mesh::Mesh<2>& mesh, const ProblemData<2>& data, int p,
                  const certify::FriedrichsConstant& friedrichs)
{
  const problem::Problem<2> problem = data.on(mesh).axisymmetric();
  const fem::LagrangeSpace<2> space(mesh, p);
  const adapt::Method method{.degree = p, .newton = {.tolerance = 1e-12}};
  const contact::NitscheForm<2> form(problem, space, method.gamma_0());
  const solve::NewtonResult<2> newton = solve::solve<2>(form, {}, method.newton, method.solver);
  EXPECT_EQ(newton.status, solve::NewtonStatus::converged);
  const auto stress = certify::equilibrate<2>(form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<2>(form, newton.traction, stress).largest(), 1e-9);
  const certify::Estimate eta =
      certify::Estimator<2>(form, certify::ContactRule::resolved, friedrichs)(newton.u, stress);
  Numbers result = {{"bound", eta.total_sharp}, {"stress", contact::stress_norms<2>(form, newton.u).sigma}};
  for (const certify::BalanceRow& row :
       certify::balance<2>(form, newton.u, newton.traction, Point<2>::Zero()).rows)
    result.emplace_back(row.name + " " + row.source, row.force[1]);
  return result;
}

TEST(Meridian, IsThatOfTheWhole)
{
  for (unsigned seed = 0; seed < n_cases(4); ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double inner = seed % 2 == 0 ? 0 : 0.2;
    const int p = 1 + static_cast<int>(seed) % 3;
    const mesh::Mesh<2> whole(random_meridian(inner, 4, seed));
    const ProblemData<2> data = random_meridian_problem(random, inner);
    const Ranks ranks = Ranks::world();
    const mesh::Mesh<2> part = mesh::share_out<2>(ranks, ranks.is_first() ? &whole : nullptr);
    // The constant comes from the first mesh, before it is shared out.
    const auto friedrichs = certify::friedrichs_constant<2>(data.on(whole).axisymmetric(), whole);
    const Numbers alone = certified(whole, data, p, friedrichs);
    const Numbers together = certified(part, data, p, friedrichs);
    ASSERT_EQ(together.size(), alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i)
    {
      EXPECT_EQ(together[i].first, alone[i].first);
      EXPECT_NEAR(together[i].second, alone[i].second, 1e-8 * std::max(1.0, std::abs(alone[i].second)))
          << alone[i].first;
    }
  }
}

}  // namespace
}  // namespace tribound::test
