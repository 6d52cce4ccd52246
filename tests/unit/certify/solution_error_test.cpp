/// Errors on the common refinement of two meshes against differences that are known otherwise.

#include "tribound/certify/truth/solution_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/dimensions.h"
#include "support/distorted_box.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

template <class T>
class SolutionErrorOf : public ::testing::Test
{
};
TYPED_TEST_SUITE(SolutionErrorOf, Dimensions);

template <int dim>
mesh::Mesh<dim> bisected_at_random(const mesh::Mesh<dim>& initial, int levels, unsigned seed)
{
  std::mt19937 random(seed);
  std::bernoulli_distribution chosen(0.2);
  mesh::Mesh<dim> mesh = std::move(mesh::bisect<dim>(initial, {}).mesh);
  for (int level = 0; level < levels; ++level)
  {
    std::vector<Index> marked;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (chosen(random)) marked.push_back(c);
    mesh = std::move(mesh::bisect<dim>(mesh, marked, 1).mesh);
  }
  return mesh;
}

template <int dim>
std::vector<double> random_function(const fem::LagrangeSpace<dim>& space, unsigned seed)
{
  return random_free_vector({std::vector<char>(space.n_dofs(), 0), {}}, 1.0, seed);
}

double squares(const std::vector<double>& values)
{
  return norm(values) * norm(values);
}

/// Polynomials of degree 2 and 3: their difference on the coarse mesh alone gives the same norms.
TYPED_TEST(SolutionErrorOf, PolynomialsOnMeshesOfWhichNeitherContainsTheOther)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(3);
  const auto quadratic = [](const Point<dim>& x) -> Point<dim>
  { return Point<dim>::Constant(x[0] * x[1] - 0.3 * x[dim - 1] * x[dim - 1]); };
  const auto cubic = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> v = Point<dim>::Constant(x[0] * x[0] * x[1]);
    v[1] = x[dim - 1] * x[1] * x[0] - 2 * x[0];
    return v;
  };
  const std::vector<double> difference =
      sum(interpolate(c.space, quadratic), -1, interpolate(c.space, cubic));
  const contact::StressNorms expected = contact::stress_norms<dim>(c.problem, c.space, difference);

  const mesh::Mesh<dim> a = bisected_at_random(c.mesh, 4, 1);
  const mesh::Mesh<dim> b = bisected_at_random(c.mesh, 4, 2);
  const fem::LagrangeSpace<dim> space_a(a, 2);
  const fem::LagrangeSpace<dim> space_b(b, 3);
  const certify::LocalError error = certify::solution_error<dim>(
      c.problem, space_a, interpolate(space_a, quadratic), space_b, interpolate(space_b, cubic));
  EXPECT_NEAR(error.global.energy, std::sqrt(expected.energy), 1e-12 * std::sqrt(expected.energy));
  EXPECT_NEAR(error.global.stress, expected.sigma, 1e-12 * expected.sigma);
  ASSERT_EQ(error.energy.size(), static_cast<std::size_t>(a.n_cells()));
  EXPECT_NEAR(squares(error.energy), expected.energy, 1e-12 * expected.energy);
  EXPECT_NEAR(squares(error.stress), expected.sigma * expected.sigma,
              1e-12 * expected.sigma * expected.sigma);
}

