/// @file admissible_displacement_test.cpp
/// Admissible displacements at points of the boundary, by their values there.

#include "tribound/certify/energy/admissible_displacement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include "support/dimensions.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

/// u_D where that is prescribed, else a wave and noise: closed, open, sticking and slipping facets.
template <int dim>
std::vector<double> some_displacement(const DiscreteProblem<dim>& p, double size, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  std::uniform_real_distribution<double> phase(0, 6);
  const double shift = phase(random);
  std::vector<double> u;
  for (const Point<dim>& x : p.space.node_points())
    for (int a = 0; a < dim; ++a)
      u.push_back(size * (std::sin(4 * x[0] + 2 * x[dim - 1] + a + shift) + noise(random)));
  for (std::size_t i = 0; i < u.size(); ++i)
    if (p.form.constraints().fixed[i]) u[i] = p.form.constraints().values[i];
  return u;
}

template <int dim>
Point<dim - 1> random_point(std::mt19937& random)
{
  std::uniform_real_distribution<double> weight(0, 1);
  Point<dim - 1> s = Point<dim - 1>::NullaryExpr([&] { return weight(random); });
  if (s.sum() > 1) s = Point<dim - 1>::Ones() - s;
  return s;
}

/// visit(i, segment, v, g_h, x) at the points of facet k, with g_h from the values of g at the nodes.
template <int dim, class Visit>
void at_points(const DiscreteProblem<dim>& p, std::span<const double> v, std::size_t k,
               std::span<const Point<dim - 1>> on_facet, const Visit& visit)
{
  const contact::ContactSegment<dim>& segment = p.form.segments()[k];
  const auto [cell, local, tag] = segment.slave.facet;
  const mesh::CellMap<dim> map = mesh::cell_map(p.mesh, cell);
  const std::span<const Index> nodes = p.space.cell_nodes(cell);
  std::vector<Point<dim>> points;
  for (const Point<dim - 1>& s : on_facet) points.push_back(mesh::facet_to_cell<dim>(local, s));
  const fem::Tabulation<dim> table = p.space.basis().tabulate(points);
  for (int i = 0; i < table.n_points; ++i)
  {
    Point<dim> value = Point<dim>::Zero();
    double gap = 0;
    for (std::size_t j = 0; j < nodes.size(); ++j)
    {
      if (p.space.basis().node(static_cast<int>(j))[local] > 0) continue;
      const double phi = table.values_at(i)[j];
      for (int a = 0; a < dim; ++a) value[a] += phi * v[dim * nodes[j] + a];
      gap += phi * (*segment.contact->gap)(map(p.space.basis().node_point(static_cast<int>(j))));
    }
    visit(i, segment, value, gap, map(points[i]));
  }
}

/// visit(segment, v, g_h, x) at n random points.
template <int dim, class Visit>
void at_random_points(const DiscreteProblem<dim>& p, std::span<const double> v, std::size_t k, int n,
                      std::mt19937& random, const Visit& visit)
{
  std::vector<Point<dim - 1>> points;
  for (int i = 0; i < n; ++i) points.push_back(random_point<dim>(random));
  at_points<dim>(p, v, k, points,
                 [&](int, const auto& segment, const Point<dim>& value, double gap, const Point<dim>& x)
                 { visit(segment, value, gap, x); });
}

/// Nothing has moved off Gamma_C or where it is fixed, and v^n <= g_h at many points.
template <int dim>
void expect_admissible(const DiscreteProblem<dim>& p, std::span<const double> u, std::span<const double> v)
{
  std::set<Index> on_contact;
  for (const contact::ContactSegment<dim>& segment : p.form.segments())
  {
    const auto [cell, local, tag] = segment.slave.facet;
    for (int i = 0; i < p.space.basis().n_nodes(); ++i)
      if (p.space.basis().node(i)[local] == 0) on_contact.insert(p.space.cell_nodes(cell)[i]);
  }
  ASSERT_EQ(v.size(), u.size());
  double size = 0;
  for (Index node = 0; node < p.space.n_nodes(); ++node)
    for (int a = 0; a < dim; ++a)
    {
      const Index i = dim * node + a;
      size = std::max(size, std::abs(u[i]));
      if (!on_contact.contains(node))
      {
        EXPECT_EQ(v[i], u[i]);
      }
      if (p.form.constraints().fixed[i])
      {
        EXPECT_EQ(v[i], p.form.constraints().values[i]);
      }
    }
  std::mt19937 random(5);
  const int n = 1 + 4000 / static_cast<int>(p.form.segments().size());
  for (std::size_t k = 0; k < p.form.segments().size(); ++k)
    at_random_points<dim>(p, v, k, n, random,
                          [&](const auto& segment, const Point<dim>& value, double gap, const Point<dim>&)
                          { EXPECT_LE(segment.normal.dot(value) - gap, 2e-14 * size); });
}

