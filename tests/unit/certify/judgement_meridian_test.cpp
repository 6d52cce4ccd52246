/// The error intervals of solutions of other programs on bodies of revolution.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "support/fields.h"
#include "support/meridian_problem.h"
#include "support/random_meridian_problem.h"
#include "tribound/certify/truth/judgement.h"
#include "tribound/certify/truth/solution_error.h"
#include "tribound/certify/truth/their_forces.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

using std::numbers::pi;

/// From r = `inner` to 1, of height 1, with any displacement.
std::unique_ptr<const MeridianProblem> body(double inner, int degree)
{
  return std::make_unique<const MeridianProblem>(random_meridian(inner, 2, 3),
                                                 ProblemData<2>{.material = lame(1, 0.3)},
                                                 adapt::Method{.degree = degree});
}

certify::ForeignSolution<2> displacement(const fem::LagrangeSpace<2>& space, auto field)
{
  return {.degree = space.degree(), .u = interpolate(space, field)};
}

class MeridianJudgement : public ::testing::TestWithParam<double>
{
};
INSTANTIATE_TEST_SUITE_P(Inner, MeridianJudgement, ::testing::Values(0.0, 0.02, 0.5));

/// u = (c r, d z) has constant strains: its energy is known.
TEST_P(MeridianJudgement, ConstantStrainsHaveTheirEnergyNorm)
{
  const double c = 0.3;
  const double d = -0.7;
  for (const int degree : {1, 3})
  {
    const auto theirs = body(GetParam(), degree);
    const auto ours = body(GetParam(), 2);
    const problem::Material& material = theirs->problem.material(0);
    const double density = material.lambda * std::pow(2 * c + d, 2) + 2 * material.mu * (2 * c * c + d * d);
    const double expected = std::sqrt(pi * (1 - std::pow(GetParam(), 2)) * density);
    const certify::Judgement found = certify::judge<2>(
        ours->problem, theirs->space,
        displacement(theirs->space, [&](const Point<2>& x) { return Point<2>(c * x[0], d * x[1]); }),
        ours->space, std::vector<double>(ours->space.n_dofs(), 0.0), 0.1);
    EXPECT_NEAR(found.displacement.distance, expected, 1e-12 * expected);
    EXPECT_NEAR(found.bound, 0.1 * std::sqrt(2 * pi), 1e-15);
    EXPECT_LE(found.displacement.error.lower, expected - found.bound);
    EXPECT_GE(found.displacement.error.upper, expected + found.bound);
    EXPECT_LE(found.displacement.error.upper - found.displacement.error.lower, 2 * found.bound + 4e-9);
    EXPECT_EQ(found.energy_norm, 0);
  }
}

/// Of a stress that is constant, hoop stress included, beside a displacement that is 0.
TEST_P(MeridianJudgement, ConstantStressesHaveTheirDualNorm)
{
  const auto theirs = body(GetParam(), 2);
  const auto ours = body(GetParam(), 1);
  Tensor<2> s;
  s << 0.4, -0.2, -0.2, 1.1;
  const double hoop = -0.8;
  const std::size_t n = static_cast<std::size_t>(theirs->mesh.n_cells()) * theirs->space.basis().n_nodes();
  const certify::ForeignSolution<2> solution{.degree = 2,
                                             .u = std::vector<double>(theirs->space.n_dofs(), 0.0),
                                             .stress = std::vector(n, s),
                                             .hoop = std::vector(n, hoop)};
  const problem::Material& material = theirs->problem.material(0);
  const double trace = s.trace() + hoop;
  const double E = 1;
  const double nu = 0.3;
  ASSERT_NEAR(material.mu, E / (2 * (1 + nu)), 1e-15);
  const double density = (1 + nu) / E * (s.squaredNorm() + hoop * hoop) - nu / E * trace * trace;
  const double expected = std::sqrt(pi * (1 - std::pow(GetParam(), 2)) * density);
  const certify::Judgement found = certify::judge<2>(ours->problem, theirs->space, solution, ours->space,
                                                     std::vector<double>(ours->space.n_dofs(), 0.0), 0.0);
  ASSERT_TRUE(found.stress.has_value());
  EXPECT_NEAR(found.stress->distance, expected, 1e-12 * expected);
  const std::vector<Point<2>> forces = certify::boundary_forces<2>(theirs->space, solution.stress, true);
  for (std::size_t b = 0; b < forces.size(); ++b)
  {
    EXPECT_EQ(forces[b][0], 0);
    const bool is_top = theirs->mesh.boundary_names()[b] == "top";
    if (is_top || theirs->mesh.boundary_names()[b] == "bottom")
    {
      EXPECT_NEAR(forces[b][1], (is_top ? 1.1 : -1.1) * pi * (1 - std::pow(GetParam(), 2)), 1e-12);
    }
  }
}

