/// @file energy_steps_test.cpp
/// The bound of the energy-norm error in load steps, where friction counts from the slip of earlier ones:
/// above the distance from much richer solutions of the same step.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "support/bonded_path.h"
#include "support/earlier_slip.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/energy/admissible_traction.h"
#include "tribound/certify/energy/traction_fit.h"
#include "tribound/fem/evaluation.h"
#include "verification/energy_effectivity.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

/// A problem after a random slip.
template <int dim>
struct Slipped : DiscreteProblem<dim>
{
  Slipped(RandomCase<dim> random, const ProblemData<dim>& data, unsigned seed)
      : DiscreteProblem<dim>(
            random.mesh(), data,
            {.degree = 1 + static_cast<int>(seed % (dim == 2 ? 3 : 2)), .newton = {.tolerance = 1e-11}})
  {
    set_random_slip<dim>(this->form, seed, dim == 2 || random.matches);
  }
};

template <int dim>
Slipped<dim> random_step(unsigned seed)
{
  RandomCase<dim> random{std::mt19937(seed), seed % 2 == 0, seed % 4 != 0};
  ProblemData<dim> data = random.data();
  if (!data.pairs.empty() && cone(data.pairs[0].contact.law).is_tied)
    data.pairs[0].contact.law = Tresca(0.05);
  return Slipped<dim>(std::move(random), data, seed);
}

TEST(EnergySteps, NoBoundAfterRandomSlipFails)
{
  expect_no_failure<2>("after slip, 2D", 40, random_step<2>);
  expect_no_failure<3>("after slip, 3D", 10, random_step<3>, 1);
}

/// A block that is pushed, released and pulled slips and sticks where it has slipped.
template <int dim>
void expect_bounds_along_path(const problem::ContactLaw& law, int degree, bool pairs, double largest)
{
  mesh::Mesh<dim> mesh(pairs ? matching_blocks<dim>() : block<dim>({8, 4}, {2, 1, 1}));
  ProblemData<dim> data{.boundaries = {loaded<dim>("top", 0, -0.1), clamped<dim>("left")}};
  std::array<problem::Field, dim> pull;
  pull[0] = formula("0.12*t");
  data.boundaries.push_back(problem::with_traction<dim>("right", pull));
  if (pairs)
  {
    data.boundaries.push_back(clamped<dim>("bottom_below"));
    data.pairs = {pair<dim>("bottom", "top_below", law)};
  }
  else
    data.boundaries.push_back(obstacle<dim>("bottom", law));
  const problem::Problem<dim> problem = data.on(mesh);
  adapt::Method method{.degree = degree, .newton = {.tolerance = 1e-12}};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  adapt::LoadPath<dim> path(problem, method, {}, std::move(mesh));
  path.ask_for({.levels = adapt::EnergyLevels::every});
  const auto check = [&](const adapt::LoadStep<dim>& step)
  {
    const contact::NitscheForm<dim>& form = step.at->discrete.form;
    ASSERT_TRUE(step.level.energy);
    const RicherReference<dim> reference(form, method,
                                         {.refinements = dim == 2 ? 3 : 2, .degree = degree + 1});
    const double found = effectivity<dim>(reference, step.level.u, *step.level.energy);
    fmt::print("{}D {} p = {}, t = {}: {:.3f}; bound {:.3e}, ||c|| {:.1e}, G_c {:.1e}\n", dim,
               pairs ? "pair" : "obstacle", degree, step.t, found, step.level.energy->bound,
               step.level.energy->correction, step.level.energy->contact);
    EXPECT_GE(found, 1) << step.t;
    EXPECT_LE(found, largest) << step.t;
  };
  for (const double t : {1.0, 0.3, -0.6, 0.2}) ASSERT_EQ(path.advance(t, check), "");
}

TEST(EnergySteps, HoldAlongAPath)
{
  for (const bool pairs : {false, true})
  {
    for (const int degree : {1, 2, 3}) expect_bounds_along_path<2>(Tresca(0.04), degree, pairs, 1.6);
    expect_bounds_along_path<3>(Tresca(0.04), 1, pairs, 2.5);
  }
}

/// What is integrated is t_h . (v - g n - w) + s |v^t - w|, with the polynomials that are remembered.
template <int dim>
void expect_gaps_of_slip(unsigned seed, int degree)
{
  ProblemData<dim> data{.boundaries = {clamped<dim>("left"), loaded<dim>("top", 0.03, -0.1, 0.02),
                                       obstacle<dim>("bottom", Tresca(0.03), 0.01)}};
  DiscreteProblem<dim> c(block<dim>({4, 2}, {2, 1, 1}), data, {.degree = degree});
  set_random_slip<dim>(c.form, seed, true);
  const std::vector<double> u = c.solve().u;
  const certify::AdmissibleTraction<dim> t_h = certify::admissible_traction<dim>(c.form, c.form.traction(u));
  const certify::ObstacleFacets<dim> facets(c.form);
  const certify::ContactGap<dim> gap(c.form, facets);
  std::vector<Point<dim - 1>> points;
  constexpr int n = dim == 2 ? 4000 : 160;  // midpoints of parts
  for (int i = 0; i < n; ++i)
    if constexpr (dim == 2)
      points.emplace_back((i + 0.5) / n);
    else
      for (int j = 0; j < 2 * (n - i) - 1; ++j)
        points.emplace_back((i + (j % 2 == 0 ? 1 : 2) / 3.0) / n, (j / 2 + (j % 2 == 0 ? 1 : 2) / 3.0) / n);
  const Eigen::MatrixXd basis = certify::bernstein_at<dim>(degree, points);
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = c.form.segments()[k];
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const auto table = c.space.basis().tabulate(fem::points_on_facet<dim>(facet.local, points));
    double sum = 0;
    for (std::size_t q = 0; q < points.size(); ++q)
    {
      Point<dim> t = Point<dim>::Zero();
      double s = 0;
      for (Eigen::Index j = 0; j < basis.cols(); ++j)
      {
        const auto row = static_cast<Eigen::Index>(q);
        t += basis(row, j) * t_h.coefficients[k * basis.cols() + j];
        s += basis(row, j) * t_h.thresholds[k * basis.cols() + j];
      }
      const Point<dim> v =
          fem::value_at<dim>(c.space.cell_nodes(facet.cell), u, table.values_at(static_cast<int>(q)));
      const Point<dim> slip = v - v.dot(segment.normal) * segment.normal -
                              c.form.history()->at(segment.contact->law, k, points[q]).slip;
      sum += (t.dot(segment.normal) * (v.dot(segment.normal) - 0.01) + t.dot(slip) + s * slip.norm()) *
             segment.measure / static_cast<double>(points.size());
    }
    const double found = gap(k, t_h, u);
    const double size = segment.measure * 0.03 * std::pow(10.0, -2);
    EXPECT_GE(found, sum - 1e-4 * size) << seed << k;
    EXPECT_LE(found, std::max(0.0, sum) + 0.01 * size + 0.02 * std::abs(sum)) << seed << k;
  }
}

TEST(EnergySteps, TheGapIsThatOfTheSlip)
{
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    expect_gaps_of_slip<2>(seed, 1 + static_cast<int>(seed % 4));
    expect_gaps_of_slip<3>(seed, 1 + static_cast<int>(seed % 3));
  }
}

}  // namespace

}  // namespace tribound::test
