/// @file weak_symmetry_test.cpp
/// The weakly symmetric stress of axisymmetric problems: its identities, and that it is near.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/energy/balanced_solution.h"
#include "tribound/certify/equilibrate/meridian_fields.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "unit/certify/weak_symmetry_testing.h"

namespace tribound::test
{

namespace
{

/// A skew mesh whose vertex nearest to the axis is `inner` off it.
mesh::MeshData<2> off_axis(double inner, int n)
{
  return mapped(skew_mesh(Axis::none, n),
                [inner](const Point<2>& x) -> Point<2> {
                  return {inner - 1.3 + x[0], x[1]};
                });
}

/// What holds the top: both components, one, or nothing.
std::vector<problem::BoundaryCondition<2>> tops()
{
  return {fixed<2>("top", 0.0, formula("-0.05 + 0.01*x")), fixed<2>("top", free, formula("-0.05 + 0.01*x")),
          fixed<2>("top", 0.0, free), loaded<2>("top", formula("0.02*x"), formula("-0.1*(1 + x*y)"))};
}

void expect_identities(const mesh::MeshData<2>& data, int degree)
{
  for (const problem::BoundaryCondition<2>& top : tops())
  {
    ProblemData<2> of = pressed(false);
    of.boundaries[0] = top;
    const MeridianProblem c(data, of, {.degree = degree});
    const Equilibrium state = in_equilibrium(c, c.form.traction(any_displacement(c, 2)));
    const certify::IdentityDefects defects =
        certify::check_identities<2>(c.form, state.t, weakly_symmetric(c, state));
    EXPECT_TRUE(defects.is_symmetric);
    EXPECT_LE(defects.divergence, 1e-11);
    EXPECT_LE(defects.jump, 1e-11);
    EXPECT_LE(defects.neumann, 1e-11);
    EXPECT_LE(defects.contact, 1e-11);
    EXPECT_LE(defects.symmetry, 1e-11);
  }
}

class SkewWeakSymmetry : public OnMeridians
{
};

TEST_P(SkewWeakSymmetry, Balances)
{
  expect_identities(skew_mesh(axis(), 4), degree());
}

INSTANTIATE_TEST_SUITE_P(Meshes, SkewWeakSymmetry, meridians);

class WeakSymmetryOffAxis : public ::testing::TestWithParam<std::tuple<double, int>>
{
};

TEST_P(WeakSymmetryOffAxis, Balances)
{
  const auto [inner, degree] = GetParam();
  expect_identities(off_axis(inner, 4), degree);
}

INSTANTIATE_TEST_SUITE_P(Meshes, WeakSymmetryOffAxis,
                         ::testing::Combine(::testing::Values(0.5, 20), ::testing::Range(1, 5)));

/// The square of the distance between the stress, with the hoop stress that follows from it, and that of u in
/// the norm of the compliance.
double squared_distance(const MeridianProblem& c, const certify::Stress<2>& stress, std::span<const double> u)
{
  const certify::MeridianFields fields(c.form);
  const fem::MeridianRules rules(c.mesh, 2 * stress.degree + 2);
  std::vector<double> phi(stress.n);
  std::vector<Point<2>> gradients(stress.n);
  double sum = 0;
  for (Index k = 0; k < c.mesh.n_cells(); ++k)
  {
    const certify::SortedCell<2> sorted = certify::make_sorted_cell(c.mesh, k);
    const certify::MeridianFields::WeightedStress of_u = fields.stress(k, sorted, u);
    const Eigen::VectorXd load = fields.load(k, sorted)[0];
    const problem::Material& material = c.problem.material(c.mesh.region(k));
    const double kappa = material.lambda / (2 * material.mu + 3 * material.lambda);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(c.mesh, k), rules.of_cell(k)))
    {
      fem::orthonormal_gradients<2>(stress.degree, sorted.inverse * (x - sorted.origin), phi, gradients);
      const Eigen::Map<const Eigen::VectorXd> basis(phi.data(), load.size());
      std::array<double, 4> difference{};
      double hoop = basis.dot(x[0] * load - of_u.hoop);
      for (int entry = 0; entry < 4; ++entry)
      {
        difference[entry] = -basis.dot(of_u.plane[entry / 2][entry % 2]);
        for (int j = 0; j < stress.n; ++j)
        {
          const double coefficient = stress.dis_in(k)[entry * stress.n + j];
          difference[entry] += coefficient * phi[j];
          if (entry < 2) hoop += x[0] * coefficient * gradients[j].dot(sorted.inverse.col(entry));
        }
      }
      const double trace = difference[0] + difference[3] + hoop;
      double square = hoop * hoop - kappa * trace * trace;
      for (const double d : difference) square += d * d;
      sum += dx / sorted.det * square / (2 * material.mu * x[0]);
    }
  }
  return sum;
}

