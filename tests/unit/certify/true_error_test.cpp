/// @file true_error_test.cpp
/// The dual norm of residuals whose Riesz representative is a known polynomial; errors against known
/// solutions.

#include "tribound/certify/truth/true_error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "support/dimensions.h"
#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/nested.h"

namespace tribound::test
{

namespace
{

template <class T>
class TrueError : public ::testing::Test
{
};
TYPED_TEST_SUITE(TrueError, Dimensions);

/// The integral of f(x, y) over (0, 2) x (0, 1).
double integral(const std::function<double(double, double)>& f)
{
  const fem::Quadrature<1> rule = fem::quadrature<1>(15);
  double sum = 0;
  for (int i = 0; i < rule.size(); ++i)
    for (int j = 0; j < rule.size(); ++j)
      sum += 2 * rule.weights[i] * rule.weights[j] * f(2 * rule.points[i][0], rule.points[j][0]);
  return sum;
}

/// The block (0, 2) x (0, 1) [x (0, 1)] that penetrates the floor y = 0 by delta without being deformed. With
///   z_x = x (h + y + c y^2),   z_y = h gamma delta + d x (h + y)   (h = h_F)
/// the loads below make <R(u), v> = (grad z, grad v) + (1/h) (z, v)_C: both sides of -d_y z + z/h = T are
/// met.
template <int dim>
struct KnownRepresentative
{
  static constexpr double c = 0.7;
  static constexpr double d = -0.3;
  static constexpr double delta = 0.01;
  const double h = dim == 2 ? 0.5 : std::sqrt(2.0);
  const double gamma = 10 * 1.75 / h;  // lambda + 2 mu = E (1 - nu) / ((1 + nu) (1 - 2 nu)) = 1.75

  [[nodiscard]] DiscreteProblem<dim> discrete(int p) const
  {
    return {block<dim>({4, 2}, {2, 1, 1}),
            {.boundaries = {loaded<dim>(fixed<dim>("left", 0, free, free), 0,
                                        formula(fmt::format("-({})*({:.17g} + y)", d, h))),
                            loaded<dim>("right", formula(fmt::format("{:.17g} + y + {}*y^2", h, c)),
                                        formula(fmt::format("{}*({:.17g} + y)", d, h))),
                            loaded<dim>("top", formula(fmt::format("{}*x", 1 + 2 * c)),
                                        formula(fmt::format("{}*x", d))),
                            obstacle<dim>("bottom", Tresca(1))},
             .material = lame(1.3, 0.3),
             .body_force = {formula(fmt::format("-2*{}*x", c))}},
            {.degree = p, .gamma0 = 10}};
  }