template <class T>
class AdmissibleDisplacement : public ::testing::Test
{
 protected:
  static constexpr int dim = T::value;

  static mesh::MeshData<dim> block_data() { return block<dim>({8, 4}, {3, 2, 2}); }
  static ProblemData<dim> held_on_floor(problem::ContactLaw law, problem::Field gap)
  {
    return {.boundaries = {clamped<dim>("left"), obstacle<dim>("bottom", std::move(law), std::move(gap))}};
  }
  /// Both displacements from random ones, which are admissible.
  static void expect_both(const DiscreteProblem<dim>& p, double size)
  {
    for (unsigned seed = 0; seed < 3; ++seed)
    {
      SCOPED_TRACE(seed);
      const std::vector<double> u = some_displacement<dim>(p, size, seed);
      const auto result = certify::admissible_displacements<dim>(p.form, u, p.form.traction(u));
      EXPECT_EQ(result.reason, "");
      ASSERT_TRUE(result.open) << result.excess_open;
      ASSERT_TRUE(result.closed) << result.excess_closed;
      expect_admissible<dim>(p, u, *result.open);
      expect_admissible<dim>(p, u, *result.closed);
    }
  }
};
TYPED_TEST_SUITE(AdmissibleDisplacement, Dimensions);

/// Facets that T(u) says are closed have v^n = g, those that stick v^t = 0, whatever the others are.
TYPED_TEST(AdmissibleDisplacement, MeetsWhatFacetsWant)
{
  constexpr int dim = TestFixture::dim;
  int n_closed = 0;
  int n_sticking = 0;
  for (int degree = 1; degree <= 4; ++degree)
    for (const problem::ContactLaw& law :
         {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.5)),
          problem::ContactLaw(Coulomb(0.6))})
    {
      SCOPED_TRACE(degree);
      const DiscreteProblem<dim> p(TestFixture::block_data(), TestFixture::held_on_floor(law, 0.01),
                                   {.degree = degree});
      TestFixture::expect_both(p, 0.03);
      std::vector<double> u = some_displacement<dim>(p, 0.01, 3);
      const std::vector<Point<dim>> nodes = p.space.node_points();
      for (Index node = 0; node < p.space.n_nodes(); ++node)
        if (nodes[node][0] > 0.6 && nodes[node][1] < 1e-9)
          for (int a = 0; a < dim; ++a) u[dim * node + a] = a == 1 ? -0.02 * nodes[node][0] : 1e-4;
      const std::vector<Point<dim>> t = p.form.traction(u);
      const auto result = certify::admissible_displacements<dim>(p.form, u, t);
      const int n = p.form.n_segment_points();
      std::mt19937 random(1);
      for (std::size_t k = 0; k < p.form.segments().size(); ++k)
      {
        int closed = 0;
        int sticking = 0;
        for (int q = 0; q < n; ++q)
        {
          const Point<dim>& normal = p.form.segments()[k].normal;
          const double along = t[k * n + q].dot(normal);
          const double across = (t[k * n + q] - along * normal).norm();
          const double limit = law.index() == 1 ? 0.5 : -0.6 * std::min(along, 0.0);
          closed += along < -1e-10 * t[k * n + q].norm() ? 1 : 0;
          sticking += law.index() > 0 && across < (1 - 1e-10) * limit ? 1 : 0;
        }
        for (const bool transition_is_closed : {false, true})
        {
          const std::vector<double>& v = transition_is_closed ? *result.closed : *result.open;
          const int least = transition_is_closed ? 1 : n;
          at_random_points<dim>(
              p, v, k, 20, random,
              [&](const auto& segment, const Point<dim>& value, double gap, const Point<dim>& x)
              {
                if (x[0] < 0.7) return;  // beside what is clamped
                const double along = segment.normal.dot(value);
                n_closed += closed >= least;
                n_sticking += sticking >= least;
                if (closed >= least)
                {
                  EXPECT_NEAR(along, gap, 1e-14 * 0.1);
                }
                if (sticking >= least)
                {
                  EXPECT_LE((value - along * segment.normal).norm(), 1e-14 * 0.1);
                }
              });
        }
      }
    }
  EXPECT_GT(n_closed, 1000);
  EXPECT_GT(n_sticking, 1000);
}

