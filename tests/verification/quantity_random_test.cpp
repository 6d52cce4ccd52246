/// @file quantity_random_test.cpp
/// Intervals of quantities of random problems contain the values of much richer solutions, at every iterate.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "support/earlier_slip.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/energy/admissible_traction.h"
#include "tribound/certify/energy/interval_comparison.h"
#include "tribound/mesh/refine.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

/// How much wider than necessary intervals are, by name: half the width over the distance of u_h.
struct Widths
{
  std::map<std::string, std::vector<double>> ratios;
  std::map<std::string, double> largest_share;  ///< of half the width between centre and truth
  int n_narrow_failures = 0;                    ///< with intervals a tenth as wide
  int n = 0;

  void add(const QuantityInterval& interval, double truth)
  {
    const double centre = (interval.lower + interval.upper) / 2;
    const double half = (interval.upper - interval.lower) / 2;
    ratios[interval.name].push_back(half / std::abs(interval.value - truth));
    double& share = largest_share[interval.name];
    share = std::max(share, std::abs(truth - centre) / half);
    n_narrow_failures += std::abs(truth - centre) > half / 10 ? 1 : 0;
    ++n;
  }
  void print()
  {
    for (auto& [name, values] : ratios)
    {
      std::ranges::sort(values);
      fmt::print(
          "{:<10} half the width / error of the value: {:.2f} to {:.1f}, median {:.1f}; truth within {:.2f} "
          "of it\n",
          name, values.front(), values.back(), values[values.size() / 2], largest_share[name]);
    }
    fmt::print("{} of {} fail at a tenth of the width\n", n_narrow_failures, n);
  }
};

/// Every interval of every iterate contains the value of a much richer solution. A third are load steps after
/// earlier slip.
template <int dim>
void try_random_block(unsigned seed, int p, bool is_on_another, Widths& widths)
{
  const bool is_cut = seed % 2 != 0;
  RandomCase<dim> block_of{std::mt19937(seed), is_on_another, !is_cut};
  const ProblemData<dim> data = block_of.data();
  DiscreteProblem<dim> c(block_of.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-11}});
  const bool has_slipped = seed % 3 == 2;
  if (has_slipped) set_random_slip<dim>(c.form, seed, dim == 2 || block_of.matches || !is_on_another);
  const int refinements = dim == 2 ? 2 : 1;
  DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, refinements).mesh), data,
                            {.degree = std::min(p + 1, 4), .newton = {.tolerance = 1e-11}});
  if (has_slipped) remember_as<dim>(c.form, rich.form);
  const solve::NewtonResult<dim> truth = rich.solve();
  const Asked<dim> asked(block_of.is_held_above, is_on_another);
  const EnergyEstimator<dim> estimator(c.form, c.method.solver, asked.quantities);
  std::vector<std::vector<double>> iterates;
  const auto keep = [&](const solve::NewtonIterate<dim>& iterate)
  {
    const std::span<const double> u = iterate.u();
    iterates.emplace_back(u.begin(), u.end());
    return solve::NewtonAdvice(false);
  };
  if (seed % 12 == 0)
    (void)c.solve(0, keep);
  else
    iterates.push_back(c.solve().u);
  for (const std::vector<double>& u : iterates)
  {
    // As in runs, with facets cut to make bodies match and where the state changes; and on the mesh itself.
    const EnergyBound bound = is_cut && (seed % 4 == 1 || !estimator.reason().empty())
                                  ? adapt::energy_bound<dim>(c.form, c.method, u, asked.quantities)
                                  : estimator(u);
    ASSERT_EQ(bound.reason, "");
    for (std::size_t i = 0; i < asked.values.size(); ++i)
    {
      const double value = asked.values[i](rich, truth.u);
      expect_contains(bound.quantities[i], value, fmt::format(", seed {}", seed));
      if (!is_cut)  // on cut facets tractions have other points
      {
        EXPECT_NEAR(bound.quantities[i].value, asked.values[i](c, u), 1e-12) << bound.quantities[i].name;
      }
      widths.add(bound.quantities[i], value);
    }
  }
}

