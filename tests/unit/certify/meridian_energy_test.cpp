/// @file meridian_energy_test.cpp
/// Parts of the energy bound of bodies of revolution: motions, tractions, contact terms, oscillation.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/balanced_traction.h"
#include "tribound/certify/energy/meridian_oscillation.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "unit/certify/meridian_testing.h"

namespace tribound::test
{

namespace
{

TEST(MeridianMotions, AreThoseAlongTheAxis)
{
  const auto motions = [](const std::vector<problem::BoundaryCondition<2>>& boundaries)
  {
    const mesh::Mesh<2> mesh(skew_mesh(Axis::edges, 2));
    return certify::FreeMotions<2>(ProblemData<2>{.boundaries = boundaries}.on(mesh).axisymmetric(), mesh);
  };
  EXPECT_EQ(motions({fixed<2>("top", free, 0.0)}).size(), 0);
  for (const auto& boundaries : {std::vector<problem::BoundaryCondition<2>>{}, {fixed<2>("top", 0.0, free)}})
  {
    const certify::FreeMotions<2> free_ones = motions(boundaries);
    ASSERT_EQ(free_ones.size(), 1);
    EXPECT_FALSE(free_ones.is_unclear());
    for (const Point<2>& x : {Point<2>(0.3, 0.7), Point<2>(2, -1)})
      EXPECT_LE((free_ones(0, x).cwiseAbs() - Point<2>(0, 1)).norm(), 1e-15);
  }
}

class MeridianTractions : public OnMeridians
{
};
INSTANTIATE_TEST_SUITE_P(Meridians, MeridianTractions,
                         ::testing::Combine(::testing::Values(Axis::none, Axis::edges),
                                            ::testing::Range(1, 4)));

TEST_P(MeridianTractions, BalanceTheLoadsAlongTheAxis)
{
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.02)),
        problem::ContactLaw(Coulomb(0.4))})
  {
    const MeridianProblem c(skew_mesh(axis(), 3), pressed(false, law), {.degree = degree()});
    const certify::FreeMotions<2> motions(c.problem, c.mesh);
    const auto t_h = certify::balanced_traction<2>(c.form, motions, c.form.traction(any_displacement(c, 1)));
    ASSERT_TRUE(t_h.has_value());
    double load = 0;
    for (std::size_t i = 1; i < c.form.load().size(); i += 2) load += c.form.load()[i];
    double held = 0;
    for (std::size_t i = 0; i < c.form.n_contact_points(); ++i)
      held += c.form.contact_points()[i].weight * t_h->at_points[i][1];
    EXPECT_NEAR(held, -load, 1e-13);
  }
}

/// int_F r (t^n (v^n - g) + s |v^t| + t^t . v^t) by many points.
double contact_gap(const MeridianProblem& c, const certify::ObstacleFacets<2>& facets, std::size_t k,
                   const certify::AdmissibleTraction<2>& t, std::span<const double> v)
{
  constexpr int n_parts = 400;
  const auto n = static_cast<Eigen::Index>(facets.nodes(k).size());
  const auto map = contact::simplex_map(c.mesh, c.form.segments()[k].slave);
  const fem::LagrangeBasis<1> basis(static_cast<int>(n) - 1);
  const std::vector<Point<2>> of_v = facets.coefficients(k, v);
  const Point<2>& normal = facets.frames().normal(k);
  double sum = 0;
  for (int i = 0; i < n_parts; ++i)
  {
    const double s = (i + 0.5) / n_parts;
    Point<2> traction = Point<2>::Zero();
    Point<2> there = Point<2>::Zero();
    double gap = 0;
    double threshold = 0;
    for (Eigen::Index j = 0; j < n; ++j)
    {
      const std::array<int, 2>& a = basis.node(static_cast<int>(j));
      const double b = std::tgamma(a[0] + a[1] + 1) / (std::tgamma(a[0] + 1) * std::tgamma(a[1] + 1)) *
                       std::pow(1 - s, a[0]) * std::pow(s, a[1]);
      traction += b * t.coefficients[k * n + j];
      there += b * of_v[j];
      gap += b * facets.gap(k)[j];
      threshold += b * t.thresholds[k * n + j];
    }
    const double along = there.dot(normal);
    const Point<2> across = there - along * normal;
    sum += map(Point<1>(s))[0] *
           (traction.dot(normal) * (along - gap) + threshold * across.norm() + traction.dot(across));
  }
  return sum / n_parts * c.form.segments()[k].det();
}