TYPED_TEST(AdmissibleDisplacement, IsSoForItsInterpolatedGap)
{
  constexpr int dim = TestFixture::dim;
  for (int degree = 1; degree <= 4; ++degree)
  {
    SCOPED_TRACE(degree);
    const DiscreteProblem<dim> p(TestFixture::block_data(),
                                 TestFixture::held_on_floor(Tresca(0.1), formula("0.01 + 0.02*(x - 0.7)^2")),
                                 {.degree = degree});
    TestFixture::expect_both(p, 0.05);
    const std::vector<double> u = some_displacement<dim>(p, 0.05, 8);
    const auto result = certify::admissible_displacements<dim>(p.form, u, p.form.traction(u));
    if (degree > 1)
    {
      EXPECT_LE(result.gap_remainder, 1e-16);
      continue;
    }
    const double h = dim == 2 ? 0.25 : 2.0 / 3;  // 0.02 s (h - s) at its largest, but at the points of a rule
    EXPECT_LE(result.gap_remainder, 0.02 * h * h / 4);
    EXPECT_GE(result.gap_remainder, 0.8 * 0.02 * h * h / 4);
  }
}

/// Normals that differ from facet to facet, corners of several obstacles, along with clamped sides.
TYPED_TEST(AdmissibleDisplacement, OnBentSidesAndInCorners)
{
  constexpr int dim = TestFixture::dim;
  for (int degree = 1; degree <= 4; ++degree)
  {
    SCOPED_TRACE(degree);
    ProblemData<dim> data = TestFixture::held_on_floor(Tresca(0.1), 0.01);
    data.boundaries.push_back(obstacle<dim>("right", Coulomb(0.3), 0.02));
    if constexpr (dim == 3) data.boundaries.push_back(obstacle<dim>("front", Frictionless(), 0.005));
    TestFixture::expect_both(DiscreteProblem<dim>(TestFixture::block_data(), data, {.degree = degree}), 0.03);
    TestFixture::expect_both(
        DiscreteProblem<dim>(distorted(TestFixture::block_data(), 3), data, {.degree = degree}), 0.03);
  }
}

/// A side that is prescribed in one direction beside obstacles inclined to it: control points move along the
/// free axes alone.
TYPED_TEST(AdmissibleDisplacement, KeepsWhatIsPrescribedBesideIt)
{
  constexpr int dim = TestFixture::dim;
  const auto turned = mapped(TestFixture::block_data(),
                             [](const Point<dim>& x) -> Point<dim> { return rotation<dim>() * x; });
  for (int degree = 1; degree <= 4; ++degree)
    for (const problem::Field& gap : {problem::Field(0.05), formula("0.05 + 0.01*x")})
    {
      SCOPED_TRACE(degree);
      const ProblemData<dim> data = {
          .boundaries = {fixed<dim>("left", formula("0.004 + 0.001*y^2"), free, free),
                         obstacle<dim>("bottom", Tresca(0.1), gap)}};
      TestFixture::expect_both(DiscreteProblem<dim>(turned, data, {.degree = degree}), 0.1);
      const ProblemData<dim> held = {
          .boundaries = {fixed<dim>("left", 0.0, 0.0, 0.0), obstacle<dim>("bottom", Tresca(0.1), gap)}};
      TestFixture::expect_both(DiscreteProblem<dim>(turned, held, {.degree = degree}), 0.1);
    }
}

/// u_D presses a corner into the obstacle: no displacement is admissible, and none is given.
TYPED_TEST(AdmissibleDisplacement, IsNotThereWhereNoneCanBe)
{
  constexpr int dim = TestFixture::dim;
  const ProblemData<dim> data = {
      .boundaries = {fixed<dim>("left", 0.0, -0.02), obstacle<dim>("bottom", Tresca(0.1), 0.01)}};
  const DiscreteProblem<dim> p(TestFixture::block_data(), data, {.degree = 2});
  const std::vector<double> u = some_displacement<dim>(p, 0.03, 1);
  const auto result = certify::admissible_displacements<dim>(p.form, u, p.form.traction(u));
  EXPECT_FALSE(result.open);
  EXPECT_FALSE(result.closed);
  EXPECT_NEAR(result.excess_open, 0.01, 1e-16);
  EXPECT_NEAR(result.excess_closed, 0.01, 1e-16);
}