  [[nodiscard]] double norm() const
  {
    const double z_0 = h * gamma * delta;
    const double gradients = integral(
        [&](double x, double y)
        {
          return std::pow(h + y + c * y * y, 2) + std::pow(x * (1 + 2 * c * y), 2) +
                 std::pow(d * (h + y), 2) + std::pow(d * x, 2);
        });
    const double traces =
        integral([&](double x, double) { return std::pow(x * h, 2) + std::pow(z_0 + d * x * h, 2); });
    return std::sqrt(gradients + traces / h);
  }
};

TYPED_TEST(TrueError, DualNormOfAResidualWithKnownRepresentative)
{
  constexpr int dim = TypeParam::value;
  const KnownRepresentative<dim> known;
  for (int p = 1; p <= 2; ++p)
  {
    const DiscreteProblem<dim> c = known.discrete(p);
    ASSERT_NEAR(c.form.segments()[0].gamma, known.gamma, 1e-12 * known.gamma);
    Point<dim> down = Point<dim>::Zero();
    down[1] = -known.delta;
    const std::vector<double> u = interpolate(c.space, [&](const Point<dim>&) { return down; });
    for (const int refinements : {1, 2})
    {
      certify::DualNorm<dim> dual(c.form, {.refinements = refinements, .degree = 3});
      EXPECT_NEAR(dual(u), known.norm(), 1e-10 * known.norm()) << "p = " << p;
    }
  }
}

/// A rigid rotation about (x_0, 0) makes P^n = gamma a (x - x_0): contact ends inside a facet. Between two
/// points of a rule, a distance d apart, it cannot see a kink better than to about (change of slope) d^2 / 8.
TEST(DualNorm, IntegratesAKinkedTraction)
{
  const DiscreteProblem<2> c(block<2>({4, 2}),
                             {.boundaries = {obstacle<2>("bottom")}, .material = lame(1, 0.25)});
  constexpr double a = 0.02;
  constexpr double d = 0.5 / 16 * 0.24;  // a contact facet in 16 parts, each with 6 Gauss points
  const double slope = c.form.segments()[0].gamma * a;
  for (const double x_0 : {0.613, 1.28, 1.9})
  {
    const std::vector<double> u =
        interpolate(c.space, [&](const Point<2>& x) { return Point<2>(-a * x[1], a * (x[0] - x_0)); });
    certify::DualNorm<2> dual(c.form, {.refinements = 2, .degree = 3});
    const std::vector<double> r = dual.residual(u);
    double vertical = 0;  // <R, e_y> = integral of T_y
    for (std::size_t i = 1; i < r.size(); i += 2) vertical += r[i];
    const double expected = slope * x_0 * x_0 / 2;
    EXPECT_NEAR(vertical, expected, slope * d * d / 8) << x_0;
  }
}

/// Boundary data of three kinds and friction.
template <int dim>
ProblemData<dim> mixed_data()
{
  return {.boundaries = {clamped<dim>("left"), fixed<dim>("right", 0, free, free),
                         obstacle<dim>("bottom", Coulomb(0.3), formula("0.01*x^2"))},
          .body_force = {formula("0.1*x"), formula("-0.1*exp(x)")}};
}

template <int dim>
mesh::MeshData<dim> few_cells()
{
  if constexpr (dim == 2)
    return block<2>({3, 2});
  else
    return box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
}

const adapt::Method two_steps{.degree = 1, .newton = {.max_steps = 2}};

/// W grows, and so does the supremum over it, towards a limit.
TYPED_TEST(TrueError, DualNormGrowsWithTheSpace)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c(distorted(few_cells<dim>(), 2), mixed_data<dim>(), two_steps);
  const solve::NewtonResult<dim> result = c.solve();
  const auto norm = [&](int refinements, int degree)
  { return certify::DualNorm<dim>(c.form, {.refinements = refinements, .degree = degree})(result.u); };
  const std::array<double, 4> values{norm(1, 2), norm(1, 3), norm(2, 3), norm(2, 4)};
  for (int i = 1; i < 4; ++i) EXPECT_GE(values[i], values[i - 1] * (1 - 1e-6)) << i;
  EXPECT_GE(values[1], 0.9 * values[3]);
  EXPECT_GE(values[2], 0.97 * values[3]);
}

TYPED_TEST(TrueError, DofsAreCountedWithoutRefining)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = KnownRepresentative<dim>().discrete(1);
  for (const int degree : {3, 6})
  {
    const mesh::Refined<dim> refined = mesh::refine_uniformly(c.mesh, 2);
    EXPECT_EQ(certify::count_dofs(c.mesh, {.refinements = 2, .degree = degree}),
              fem::LagrangeSpace<dim>(refined.mesh, degree).n_dofs());
  }
}

TEST(Effectivity, IsTheQuotientAboveRoundOff)
{
  EXPECT_EQ(certify::effectivity(3, 2, {.sigma = 1}), 1.5);
  EXPECT_EQ(certify::effectivity(1, 2, {.sigma = 1}), 0.5);
  EXPECT_EQ(certify::effectivity(1e-12, 1e-3, {.sigma = 1}), 1e-9);
  EXPECT_FALSE(certify::effectivity(1e-12, 3e-12, {.sigma = 1}).has_value());
  EXPECT_FALSE(certify::effectivity(1e-12, 3e-12, {.sigma = 1e-12, .round_off = 1e-11}).has_value());
}