TEST_P(MeridianTractions, ContactTermsHaveTheWeight)
{
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.02)),
        problem::ContactLaw(Coulomb(0.4))})
  {
    const MeridianProblem c(skew_mesh(axis(), 3), pressed(true, law), {.degree = degree()});
    std::vector<double> v = any_displacement(c, 2);
    for (std::size_t i = 1; i < v.size(); i += 2) v[i] += 0.2;  // away from the obstacle
    const certify::AdmissibleTraction<2> pushing =
        certify::admissible_traction<2>(c.form, c.form.traction(any_displacement(c, 3)));
    const certify::ObstacleFacets<2> facets(c.form);
    const certify::ContactGap<2> gaps(c.form, facets);
    for (std::size_t k = 0; k < facets.size(); ++k)
    {
      const double expected = contact_gap(c, facets, k, pushing, v);
      EXPECT_NEAR(gaps(k, pushing, v), expected, 2e-3 * expected + 1e-12);
    }
  }
}

/// The largest (rho, w_z) for ||r^{-1/2} rho|| = |w| = 1 among polynomials.
double axial_constant_from_below(const std::array<Point<2>, 3>& vertices)
{
  constexpr int of_rho = 3;
  constexpr int of_w = 6;
  const auto monomials = [](int degree, const auto& visit)
  {
    int k = 0;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j) visit(k++, i, j);
  };
  const auto power = [](double x, int i) { return i < 0 ? 0.0 : std::pow(x, i); };
  const Eigen::Index n_rho = fem::polynomial_dimension(2, of_rho);
  const Eigen::Index n_r = fem::polynomial_dimension(2, of_w - 1);
  const Eigen::Index n_z = fem::polynomial_dimension(2, of_w);
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * of_w + 1);
  Tensor<2> jacobian;
  jacobian << vertices[1] - vertices[0], vertices[2] - vertices[0];
  Eigen::VectorXd means = Eigen::VectorXd::Zero(n_rho);
  double all = 0;
  const auto for_points = [&](const auto& visit)
  {
    for (int q = 0; q < rule.size(); ++q)
      visit(Point<2>(vertices[0] + jacobian * rule.points[q]),
            rule.weights[q] * std::abs(jacobian.determinant()));
  };
  for_points(
      [&](const Point<2>& x, double dx)
      {
        monomials(of_rho,
                  [&](int k, int i, int j) { means[k] += dx * x[0] * power(x[0], i) * power(x[1], j); });
        all += dx * x[0];
      });
  Eigen::MatrixXd of_rhos = Eigen::MatrixXd::Zero(n_rho - 1, n_rho - 1);
  Eigen::MatrixXd work = Eigen::MatrixXd::Zero(n_rho - 1, n_r + n_z);
  Eigen::MatrixXd strains = Eigen::MatrixXd::Zero(n_r + n_z, n_r + n_z);
  for_points(
      [&](const Point<2>& x, double dx)
      {
        Eigen::VectorXd rho(n_rho);  // divided by r
        monomials(of_rho,
                  [&](int k, int i, int j) { rho[k] = power(x[0], i) * power(x[1], j) - means[k] / all; });
        rho = rho.tail(n_rho - 1).eval();
        Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n_r + n_z, 4);
        Eigen::VectorXd w_z = Eigen::VectorXd::Zero(n_r + n_z);
        monomials(of_w - 1,
                  [&](int k, int i, int j)
                  {
                    b(k, 0) = (i + 1) * power(x[0], i) * power(x[1], j);
                    b(k, 2) = power(x[0], i + 1) * j * power(x[1], j - 1) / std::sqrt(2);
                    b(k, 3) = power(x[0], i) * power(x[1], j);
                  });
        monomials(of_w,
                  [&](int k, int i, int j)
                  {
                    w_z[n_r + k] = power(x[0], i) * power(x[1], j);
                    b(n_r + k, 1) = power(x[0], i) * j * power(x[1], j - 1);
                    b(n_r + k, 2) = i * power(x[0], i - 1) * power(x[1], j) / std::sqrt(2);
                  });
        of_rhos += dx * x[0] * rho * rho.transpose();
        work += dx * x[0] * rho * w_z.transpose();
        strains += dx * x[0] * b * b.transpose();
      });
  const SymmetricEigen eigen = symmetric_eigen(strains);
  Eigen::MatrixXd scaled = work * eigen.vectors;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k)
    scaled.col(k) *=
        eigen.values[k] > 1e-11 * eigen.values[eigen.values.size() - 1] ? 1 / std::sqrt(eigen.values[k]) : 0;
  const Eigen::MatrixXd product = solve_lower(CholeskyFactors(of_rhos).lower(), scaled);
  const SymmetricEigen squares = symmetric_eigen(product * product.transpose());
  return std::sqrt(squares.values[squares.values.size() - 1]);
}