/// A stress that differs by a constant from the initial one, which varies, where nothing is displaced.
TEST_P(MeridianJudgement, InitialStressesCount)
{
  problem::Region<2> region = heated(1e-2, formula("1 + x - 2*y"));
  region.initial_stress = {formula("0.3 + x"), formula("y^2"), formula("x*y")};
  region.initial_stress_zz = formula("0.1 + 2*x");
  const MeridianProblem ours(random_meridian(GetParam(), 2, 3), ProblemData<2>{.regions = {region}},
                             adapt::Method{.degree = 1});
  const fem::LagrangeSpace<2> space(ours.mesh, 2);
  Tensor<2> s;
  s << 0.4, -0.2, -0.2, 1.1;
  const double hoop = -0.8;
  certify::ForeignSolution<2> solution{.degree = 2, .u = std::vector<double>(space.n_dofs(), 0.0)};
  const std::vector<Point<2>> places = space.node_points();
  for (Index c = 0; c < ours.mesh.n_cells(); ++c)
    for (const Index node : space.cell_nodes(c))
    {
      solution.stress.push_back(s + ours.problem.initial_stress(0, places[node]));
      solution.hoop.push_back(hoop + ours.problem.initial_stress_zz(0, places[node]));
    }
  const double nu = 0.3;
  const double density =
      ((1 + nu) * (s.squaredNorm() + hoop * hoop) - nu * std::pow(s.trace() + hoop, 2)) / 2;  // E = 2
  const double expected = std::sqrt(pi * (1 - std::pow(GetParam(), 2)) * density);
  const certify::Judgement found = certify::judge<2>(ours.problem, space, solution, ours.space,
                                                     std::vector<double>(ours.space.n_dofs(), 0.0), 0.0);
  ASSERT_TRUE(found.stress.has_value());
  EXPECT_NEAR(found.stress->distance, expected, 1e-12 * expected);
}

/// The stress of a displacement is as far from that of another one as the displacements are, on finer meshes
/// too: both integrals are of different polynomials over r.
TEST_P(MeridianJudgement, DistancesOnNestedMeshesAreThoseOnOne)
{
  const auto coarse = body(GetParam(), 2);
  mesh::Bisected<2> finer = mesh::bisect<2>(coarse->mesh, std::vector<Index>{0, 3}, 2);
  const fem::LagrangeSpace<2> fine(finer.mesh, 3);
  const auto first = [](const Point<2>& x) { return Point<2>(x[0] * (0.2 + x[1] - x[0]), x[0] * x[1]); };
  const auto second = [](const Point<2>& x) -> Point<2> {
    return {x[0] * x[1], 0.3 - x[1] * x[1]};
  };
  const std::vector<double> u = interpolate(coarse->space, first);
  const std::vector<double> u_fine = interpolate(fine, second);
  const std::vector<double> u_coarse = interpolate(coarse->space, second);
  const certify::LocalError on_one =
      certify::solution_error<2>(coarse->problem, coarse->space, u, coarse->space, u_coarse);
  const certify::LocalError nested =
      certify::solution_error<2>(coarse->problem, coarse->space, u, fine, u_fine);
  const certify::LocalError other =
      certify::solution_error<2>(coarse->problem, fine, u_fine, coarse->space, u);
  EXPECT_NEAR(nested.global.energy, on_one.global.energy, 1e-12 * on_one.global.energy);
  EXPECT_NEAR(other.global.energy, on_one.global.energy, 1e-12 * on_one.global.energy);
  EXPECT_NEAR(nested.own_energy, on_one.own_energy, 1e-12 * on_one.own_energy);
  EXPECT_NEAR(nested.reference_energy, on_one.reference_energy, 1e-12 * on_one.reference_energy);
  EXPECT_NEAR(std::pow(on_one.global.energy, 2),
              on_one.own_energy - 2 * on_one.product + on_one.reference_energy, 1e-12);
  EXPECT_GE(nested.doubt, 0);
  EXPECT_LE(nested.doubt, GetParam() == 0.02 ? 1e-9 : 1e-13);  // cells are far longer than 0.02
}

/// What a rule does not know of a distance makes intervals wider.
TEST(MeridianJudgementInterval, DoubtOfIntegralsWidensIntervals)
{
  const certify::ErrorInterval sharp = certify::error_interval(2, 0.5);
  const certify::ErrorInterval wide = certify::error_interval(2, 0.5, 0.01);
  EXPECT_NEAR(wide.lower, sharp.lower - 0.02, 1e-12);
  EXPECT_NEAR(wide.upper, sharp.upper + 0.02, 1e-9);
  const certify::ErrorInterval relative = certify::relative_interval(sharp, 3, 0.5);
  const certify::ErrorInterval doubted = certify::relative_interval(sharp, 3, 0.5, 0.01);
  EXPECT_LT(doubted.lower, relative.lower);
  EXPECT_GT(doubted.upper, relative.upper);
}

}  // namespace

}  // namespace tribound::test
