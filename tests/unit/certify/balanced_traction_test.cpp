/// @file balanced_traction_test.cpp
/// Motions that conditions leave free, and tractions that obey the law and hold them.

#include "tribound/certify/energy/balanced_traction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "support/dimensions.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/traction_fit.h"

namespace tribound::test
{

namespace balanced_traction_test_cases
{

template <class Dimension>
class FreeMotions : public ::testing::Test
{
};
TYPED_TEST_SUITE(FreeMotions, Dimensions);

template <int dim>
std::size_t n_free(const std::vector<problem::BoundaryCondition<dim>>& boundaries)
{
  const mesh::Mesh<dim> mesh(block<dim>({4, 2}, {2, 2, 2}));
  const ProblemData<dim> data{.boundaries = boundaries};
  return certify::FreeMotions<dim>(data.on(mesh), mesh).size();
}

TYPED_TEST(FreeMotions, AreThoseThatConditionsLeave)
{
  constexpr int dim = TypeParam::value;
  EXPECT_EQ(n_free<dim>({}), dim * (dim + 1) / 2);
  EXPECT_EQ(n_free<dim>({clamped<dim>("left")}), 0);
  EXPECT_EQ(n_free<dim>({fixed<dim>("left", 0.0, free, free)}), dim == 2 ? 1 : 3);
  EXPECT_EQ(n_free<dim>({fixed<dim>("left", 0.0, free, free), fixed<dim>("bottom", free, 0.0, free)}),
            dim == 2 ? 0 : 1);
  EXPECT_EQ(n_free<dim>({fixed<dim>("left", free, 0.0, free)}), 2 + (dim == 2 ? 0 : 2));
}

TYPED_TEST(FreeMotions, AreRigidAndVanishWhereTheyAreFixed)
{
  constexpr int dim = TypeParam::value;
  const ProblemData<dim> data{.boundaries = {fixed<dim>("left", 0.0, free, free)}};
  const DiscreteProblem<dim> c(distorted(block<dim>({4, 2}, {3, 2, 2}), 1), {.boundaries = {}},
                               {.degree = 2});
  const DiscreteProblem<dim> held(block<dim>({4, 2}, {3, 2, 2}), data, {.degree = 2});
  for (const DiscreteProblem<dim>* const p : {&c, &held})
  {
    const certify::FreeMotions<dim> motions(p->problem, p->mesh);
    const std::vector<Point<dim>> points = p->space.node_points();
    for (int i = 0; i < static_cast<int>(motions.size()); ++i)
    {
      std::vector<double> z;
      for (const Point<dim>& x : points)
      {
        const Point<dim> value = motions(i, x);
        z.insert(z.end(), value.data(), value.data() + dim);
      }
      for (const double force : contact::apply_stiffness(p->problem, p->space, z))
        EXPECT_NEAR(force, 0, 1e-14);
      for (std::size_t k = 0; k < z.size(); ++k)
      {
        if (p->form.constraints().fixed[k] == 0) continue;
        EXPECT_NEAR(z[k], 0, 1e-14);
      }
    }
  }
}

TYPED_TEST(FreeMotions, AreStoppedByTheirSupports)
{
  constexpr int dim = TypeParam::value;
  const ProblemData<dim> data{.boundaries = {fixed<dim>("left", 0.0, free, free)}};
  const DiscreteProblem<dim> c(side_by_side<dim>(block<dim>({4, 2}, {3, 2, 2}),
                                                 mapped<dim>(block<dim>({2, 2}, {2, 2, 2}),
                                                             [](const Point<dim>& x) -> Point<dim>
                                                             { return x + 5 * Point<dim>::Ones(); }),
                                                 "'"),
                               data, {.degree = 2});
  const certify::FreeMotions<dim> motions(c.problem, c.mesh);
  const std::vector<Index> supports = motions.supports(c.space, c.form.constraints().fixed);
  ASSERT_EQ(supports.size(), motions.size());
  const std::vector<Point<dim>> points = c.space.node_points();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::ssize(supports), std::ssize(supports));
  for (Eigen::Index k = 0; k < rows.rows(); ++k)
  {
    const Point<dim>& x = points[supports[k] / dim];
    const auto [begin, end] = motions.of_body(x[1] > 3 ? 1 : 0);
    for (int i = begin; i < end; ++i) rows(k, i) = motions(i, x)[supports[k] % dim];
    EXPECT_FALSE(c.form.constraints().fixed[supports[k]]);
  }
  EXPECT_GT(std::abs(PivotedQr(rows).upper().diagonal().prod()), 1e-4);
}

TEST(FreeMotionsUnclear, WhereHardlyAnythingStopsThem)
{
  const auto is_unclear = [](double height)
  {
    const mesh::Mesh<2> mesh(mapped<2>(block<2>({2, 2}),
                                       [&](const Point<2>& x) -> Point<2> {
                                         return {x[0], height * x[1]};
                                       }));
    const ProblemData<2> data{.boundaries = {fixed<2>("left", 0.0, free)}};
    return certify::FreeMotions<2>(data.on(mesh), mesh).is_unclear();
  };
  EXPECT_FALSE(is_unclear(1e-3));
  EXPECT_TRUE(is_unclear(1e-6));
}

/// A wave of tractions, in part inside, in part outside of what laws allow.
template <int dim>
std::vector<Point<dim>> wave(const contact::NitscheForm<dim>& form, double phase)
{
  std::vector<Point<dim>> t;
  for (const contact::ContactPoint<dim>& point : form.contact_points())
    t.push_back(Point<dim>::NullaryExpr(
        [&](Eigen::Index a) {
          return 0.2 * std::sin(5 * point.x[0] + 3 * point.x[dim - 1] + 2.0 * static_cast<double>(a) + phase);
        }));
  return t;
}

/// Without conditions, pressed down and pushed along the floor.
template <int dim>
ProblemData<dim> resting(const problem::ContactLaw& law)
{
  return {
      .boundaries = {obstacle<dim>("bottom", law), loaded<dim>("top", 0.01, formula("-0.1 - 0.02*x"), 0.01)}};
}

template <class Dimension>
class BalancedTraction : public ::testing::Test
{
};
TYPED_TEST_SUITE(BalancedTraction, Dimensions);

template <int dim, class Check>
void for_all_laws(const Check& check)
{
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Tresca(0.08)), problem::ContactLaw(Coulomb(0.4))})
    for (int p = 1; p <= 3; ++p)
    {
      SCOPED_TRACE(p);
      check(DiscreteProblem<dim>(block<dim>({5, 2}, {3, 1, 2}), resting<dim>(law), {.degree = p}));
    }
}