TEST(AxialConstant, IsAboveTheBestOneAmongPolynomials)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0, 1);
  std::vector<double> ratios;
  for (int trial = 0; trial < 90; ++trial)
  {
    std::array<Point<2>, 3> x = {Point<2>(0, 0), Point<2>(number(random), 2 * number(random) - 1),
                                 Point<2>(number(random), 2 * number(random) - 1)};
    if (trial % 3 == 0) x[1] = Point<2>(0, 0.2 + number(random));  // an edge on the axis
    if (trial % 3 == 1)
      for (Point<2>& vertex : x) vertex[0] += 3 * number(random);
    const Point<2> a = x[1] - x[0];
    const Point<2> b = x[2] - x[0];
    if (std::abs(a[0] * b[1] - a[1] * b[0]) < 0.05) continue;
    const double best = axial_constant_from_below(x);
    std::ranges::shuffle(x, random);
    EXPECT_GE(certify::axial_constant(x), best) << trial;
    ratios.push_back(certify::axial_constant(x) / best);
  }
  std::ranges::sort(ratios);
  EXPECT_LE(ratios[ratios.size() / 2], 8);
  const std::array<Point<2>, 3> half_square = {Point<2>(0, 0), Point<2>(1, 0), Point<2>(0, 1)};
  EXPECT_NEAR(certify::axial_constant(half_square) / std::sqrt(2), 2.98, 0.02);
}

TEST(AxialConstant, DoesNotJumpWhereRadiiAreNearlyTheSame)
{
  const double same = certify::axial_constant({Point<2>(0, 0), Point<2>(1, 0), Point<2>(1, 1)});
  for (const double by : {1e-14, 1e-9, 1e-3})
    EXPECT_NEAR(certify::axial_constant({Point<2>(0, 0), Point<2>(1, 0), Point<2>(1 + by, 1)}) / same, 1,
                0.03);
}

/// The bound of bodies whose loads have the given degree.
certify::LoadOscillation oscillation(Axis axis, int p, const ProblemData<2>& data)
{
  const MeridianProblem c(skew_mesh(axis, 3), data, {.degree = p});
  return certify::load_oscillation<2>(c.form, any_displacement(c, 1), HUGE_VAL);
}

/// With sigma_0 = s (e_r x e_r + e_r x e_z + e_z x e_r + 2 e_t x e_t).
ProblemData<2> stressed(const std::string& s)
{
  problem::Region<2> region{.name = "box", .material = lame(1, 0.3)};
  region.initial_stress[0] = region.initial_stress[2] = formula(s);
  region.initial_stress_zz = formula(fmt::format("2*({})", s));
  return {.boundaries = {fixed<2>("bottom", free, 0.0)}, .regions = {region}};
}