/// A solution is hardly moved, and the two choices differ where facets are in transition alone.
TEST(AdmissibleDisplacementT2D, IsNearTheSolution)
{
  for (int degree = 1; degree <= 3; ++degree)
  {
    SCOPED_TRACE(degree);
    const DiscreteProblem<2> p(block<2>({16, 8}), pressed_block<2>(),
                               {.degree = degree, .newton = {.tolerance = 1e-12, .damping = false}});
    const auto [u, t] = [&]
    {
      const auto newton = p.solve();
      return std::pair(newton.u, p.form.traction(newton.u));
    }();
    const auto result = certify::admissible_displacements<2>(p.form, u, t);
    ASSERT_TRUE(result.open);
    ASSERT_TRUE(result.closed);
    EXPECT_TRUE(result.has_transition);
    expect_admissible<2>(p, u, *result.open);
    expect_admissible<2>(p, u, *result.closed);
    double size = 0;
    double moved = 0;
    std::size_t n_different = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      size = std::max(size, std::abs(u[i]));
      moved = std::max(moved, std::abs((*result.open)[i] - u[i]));
      n_different += (*result.open)[i] != (*result.closed)[i];
    }
    EXPECT_LE(moved, 0.02 * size);
    EXPECT_GT(moved, 0);
    EXPECT_GT(n_different, 0);
    EXPECT_LT(n_different, 20);
  }
}

/// -2 J(v), J(v) = a(v, v)/2 - L(v) + int_C s |v^t|, as an independent program has it for problem T2D.
TEST(AdmissibleDisplacementT2D, HasTheKnownEnergy)
{
  struct Known
  {
    int degree;
    int n;
    double energy;
  };
  for (const Known& known : {Known{2, 4, 0.0166344}, Known{2, 8, 0.0167476}, Known{3, 4, 0.0167460}})
  {
    const DiscreteProblem<2> p(block<2>({2 * known.n, known.n}), pressed_block<2>(),
                               {.degree = known.degree, .newton = {.tolerance = 1e-12, .damping = false}});
    const std::vector<double> u = p.solve().u;
    const auto result = certify::admissible_displacements<2>(p.form, u, p.form.traction(u));
    ASSERT_TRUE(result.open);
    const std::vector<double>& v = *result.open;
    double energy = -contact::stress_norms<2>(p.problem, p.space, v).energy;
    for (std::size_t i = 0; i < v.size(); ++i) energy += 2 * p.form.load()[i] * v[i];
    const fem::Quadrature<1> rule = fem::quadrature<1>(60);  // |v^t| has kinks
    for (std::size_t k = 0; k < p.form.segments().size(); ++k)
      at_points<2>(p, v, k, rule.points,
                   [&](int q, const auto& segment, const Point<2>& value, double, const Point<2>&)
                   { energy -= 2 * 0.03 * std::abs(value[0]) * segment.measure * rule.weights[q]; });
    EXPECT_NEAR(energy, known.energy, 1e-7);
  }
}

TEST(AdmissibleDisplacementReasons, AreGiven)
{
  const auto reason = [](const ProblemData<2>& data, mesh::MeshData<2> mesh)
  {
    const DiscreteProblem<2> p(std::move(mesh), data);
    const std::vector<double> u(p.space.n_dofs(), 0.0);
    const auto result = certify::admissible_displacements<2>(p.form, u, p.form.traction(u));
    EXPECT_FALSE(result.open || result.closed);
    return result.reason;
  };
  EXPECT_EQ(reason(pressed_block<2>(problem::JointLaw({.coefficient = 0.5}, 0.01)), block<2>({4, 2})),
            "a contact law has a threshold beside its friction coefficient");
  const ProblemData<2> bodies = {.boundaries = {clamped<2>("left"), clamped<2>("left below")},
                                 .pairs = {pair<2>("bottom", "top below", problem::Tied())}};
  EXPECT_EQ(reason(bodies, side_by_side(block<2>({4, 2}), box<2>({0, -1.1}, {2, -0.1}, {3, 2}), " below")),
            "meshes of tied bodies do not match");
}

}  // namespace

}  // namespace tribound::test