TEST(QuantityRandom, NoIntervalFails)
{
  Widths widths;
  for (unsigned seed = 0; seed < n_cases(60); ++seed)
    try_random_block<2>(seed, 1 + static_cast<int>(seed % 4), false, widths);
  widths.print();
  EXPECT_GE(widths.n_narrow_failures, 20);
}

/// The vertical resultant of T(u) on the bottom with the weight min(1, d / ramp), where d is the distance
/// from its left end; evaluated at the vertices of the first mesh and linear between them.
double weighted_force(const DiscreteProblem<2>& c, std::span<const double> u, const mesh::Mesh<2>& first,
                      double ramp)
{
  std::vector<Point<2>> ends;
  for (const mesh::BoundaryFacet& facet : first.boundary())
    if (facet.tag >= 0 && first.boundary_names()[facet.tag] == "bottom")
      for (const Index v : mesh::facet_vertices(first.cell(facet.cell), facet.local))
        ends.push_back(first.vertex(v));
  std::ranges::sort(ends, {}, [](const Point<2>& x) { return x[0]; });
  const auto weight = [&](const Point<2>& x) { return std::min(1.0, (x - ends[0]).norm() / ramp); };
  const std::vector<Point<2>> t = c.form.traction(u);
  double sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
  {
    const contact::ContactPoint<2>& point = c.form.contact_points()[i];
    auto right = std::ranges::upper_bound(ends, point.x[0], {}, [](const Point<2>& x) { return x[0]; });
    const Point<2>& b = *right;
    const Point<2>& a = *(right - 1);
    const double s = (point.x - a).norm() / (b - a).norm();
    sum += point.weight * t[i][1] * ((1 - s) * weight(a) + s * weight(b));
  }
  return sum;
}

/// Forces next to fixed displacements are the same quantity on all meshes: the interval on a coarse mesh
/// contains the value on a finer mesh, whose interval is for the same number.
template <int dim>
void expect_one_number(unsigned seed, int p, bool is_on_another)
{
  RandomCase<dim> block_of{std::mt19937(seed), is_on_another, dim == 3 || seed % 2 == 0};
  const ProblemData<dim> data = block_of.data();
  if (block_of.is_held_above) return;
  constexpr double ramp = 0.2;  // shorter than facets
  const Quantities<dim> quantities = {contact_force<dim>("bottom", Point<dim>::Unit(1), ramp),
                                      contact_force<dim>("bottom", Point<dim>::Unit(0)),
                                      {.name = "moment",
                                       .kind = QuantityKind::contact_moment,
                                       .boundary = "bottom",
                                       .direction = Point<dim>::Unit(dim - 1),
                                       .point = Point<dim>::Unit(1)}};  // not the corner, which it leaves
  const DiscreteProblem<dim> c(block_of.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-11}});
  const DiscreteProblem<dim> fine(
      std::move(mesh::refine_uniformly(c.mesh, dim == 2 ? 2 : 1).mesh), data,
      {.degree = std::min(p + 1, dim == 2 ? 4 : 2), .newton = {.tolerance = 1e-11}});
  const std::vector<double> fine_u = fine.solve().u;
  const EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, c.solve().u, quantities);
  const EnergyBound of_fine = adapt::energy_bound<dim>(fine.form, fine.method, fine_u, quantities);
  ASSERT_EQ(bound.reason, "");
  ASSERT_EQ(of_fine.reason, "");
  for (std::size_t i = 0; i < quantities.size(); ++i)
  {
    const QuantityInterval& found = of_fine.quantities[i];
    expect_contains(bound.quantities[i], found.value, fmt::format(", {}D, seed {}", dim, seed));
    EXPECT_NE(found.note.find("linear on the facets of the first mesh"), std::string::npos) << found.note;
    EXPECT_EQ(certify::compare_intervals(bound, bound.quantities[i], of_fine, found).agree, true)
        << found.name << ", seed " << seed;
  }
  if constexpr (dim == 2)
    if (!is_on_another)
    {
      const auto on_mesh = intervals<2>(fine, {quantities[0]}, fine_u);
      EXPECT_NEAR(on_mesh[0].value, weighted_force(fine, fine_u, c.mesh, ramp), 1e-12) << "seed " << seed;
    }
}