/// u = (0.3 x y, 0.2 x^2 - 0.1 y^2) in equilibrium with its loads, all of the boundary prescribed: the
/// solution of degree 2 is u itself. The error of degree 1 is integrated here.
TEST(RicherSolution, OfAKnownSolutionGivesTheError)
{
  const auto gradient = [](const Point<2>& x)
  {
    Tensor<2> g;
    g << 0.3 * x[1], 0.3 * x[0], 0.4 * x[0], -0.2 * x[1];
    return g;
  };
  // sigma with lambda = mu = 1: tr = 0.1 y; sigma_xx = 0.7 y, sigma_yy = -0.3 y, sigma_xy = 0.7 x; f = -div
  ProblemData<2> data{.material = lame(2.5, 0.25), .body_force = {0, -0.4}};
  for (const char* side : {"left", "right", "top", "bottom"})
    data.boundaries.push_back(fixed<2>(side, formula("0.3*x*y"), formula("0.2*x^2-0.1*y^2")));
  const DiscreteProblem<2> c(block<2>({3, 2}), data);
  const solve::NewtonResult<2> result = c.solve();
  double energy = 0;
  double stress = 0;
  const fem::Quadrature<2> rule = fem::quadrature<2>(4);
  const fem::Tabulation<2> table = c.space.basis().tabulate(rule.points);
  const problem::Material& material = c.problem.material(0);
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
  {
    const mesh::CellMap<2> map = mesh::cell_map(c.mesh, cell);
    for (int q = 0; q < rule.size(); ++q)
    {
      const Tensor<2> error =
          gradient(map(rule.points[q])) - fem::gradient_at<2>(c.space.cell_nodes(cell), result.u,
                                                              table.gradients_at(q), map.inverse_transpose);
      const Tensor<2> s = contact::sigma<2>(material, error);
      energy += rule.weights[q] * map.det * s.cwiseProduct(error).sum();
      stress += rule.weights[q] * map.det * s.squaredNorm();
    }
  }
  const certify::RicherSolution richer = certify::compare_with_richer<2>(
      c.form, result.u, {.refinements = 1, .degree = 2}, 10, c.method.newton, c.method.solver);
  ASSERT_TRUE(richer.error.has_value()) << richer.failure;
  EXPECT_EQ(richer.cells, 48);
  EXPECT_NEAR(richer.error->energy, std::sqrt(energy), 1e-9);
  EXPECT_NEAR(richer.error->stress, std::sqrt(stress), 1e-9);
  EXPECT_GT(richer.error->energy, 0.01);
}

TEST(RicherSolution, ThatIsNotReachedSaysWhy)
{
  const DiscreteProblem<2> c(few_cells<2>(), mixed_data<2>(), two_steps);
  solve::NewtonOptions newton = c.method.newton;
  newton.max_steps = 1;
  const certify::RicherSolution richer = certify::compare_with_richer<2>(
      c.form, c.solve().u, {.refinements = 1, .degree = 2}, 10, newton, c.method.solver);
  EXPECT_FALSE(richer.error.has_value());
  EXPECT_NE(richer.failure.find("max_steps"), std::string::npos) << richer.failure;
}

TYPED_TEST(TrueError, NestedInterpolationIsExact)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c(distorted(few_cells<dim>(), 4), mixed_data<dim>(), {.degree = 2});
  const fem::Constraints none{std::vector<char>(c.space.n_dofs(), 0), {}};
  const std::vector<double> u = random_free_vector(none, 1.0, 3);
  const contact::StressNorms norms = contact::stress_norms<dim>(c.problem, c.space, u);
  for (const auto& [times, degree] : {std::pair{1, 2}, {2, 3}, {1, 6}})
  {
    const mesh::Refined<dim> refined = mesh::refine_uniformly(c.mesh, times);
    const fem::LagrangeSpace<dim> fine(refined.mesh, degree);
    const std::vector<double> carried = fem::nested_interpolant<dim>(c.space, u, refined, fine);
    const contact::StressNorms carried_norms = contact::stress_norms<dim>(c.problem, fine, carried);
    EXPECT_NEAR(carried_norms.energy, norms.energy, 1e-11 * norms.energy);
    EXPECT_NEAR(carried_norms.sigma, norms.sigma, 1e-11 * norms.sigma);
    for (Index v = 0; v < dim * c.mesh.n_vertices(); ++v) EXPECT_NEAR(carried[v], u[v], 1e-13);
  }
}

}  // namespace

}  // namespace tribound::test