/// Functions with kinks at every facet; one mesh contains the other, so that both can be carried to it.
TYPED_TEST(SolutionErrorOf, RandomFunctionsOnNestedMeshes)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  const mesh::Bisected<dim> finer = mesh::bisect<dim>(c.mesh, {{1, 4, 7}});
  for (const int degree : {2, 3})
  {
    const fem::LagrangeSpace<dim> fine(finer.mesh, degree);
    const std::vector<double> u = random_function(c.space, 5);
    const std::vector<double> u_fine = random_function(fine, 6);
    const std::vector<double> carried = fem::nested_interpolant<dim>(c.space, u, finer.parent, fine);
    const contact::StressNorms expected =
        contact::stress_norms<dim>(c.problem, fine, sum(carried, -1, u_fine));
    const certify::LocalError one = certify::solution_error<dim>(c.problem, c.space, u, fine, u_fine);
    const certify::LocalError other = certify::solution_error<dim>(c.problem, fine, u_fine, c.space, u);
    for (const certify::LocalError& error : {one, other})
    {
      EXPECT_NEAR(error.global.energy, std::sqrt(expected.energy), 1e-12 * std::sqrt(expected.energy));
      EXPECT_NEAR(error.global.stress, expected.sigma, 1e-12 * expected.sigma);
    }
    std::vector<double> gathered(c.mesh.n_cells(), 0.0);  // the shares of the fine cells in each coarse one
    for (Index cell = 0; cell < finer.mesh.n_cells(); ++cell)
      gathered[finer.parent[cell]] += other.stress[cell] * other.stress[cell];
    for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
      EXPECT_NEAR(one.stress[cell], std::sqrt(gathered[cell]), 1e-12 * expected.sigma);
  }
}

TYPED_TEST(SolutionErrorOf, SymmetricOnMeshesOfWhichNeitherContainsTheOther)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  const mesh::Mesh<dim> a = bisected_at_random(c.mesh, 5, 1);
  const mesh::Mesh<dim> b = bisected_at_random(c.mesh, 5, 2);
  const fem::LagrangeSpace<dim> space_a(a, 1);
  const fem::LagrangeSpace<dim> space_b(b, 2);
  const std::vector<double> u_a = random_function(space_a, 5);
  const std::vector<double> u_b = random_function(space_b, 6);
  const certify::LocalError one = certify::solution_error<dim>(c.problem, space_a, u_a, space_b, u_b);
  const certify::LocalError other = certify::solution_error<dim>(c.problem, space_b, u_b, space_a, u_a);
  EXPECT_NEAR(one.global.energy, other.global.energy, 1e-12 * one.global.energy);
  EXPECT_NEAR(one.global.stress, other.global.stress, 1e-12 * one.global.stress);
}

TYPED_TEST(SolutionErrorOf, ItselfIsZero)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  const std::vector<double> u = random_function(c.space, 3);
  EXPECT_EQ(certify::solution_error<dim>(c.problem, c.space, u, c.space, u).global.stress, 0);
}

/// u = (0, y^2 / 10) with an open gap below: any richer space contains it, so that the solution of higher
/// degree is exact whichever way the mesh is refined.
TEST(SolutionError, AgreesWithCompareWithRicher)
{
  ProblemData<2> data{.boundaries = {obstacle<2>("bottom", Frictionless(), 1)},
                      .material = lame(1, 0),
                      .body_force = {0, -0.2}};
  for (const char* side : {"left", "right", "top"})
    data.boundaries.push_back(fixed<2>(side, 0, formula("0.1*y^2")));
  const DiscreteProblem<2> c(block<2>({4, 2}), data);
  const solve::NewtonResult<2> coarse = c.solve();
  ASSERT_EQ(coarse.status, solve::NewtonStatus::converged);
  const certify::RicherSolution richer =
      certify::compare_with_richer<2>(c.form, coarse.u, {.refinements = 1, .degree = 2}, c.method.gamma_0(),
                                      c.method.newton, c.method.solver);
  ASSERT_TRUE(richer.error);

  const mesh::Mesh<2> finer = bisected_at_random(c.mesh, 4, 9);
  const fem::LagrangeSpace<2> space(finer, 2);
  const contact::NitscheForm<2> form(c.problem, space, c.method.gamma_0());
  const solve::NewtonResult<2> fine = solve::solve<2>(form, {}, c.method.newton, c.method.solver);
  ASSERT_EQ(fine.status, solve::NewtonStatus::converged);
  const certify::LocalError error = certify::solution_error<2>(c.problem, c.space, coarse.u, space, fine.u);
  EXPECT_GT(error.global.energy, 1e-3);
  EXPECT_NEAR(error.global.energy, richer.error->energy, 1e-9 * error.global.energy);
  EXPECT_NEAR(error.global.stress, richer.error->stress, 1e-9 * error.global.stress);
}

}  // namespace

}  // namespace tribound::test
