/// @file algebraic_test.cpp
/// The remainder of the linear solver: rho and alg against the numbers of an independent program,
/// tests/verification/data/algebraic.json; the divergence of the stress; bounds of dual norms; iterations
/// stopped by it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "support/box_sides.h"
#include "support/t2d.h"
#include "tribound/adapt/level.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

using nlohmann::json;

void expect_digits(double value, const json& expected, const char* what)
{
  EXPECT_NEAR(value, expected.get<double>(), 1e-8 * expected.get<double>()) << what;
}

/// u on the free degrees of freedom + size (sin(3x + 2y), cos(2x - 3y), sin(x + z)) at the nodes.
template <int dim>
std::vector<double> perturbed(const DiscreteProblem<dim>& c, std::vector<double> u, double size)
{
  const std::vector<Point<dim>> nodes = c.space.node_points();
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Point<dim>& x = nodes[i];
    const std::array<double, 3> change = {std::sin(3 * x[0] + 2 * x[1]), std::cos(2 * x[0] - 3 * x[1]),
                                          std::sin(x[0] + x[dim - 1])};
    for (int a = 0; a < dim; ++a)
      if (!c.form.constraints().fixed[dim * i + a]) u[dim * i + a] += size * change[a];
  }
  return u;
}

class AlgebraicT2D : public ::testing::TestWithParam<int>
{
};

TEST_P(AlgebraicT2D, AgreesWithAnIndependentProgram)
{
  const json expected = json::parse(std::ifstream(ALGEBRAIC_REFERENCE)).at("results").at(GetParam());
  const DiscreteProblem<2> c = t2d(expected["p"], expected["nx"], expected["nx"].get<int>() / 2);
  const std::vector<double> solution = c.solve().u;
  const std::vector<double> u = perturbed<2>(c, solution, 1e-3);
  const std::vector<Point<2>> t =
      expected["t"] == "t = T(u)" ? c.form.traction(u)
                                  : c.form.linearised_traction(contact::Linearisation::newton, solution, u);

  const certify::AlgebraicResidual<2> algebraic(c.form);
  const auto rho = algebraic.body_force(algebraic.residual(u, t), certify::PatchStress::afw);
  expect_digits(certify::field_norm<2>(c.problem, c.mesh, rho), expected["rho"], "||rho||");
  const certify::FriedrichsConstant of_4x2{
      .value = expected["CF_4x2"], .theta = 1, .mesh_size = 1, .cells = 16};
  const certify::Stress<2> stress = certify::equilibrate<2>(c.form, u, t, 0, 0, certify::PatchStress::afw);
  const certify::Estimate eta =
      certify::Estimator<2>(c.form, certify::ContactRule::reference, of_4x2)(u, stress);
  EXPECT_LE(eta.global.alg, expected["eta_alg"].get<double>() * (1 + 1e-8));  // the tree may give less
  expect_digits(of_4x2.value * certify::field_norm<2>(c.problem, c.mesh, rho), expected["eta_alg"],
                "C_F ||rho||");
  expect_digits(eta.global.str, expected["eta_str"], "str");
  expect_digits(eta.total - eta.global.alg, expected["eta_tot"], "eta_tot");
  EXPECT_LE(certify::check_identities<2>(c.form, t, stress, rho).largest(), 1e-13);
  EXPECT_GE(certify::check_identities<2>(c.form, t, stress).divergence, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Cases, AlgebraicT2D, ::testing::Range(0, 14));

/// A distorted block with contact on two sides, rollers and loads, on a partly bisected mesh.
template <int dim>
DiscreteProblem<dim> some_problem(int p)
{
  constexpr Sides<dim> sides = []
  {
    Sides<dim> s{Side::roller_x, Side::contact, Side::contact, Side::neumann};
    if constexpr (dim == 3)
      s = {Side::roller_x, Side::contact, Side::contact, Side::neumann, Side::roller_z, Side::neumann};
    return s;
  }();
  mesh::Mesh<dim> mesh(distorted<dim>(block<dim>({4, 3}, {2, 1, 1}), 3));
  for (int level = 0; level < 2; ++level)
  {
    std::vector<Index> marked;
    for (Index c = 0; c < mesh.n_cells(); c += 3) marked.push_back(c);
    mesh = mesh::bisect<dim>(mesh, marked, 1).mesh;
  }
  return {std::move(mesh),
          ProblemData<dim>{.boundaries = side_conditions<dim>(
                               sides, problem::Contact(Tresca(formula("0.01 + 0.005*sin(x)")))),
                           .body_force = components<dim>(formula("0.1*x*y"), formula("-0.1*(1 + x^2*y)"),
                                                         formula("0.05*z*x"))},
          {.degree = p}};
}

/// functional_i = (rho, phi_i) in a space on the mesh refined once; rho is on the given mesh.
template <int dim>
std::vector<double> tested(const mesh::Mesh<dim>& mesh, const certify::AffineFields<dim>& rho,
                           const fem::LagrangeSpace<dim>& fine)
{
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(fine.degree() + 1);
  const fem::Tabulation<dim> table = fine.basis().tabulate(rule.points);
  std::vector<double> functional(fine.n_dofs(), 0.0);
  for (Index c = 0; c < fine.mesh().n_cells(); ++c)
  {
    const Index coarse = c >> dim;
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, coarse);
    const mesh::CellMap<dim> fine_map = mesh::cell_map(fine.mesh(), c);
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> s =
          map.inverse_transpose.transpose() * (fine_map(rule.points[q]) - mesh.vertex(mesh.cell(coarse)[0]));
      Point<dim> value = (1 - s.sum()) * rho[coarse][0];
      for (int a = 0; a < dim; ++a) value += s[a] * rho[coarse][a + 1];
      for (int i = 0; i < fine.basis().n_nodes(); ++i)
        for (int a = 0; a < dim; ++a)
          functional[dim * fine.cell_nodes(c)[i] + a] +=
              rule.weights[q] * fine_map.det * table.values_at(q)[i] * value[a];
    }
  }
  return functional;
}