TEST(QuantityRandom, ForcesBesideFixedDisplacementsAreOneNumberOnAllMeshes)
{
  expect_one_number<2>(9172, 1, false);
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
  {
    expect_one_number<2>(seed, 1 + static_cast<int>(seed % 3), false);
    expect_one_number<2>(seed, 1 + static_cast<int>(seed % 3), true);
  }
  for (unsigned seed = 0; seed < n_cases(3); ++seed)
    for (const bool is_on_another : {false, true}) expect_one_number<3>(seed, 1, is_on_another);
}

/// The solution w of Tresca's problem with the threshold -mu_F t_h^n, as a function of x on the bottom.
TEST(QuantityCoulomb, IntervalsHoldTheSolutionWithTheComputedThreshold)
{
  const DiscreteProblem<2> c(block<2>({4, 2}), pressed_block<2>(problem::ContactLaw(Coulomb(0.4))),
                             {.degree = 2, .newton = {.tolerance = 1e-11}});
  const std::vector<double> u = c.solve().u;
  const auto t_h = certify::admissible_traction<2>(c.form, c.form.traction(u));
  const auto threshold = [&](std::span<const double> x, int dim, std::span<double> values)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t k = 0; k < c.form.segments().size(); ++k)
      {
        const auto map = contact::simplex_map(c.mesh, c.form.segments()[k].slave);
        const double s = (x[dim * i] - map.origin[0]) / map.jacobian(0, 0);
        if (s < -1e-12 || s > 1 + 1e-12) continue;
        const fem::LagrangeBasis<1> basis(2);
        double sum = 0;
        for (int j = 0; j < basis.n_nodes(); ++j)
          sum += (basis.node(j)[0] == 1 ? 2 : 1) * std::pow(1 - s, basis.node(j)[0]) *
                 std::pow(s, basis.node(j)[1]) * t_h.thresholds[k * basis.n_nodes() + j];
        values[i] = std::max(0.0, sum);
      }
  };
  const problem::Field field(problem::FieldFunction{.values = threshold});
  const DiscreteProblem<2> rich(std::move(mesh::refine_uniformly(c.mesh, 3).mesh),
                                pressed_block<2>(problem::ContactLaw(Tresca(field))),
                                {.degree = 3, .newton = {.tolerance = 1e-10}});
  const std::vector<double> truth = rich.solve().u;
  const Asked<2> asked(false);
  const auto found = intervals<2>(c, asked.quantities, u);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    expect_contains(found[i], asked.values[i](rich, truth));
    EXPECT_NE(found[i].note.find("of the computed friction threshold"), std::string::npos);
  }
  const Quantity<2> factor{
      .name = "sliding", .kind = QuantityKind::safety_factor, .boundary = "bottom", .ramp = 2};
  const QuantityInterval sliding = intervals<2>(c, {factor}, u).front();
  expect_contains(sliding, -0.4 * force_on_bottom<2>(rich, truth, {0, -1}, true) /
                               std::abs(force_on_bottom<2>(rich, truth, {1, 0}, true)));
  fmt::print("Coulomb: sliding safety {:.3f} in [{:.3f}, {:.3f}]\n", sliding.value, sliding.lower,
             sliding.upper);
}

TEST(QuantityRandom, NoIntervalFails3D)
{
  Widths widths;
  for (unsigned seed = 0; seed < n_cases(8); ++seed)
    try_random_block<3>(seed, 1 + static_cast<int>(seed % 2), false, widths);
  widths.print();
}

TEST(QuantityRandom, NoIntervalFailsBetweenBodies)
{
  Widths widths;
  for (unsigned seed = 0; seed < n_cases(24); ++seed)
    try_random_block<2>(seed, 1 + static_cast<int>(seed % 4), true, widths);
  for (unsigned seed = 0; seed < n_cases(4); ++seed)
    try_random_block<3>(seed, 1 + static_cast<int>(seed % 2), true, widths);
  widths.print();
}

}  // namespace

}  // namespace tribound::test