/// ||r^{1/2} (f - Pi^p f)||^2 on a cell.
double square_beyond(const MeridianProblem& c, Index cell, const std::string& text)
{
  const problem::Field f = formula(text);
  const fem::Quadrature<2> rule = fem::quadrature<2>(20);
  const mesh::CellMap<2> map = mesh::cell_map(c.mesh, cell);
  const int n = fem::polynomial_dimension(2, c.space.degree());
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd theta(n);
  const auto set_theta = [&](int q)
  {
    fem::orthonormal_values<2>(c.space.degree(), rule.points[q], std::span(theta.data(), theta.size()));
    return f(map(rule.points[q]));
  };
  for (int q = 0; q < rule.size(); ++q) moments += rule.weights[q] * set_theta(q) * theta;
  double square = 0;
  for (int q = 0; q < rule.size(); ++q)
    square +=
        map.det * rule.weights[q] * map(rule.points[q])[0] * std::pow(set_theta(q) - theta.dot(moments), 2);
  return square;
}

TEST_P(MeridianTractions, NothingIsLostOfPolynomials)
{
  const int p = degree();
  const auto power = [](const char* what, int exponent)
  { return formula(fmt::format("0.1*{}^{}", what, exponent)); };
  const ProblemData<2> data{
      .boundaries = {fixed<2>("bottom", free, 0.0), loaded<2>("right", power("y", p), power("x", p)),
                     loaded<2>("top", power("x", p), power("y", p))},
      .body_force = {power("x", p - 1), power("y", p - 1)}};
  const certify::LoadOscillation result = oscillation(axis(), p, data);
  EXPECT_EQ(result.reason, "");
  EXPECT_EQ(*std::ranges::max_element(result.cells), 0);
  EXPECT_EQ(result.missed, 0);
  const certify::LoadOscillation of_initial = oscillation(axis(), p, stressed(fmt::format("0.1*x^{}", p)));
  EXPECT_EQ(of_initial.reason, "");
  EXPECT_LE(*std::ranges::max_element(of_initial.cells), 1e-14);
  EXPECT_EQ(of_initial.missed, 0);
}

TEST_P(MeridianTractions, OscillationOfTheInitialStressIsBounded)
{
  const int p = degree();
  for (const std::string& shape :
       {fmt::format("x^{}", p + 1), fmt::format("y^{}", p + 2), std::string("exp(x - 2*y)")})
  {
    const MeridianProblem c(skew_mesh(axis(), 3), stressed(shape), {.degree = p});
    const certify::LoadOscillation found =
        certify::load_oscillation<2>(c.form, any_displacement(c, 1), HUGE_VAL);
    EXPECT_EQ(found.reason, "");
    for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    {
      constexpr double entries = 1 + 2 + 4;  // rr, rz and zr, the hoop entry
      const double lost =
          std::sqrt(entries * square_beyond(c, cell, shape) / certify::least_stiffness<2>(c.form, cell));
      EXPECT_GE(found.cells[cell], lost * (1 - 1e-9)) << shape;
      EXPECT_LE(found.cells[cell], 6 * lost + 1e-14) << shape;  // enclosures, and the largest r
    }
  }
}

TEST_P(MeridianTractions, WhatIsLostHasAReasonOrABound)
{
  const int p = degree();
  const bool on_axis = axis() == Axis::edges;
  const auto with = [&](problem::Field body, problem::Field traction)
  {
    return oscillation(axis(), p,
                       {.boundaries = {fixed<2>("bottom", free, 0.0), loaded<2>("top", traction, 0)},
                        .body_force = {body, 0.0}});
  };
  const certify::LoadOscillation of_body = with(formula(fmt::format("y^{}", p)), 0.0);
  EXPECT_EQ(of_body.reason, "");
  EXPECT_GT(*std::ranges::max_element(of_body.cells), 0);
  const certify::LoadOscillation of_traction = with(0.0, formula(fmt::format("x^{}", p + 1)));
  EXPECT_EQ(of_traction.reason.empty(), !on_axis);
  EXPECT_NE(with(formula("sin(9*y)"), 0.0).reason, "");  // K is infinite
}

}  // namespace

}  // namespace tribound::test