/// Loads that the stress carries exactly.
ProblemData<2> loaded_block()
{
  return {.boundaries = {loaded<2>("top", 0.0, formula("-0.1*(1 + x)")), loaded<2>("right", 0.03, 0.0),
                         fixed<2>("bottom", free, 0.0)},
          .body_force = {0.03, -0.04}};
}

struct Distance
{
  double of_stress;  ///< from that of u
  double error;      ///< of u
};

Distance distance_and_error(const mesh::MeshData<2>& data, int degree)
{
  const MeridianProblem c(data, loaded_block(), {.degree = degree});
  const Equilibrium state = in_equilibrium(c, {});
  const MeridianProblem finer(data, loaded_block(), {.degree = degree + 2});
  std::vector<double> error = in_equilibrium(finer, {}).u;
  const std::vector<double> u = certify::raised<2>(c.space, state.u, finer.space);
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= u[i];
  const std::vector<double> forces = contact::apply_stiffness<2>(finer.problem, finer.space, error);
  double square = 0;
  for (std::size_t i = 0; i < error.size(); ++i) square += error[i] * forces[i];
  return {std::sqrt(squared_distance(c, weakly_symmetric(c, state), state.u)), std::sqrt(square)};
}

/// n x n squares of a ring whose width is 1.
mesh::MeshData<2> ring(double inner, int n)
{
  return mapped(random_meridian(0, n, 3),
                [inner](const Point<2>& x) -> Point<2> {
                  return {inner + x[0], x[1]};
                });
}

class RingWeakSymmetry : public ::testing::TestWithParam<std::tuple<double, int>>
{
 protected:
  [[nodiscard]] double inner() const { return std::get<0>(GetParam()); }
  [[nodiscard]] int degree() const { return std::get<1>(GetParam()); }
};

/// The body is nowhere in contact: the distance is a bound of the error.
TEST_P(RingWeakSymmetry, IsNear)
{
  const auto [distance, error] = distance_and_error(ring(inner(), 4), degree());
  const auto [finer_distance, finer_error] = distance_and_error(ring(inner(), 8), degree());
  EXPECT_GE(distance, 0.999 * error);
  EXPECT_GE(finer_distance, 0.999 * finer_error);
  EXPECT_LE(distance, 1.5 * error);
  EXPECT_LE(finer_distance, 1.5 * finer_error);
  EXPECT_LE(finer_distance, 1.4 * distance / (degree() == 1 ? 2 : 4));
}

INSTANTIATE_TEST_SUITE_P(Rings, RingWeakSymmetry,
                         ::testing::Combine(::testing::Values(0, 0.5, 20), ::testing::Range(1, 5)));

TEST(WeakSymmetry, DoesNotDependOnTheNumberOfThreads)
{
  const MeridianProblem c(skew_mesh(Axis::edges, 8), pressed(true), {.degree = 2});
  const Equilibrium state = in_equilibrium(c, c.form.traction(any_displacement(c, 2)));
  const certify::Stress<2> alone = weakly_symmetric(c, state, 1);
  for (const int n_threads : {2, 3}) EXPECT_EQ(weakly_symmetric(c, state, n_threads).dis, alone.dis);
}

}  // namespace

}  // namespace tribound::test
