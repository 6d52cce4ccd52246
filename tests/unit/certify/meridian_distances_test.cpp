/// @file meridian_distances_test.cpp
/// Distances and products of the stresses of bodies of revolution, with stresses that are known.

#include "tribound/certify/energy/meridian_distances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

#include "tribound/base/norm.h"
#include "tribound/certify/equilibrate/meridian_fields.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "unit/certify/weak_symmetry_testing.h"

namespace tribound::test
{

namespace
{

/// u_r = a r + b r z + c r^2, u_z = d z + e r^2 + k z^2 (p = 1: b = c = e = k = 0) with its body force, and
/// beside it an initial stress s I + m r (e_r x e_r + 2 e_t x e_t), s linear.
class ExactStress
{
 public:
  ExactStress(Axis axis, int degree, const problem::Material& material, bool is_stressed)
      : quadratic_(degree > 1 ? 1 : 0),
        problem_(skew_mesh(axis, 3), data(material, is_stressed), {.degree = degree}),
        fields_(problem_.form),
        u_(interpolate<2>(problem_.space, [&](const Point<2>& x) { return displacement(x); }))
  {
    certify::Stress<2>& stress = stress_;
    stress.degree = degree + 1;
    stress.n = fem::polynomial_dimension(2, stress.degree);
    stress.dis.assign(problem_.mesh.n_owned_cells() * stress.block_size(), 0.0);
    for (Index k = 0; k < problem_.mesh.n_owned_cells(); ++k)
    {
      const certify::SortedCell<2> cell = certify::make_sorted_cell(problem_.mesh, k);
      const auto exact = fields_.stress(k, cell, u_);
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c)
        {
          const auto tau =
              std::span(stress.dis)
                  .subspan(k * stress.block_size() + static_cast<std::size_t>((2 * r + c) * stress.n),
                           static_cast<std::size_t>(stress.n));
          std::ranges::copy(exact.plane[r][c], tau.begin());
          if (is_stressed) add_initial_stress(cell, r, c, tau);
        }
    }
  }

  [[nodiscard]] const contact::NitscheForm<2>& form() const { return problem_.form; }
  [[nodiscard]] const std::vector<double>& u() const { return u_; }
  [[nodiscard]] const certify::Stress<2>& stress() const { return stress_; }
  [[nodiscard]] std::vector<double> any(unsigned seed) const { return any_displacement(problem_, seed); }
  /// a(x, y)
  [[nodiscard]] double work(std::span<const double> x, std::span<const double> y) const
  {
    return tribound::inner_product(contact::apply_stiffness<2>(problem_.problem, problem_.space, x), y);
  }
  /// (sigma_0, eps(x))
  [[nodiscard]] double initial_work(std::span<const double> x) const
  {
    std::vector<double> forces(x.size(), 0.0);
    contact::add_initial_stress<2>(form().data(), problem_.space, forces);
    return -tribound::inner_product(forces, x);
  }

 private:
  [[nodiscard]] Point<2> displacement(const Point<2>& x) const
  {
    const double r = x[0];
    const double z = x[1];
    return {0.3 * r + quadratic_ * (0.2 * r * z - 0.4 * r * r),
            -0.1 * z + quadratic_ * (0.5 * r * r + 0.3 * z * z)};
  }
  /// r times the entry, by moments on the basis of the stress.
  void add_initial_stress(const certify::SortedCell<2>& cell, int row, int column,
                          std::span<double> tau) const
  {
    const fem::Quadrature<2> rule = fem::quadrature<2>(stress_.degree + 2);
    std::vector<double> phi(tau.size());
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<2> x = cell.origin + cell.jacobian * rule.points[q];
      fem::orthonormal_values<2>(stress_.degree, rule.points[q], phi);
      const double value = x[0] * problem_.problem.initial_stress(0, x)(row, column);
      for (std::size_t j = 0; j < phi.size(); ++j)
        tau[j] += rule.weights[q] * std::sqrt(cell.det) * value * phi[j];
    }
  }
  [[nodiscard]] ProblemData<2> data(const problem::Material& material, bool is_stressed) const
  {
    const double mu = material.mu;
    const double lambda = material.lambda;
    const double initial = is_stressed ? 1 : 0;
    const std::array<problem::Field, 2> force = {
        problem::Field(quadratic_ * 0.4 * (3 * lambda + 6 * mu) - initial * 0.2),
        problem::Field(-quadratic_ * (lambda * (2 * 0.2 + 2 * 0.3) + mu * (2 * 0.2 + 4 * 0.5 + 4 * 0.3)) +
                       initial * 0.1)};
    problem::Region<2> region{.name = "box", .material = material, .body_force = force};
    if (is_stressed)
    {
      region.initial_stress[0] = formula("0.3 + (0.2 + 0.25)*x - 0.1*y");
      region.initial_stress[1] = formula("0.3 + 0.2*x - 0.1*y");
      region.initial_stress_zz = formula("0.3 + (0.2 + 2*0.25)*x - 0.1*y");
    }
    return {.boundaries = {obstacle<2>("bottom")}, .regions = {region}};
  }

  double quadratic_;
  MeridianProblem problem_;
  certify::MeridianFields fields_;
  std::vector<double> u_;
  certify::Stress<2> stress_;
};

double total(const std::vector<double>& of_cells)
{
  return std::accumulate(of_cells.begin(), of_cells.end(), 0.0);
}

class MeridianDistances : public ::testing::TestWithParam<std::tuple<Axis, int>>
{
 protected:
  /// check(exact) for materials up to nearly incompressible ones, with an initial stress and without.
  template <class Check>
  static void check_all(const Check& check)
  {
    for (const double nu : {0.0, 0.3, 0.49})
      for (const bool is_stressed : {false, true})
      {
        SCOPED_TRACE(::testing::Message() << nu << (is_stressed ? ", initial stress" : ""));
        check(ExactStress(std::get<0>(GetParam()), std::get<1>(GetParam()), lame(1, nu), is_stressed));
      }
  }
};