/// tangent() against difference quotients.
template <int dim>
void expect_tangent(const DiscreteProblem<dim>& c)
{
  using Columns = typename certify::TractionFit<dim>::Columns;
  const certify::TractionFit<dim> fit(c.form);
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    std::vector<Columns> z(3, Columns(dim, c.form.n_segment_points()));
    for (int q = 0; q < c.form.n_segment_points(); ++q)
    {
      const Point<dim>& x = c.form.contact_points(k)[q].x;
      z[0].col(q) = x;
      z[1].col(q) = Point<dim>::Ones();
      z[2].col(q) = x.reverse();
    }
    const auto cones = fit.cones(k);
    const Columns t = fit.columns(k, wave<dim>(c.form, 0.1));
    const Eigen::MatrixXd tangent = fit.tangent(t, cones, z);
    constexpr double h = 1e-6;
    for (int i = 0; i < 3; ++i)
    {
      const Columns change = (fit(t + h * z[i], cones) - fit(t - h * z[i], cones)) / (2 * h);
      const Columns there = change * fit.at_points().transpose();
      for (int j = 0; j < 3; ++j)
      {
        double product = 0;
        for (int q = 0; q < there.cols(); ++q)
          product += c.form.facet_rule().weights[q] * there.col(q).dot(z[j].col(q));
        EXPECT_NEAR(tangent(i, j), product, 1e-5);
      }
    }
  }
}

TYPED_TEST(BalancedTraction, FollowsWhatItIsFittedTo)
{
  constexpr int dim = TypeParam::value;
  for_all_laws<dim>([](const auto& c) { expect_tangent(c); });
}

/// The residual of u = 0 with t as functions on the nodes.
template <int dim>
void expect_balance(const DiscreteProblem<dim>& c, std::span<const Point<dim>> t)
{
  std::vector<double> forces(c.form.load().begin(), c.form.load().end());
  c.form.add_contact_load(t, forces);
  const std::vector<Point<dim>> points = c.space.node_points();
  Tensor<dim> moments = Tensor<dim>::Zero();
  Point<dim> sum = Point<dim>::Zero();
  for (std::size_t node = 0; node < points.size(); ++node)
  {
    const Point<dim> force(&forces[dim * node]);
    sum += force;
    moments += force * points[node].transpose();
  }
  EXPECT_LE(sum.norm(), 1e-13);
  EXPECT_LE((moments - moments.transpose()).norm(), 1e-13);
}

TYPED_TEST(BalancedTraction, BalancesObeysAndIsTheNearest)
{
  constexpr int dim = TypeParam::value;
  for_all_laws<dim>(
      [&](const DiscreteProblem<dim>& c)
      {
        const certify::FreeMotions<dim> motions(c.problem, c.mesh);
        std::vector<std::vector<Point<dim>>> given;
        std::vector<std::vector<Point<dim>>> found;
        for (int trial = 0; trial < 4; ++trial)
        {
          given.push_back(wave<dim>(c.form, trial));
          const auto t_h = certify::balanced_traction<dim>(c.form, motions, given.back());
          ASSERT_TRUE(t_h.has_value()) << trial;
          found.push_back(t_h->at_points);
          expect_balance<dim>(c, found.back());
          for (std::size_t i = 0; i < c.form.n_contact_points(); ++i)
          {
            const contact::ContactPoint<dim>& point = c.form.contact_points()[i];
            const double n = found.back()[i].dot(point.normal);
            const double limit = point.strength > 0 ? point.strength : -0.4 * n;
            EXPECT_LE(n, 1e-14);
            EXPECT_LE((found.back()[i] - n * point.normal).norm(), limit + 1e-13);
          }
        }
        // (t - t_h, s - t_h)_C <= 0 for all that obey the law and balance the loads
        for (std::size_t a = 0; a < found.size(); ++a)
          for (const std::vector<Point<dim>>& other : found)
          {
            double product = 0;
            for (std::size_t i = 0; i < c.form.n_contact_points(); ++i)
              product +=
                  c.form.contact_points()[i].weight * (given[a][i] - found[a][i]).dot(other[i] - found[a][i]);
            EXPECT_LE(product, 1e-10);
          }
      });
}

TYPED_TEST(BalancedTraction, IsAbsentWhereNoneHoldsTheBody)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c(
      block<dim>({5, 2}, {3, 1, 2}),
      {.boundaries = {obstacle<dim>("bottom", Coulomb(0.4)), loaded<dim>("top", 0, 0.1)}}, {.degree = 2});
  const certify::FreeMotions<dim> motions(c.problem, c.mesh);
  EXPECT_FALSE(certify::balanced_traction<dim>(c.form, motions, wave<dim>(c.form, 0)).has_value());
}

}  // namespace balanced_traction_test_cases

}  // namespace tribound::test