/// Any u and t are an iterate with the defect rho, whatever its size: smooth, or varying from node to node as
/// after a few steps of a linear solver.
template <int dim>
void expect_bound(int p)
{
  const DiscreteProblem<dim> c = some_problem<dim>(p);
  const std::vector<double> solution = c.solve().u;
  const certify::Estimator<dim> estimator(c.form);
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = 1, .degree = p + 1});
  std::mt19937 random(static_cast<unsigned>(10 * dim + p));
  std::uniform_real_distribution<double> change(-1, 1);
  for (const double size : {1e-6, 1e-3, 1e-1})
    for (const bool rough : {false, true})
    {
      std::vector<double> u = perturbed<dim>(c, solution, rough ? 0 : size);
      for (std::size_t i = 0; rough && i < u.size(); ++i)
        if (!c.form.constraints().fixed[i]) u[i] += size * change(random);
      const std::vector<Point<dim>> t = c.form.traction(u);
      const certify::Stress<dim> stress = certify::equilibrate<dim>(
          c.form, u, t, 0, 0, rough ? certify::PatchStress::rows : certify::PatchStress::afw);
      const auto rho = estimator.algebraic_remainder(u, stress);
      EXPECT_LE(certify::check_identities<dim>(c.form, t, stress, rho).largest(), 1e-11);
      const certify::Estimate eta = estimator(u, stress);
      const double below = dual_norm(u);
      EXPECT_GE(eta.total_sharp, below) << size << rough;

      // (rho, v) alone
      const double of_rho = dual_norm.of(tested<dim>(c.mesh, rho, dual_norm.space()));
      EXPECT_GE(eta.global.alg, of_rho);
      fmt::print(
          "{}D, p = {}, {:.0e} {:<6}: bound / dual norm {:.3f}, alg / its dual norm {:.2f}, of C_F ||rho|| "
          "{:.2f}\n",
          dim, p, size, rough ? "rough" : "smooth", eta.total_sharp / below, eta.global.alg / of_rho,
          eta.global.alg / (estimator.friedrichs().value * certify::field_norm<dim>(c.problem, c.mesh, rho)));
    }
}

class Algebraic : public ::testing::TestWithParam<int>
{
};

TEST_P(Algebraic, BoundsWhatIsLeft2D)
{
  expect_bound<2>(GetParam());
}

TEST_P(Algebraic, BoundsWhatIsLeft3D)
{
  expect_bound<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, Algebraic, ::testing::Range(1, 4));

/// A block in 3D by multigrid: fewer iterations, nearly the same bound, never below the dual norm. alg stays
/// within its share of every bound.
TEST(AlgebraicStop, SavesIterations)
{
  const ProblemData<3> data = pressed_block<3>();
  for (const int p : {1, 2})
  {
    std::array<int, 2> iterations{};
    std::array<double, 2> bounds{};
    for (const double gamma_alg : {0.0, 0.05})
    {
      adapt::Method method{.degree = p, .stopping = {.criterion = adapt::Stopping::tolerance}};
      method.solver.method = algebra::LinearMethod::iterative;
      method.solver.gamma_alg = gamma_alg;
      const DiscreteProblem<3> c(block<3>({8, 4, 4}), data, method);
      const adapt::CertifiedLevel<3> level = adapt::solve_and_certify<3>(c.form, {}, method);
      ASSERT_TRUE(adapt::bound_holds(level)) << level.failure;
      for (const adapt::CertifiedStep& step : level.steps)
      {
        iterations[gamma_alg > 0 ? 1 : 0] += step.step.linear_iterations;
        if (!step.bound) continue;  // step of a start
        EXPECT_LE(step.bound->global.alg, 0.051 * step.bound->total_sharp);
      }
      bounds[gamma_alg > 0 ? 1 : 0] = level.estimate.total_sharp;
    }
    fmt::print("p = {}: {} iterations to the tolerance, {} as the bound needs them\n", p, iterations[0],
               iterations[1]);
    EXPECT_LT(iterations[1], iterations[0]);
    EXPECT_NEAR(bounds[1], bounds[0], 0.05 * bounds[0]);
  }
}

}  // namespace

}  // namespace tribound::test