TEST_P(MeridianDistances, VanishForTheExactStress)
{
  check_all(
      [](const ExactStress& exact)
      {
        const auto distances =
            certify::meridian_distances(exact.form(), exact.stress(), exact.u(), exact.u());
        const double size = exact.work(exact.u(), exact.u());
        EXPECT_LE(total(distances.square), 1e-22 * size);
        EXPECT_LE(total(distances.to_discrete), 1e-22 * size);
        EXPECT_EQ(total(distances.correction), 0);
        EXPECT_LE(distances.unbalanced, 1e-13);
      });
}

TEST_P(MeridianDistances, AreThoseOfProducts)
{
  check_all(
      [](const ExactStress& exact)
      {
        const std::vector<double> c = exact.any(3);
        const std::vector<double> v = sum(exact.u(), -1, c);
        const auto distances = certify::meridian_distances(exact.form(), exact.stress(), exact.u(), v);
        const double square = exact.work(c, c);
        EXPECT_NEAR(total(distances.correction), square, 1e-12 * square);
        EXPECT_LE(total(distances.square), (1 + 1e-12) * square);  // sigma(u) is as far away

        const certify::DualPair<2> pair{.z = c};
        const auto products = certify::meridian_products(exact.form(), exact.stress(), v, pair);
        EXPECT_NEAR(total(products.square), square, 1e-12 * square);
        EXPECT_NEAR(total(products.energy), square, 1e-12 * square);
        EXPECT_NEAR(total(distances.to_discrete),
                    total(distances.square) / 4 - 2 * total(products.centre) + square, 1e-11 * square);
        // the weak form: tau has the tractions and the loads of sigma(u)
        EXPECT_NEAR(total(products.work), exact.work(exact.u(), c) + exact.initial_work(c), 1e-11 * square);
        EXPECT_LE(total(products.doubt), 1e-12 * square);
      });
}

TEST_P(MeridianDistances, DualStressesCarryLoadsToo)
{
  check_all(
      [](const ExactStress& exact)
      {
        if (exact.form().problem().has_initial_stress()) return;  // dual problems have none
        const std::vector<double> v = sum(exact.u(), 1, exact.any(5));
        const auto distances = certify::meridian_distances(exact.form(), exact.stress(), exact.u(), v);
        certify::DualPair<2> pair{.z = v, .stress = exact.stress(), .target = v, .form = &exact.form()};
        const auto products = certify::meridian_products(exact.form(), exact.stress(), v, pair);
        const double square = total(distances.square);
        const double of_v = exact.work(v, v);
        EXPECT_NEAR(total(products.square), square, 1e-12 * of_v);
        EXPECT_EQ(products.unbalanced, distances.unbalanced);
        // (tau + sigma(v), tau - sigma(v)) / 2 with ||tau||^2 = ||tau - sigma(v)||^2 + 2 (tau, sigma(v)) -
        // ...
        EXPECT_NEAR(total(products.centre), square / 2 + total(products.work) - of_v, 1e-11 * of_v);
      });
}

INSTANTIATE_TEST_SUITE_P(Meshes, MeridianDistances,
                         ::testing::Combine(::testing::Values(Axis::none, Axis::vertex, Axis::edges),
                                            ::testing::Range(1, 5)));

/// A rectangle of height 1 between two radii, held at the top, without contact tractions.
class HeldRing
{
 public:
  HeldRing(double inner, double outer, int n, int degree)
      : problem_(mapped(random_meridian(inner > 0 ? 0.5 : 0, n, 3),
                        [=](const Point<2>& x) -> Point<2>
                        {
                          if (inner == 0) return {outer * x[0], x[1]};
                          return {inner + (outer - inner) * (2 * x[0] - 1), x[1]};
                        }),
                 {.boundaries = {clamped<2>("top"), loaded<2>("right", 0.03, 0.02), obstacle<2>("bottom")},
                  .body_force = {problem::Field(0.1), problem::Field(-0.2)}},
                 {.degree = degree}),
        state_(in_equilibrium(problem_,
                              std::vector<Point<2>>(problem_.form.n_contact_points(), Point<2>::Zero())))
  {
  }

  /// a(u, u)
  [[nodiscard]] double energy() const
  {
    return tribound::inner_product(contact::apply_stiffness<2>(problem_.problem, problem_.space, state_.u),
                                   state_.u);
  }
  /// The square of the distance of the stress of u from an admissible one.
  [[nodiscard]] double square() const
  {
    return total(
        certify::meridian_distances(problem_.form, weakly_symmetric(problem_, state_), state_.u, state_.u)
            .square);
  }

 private:
  MeridianProblem problem_;
  Equilibrium state_;
};

/// On the axis and off it: without contact the distance bounds the error, of which it is a small multiple
/// wherever the ring is.
TEST(MeridianEnergy, DistancesBoundTheError)
{
  for (const double inner : {0.0, 0.05, 0.5, 100.0})
  {
    const double finest = HeldRing(inner, inner + 1, 16, 4).energy();
    for (int degree = 1; degree <= 3; ++degree)
    {
      SCOPED_TRACE(::testing::Message() << "radius " << inner << ", degree " << degree);
      const HeldRing ring(inner, inner + 1, 3, degree);
      const double error = finest - ring.energy();
      EXPECT_GE(ring.square(), error);
      EXPECT_LE(ring.square(), 1.6 * 1.6 * error);
    }
  }
}

}  // namespace

}  // namespace tribound::test
