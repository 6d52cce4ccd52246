/// @file quantity_random_test.cpp
/// Intervals of numbers of random problems hold those of much richer solutions, at every iterate.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "support/meshes.h"
#include "tribound/certify/energy/admissible_traction.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/refine.h"
#include "verification/quantities.h"

namespace tribound::test
{

namespace
{

/// A block of random material, shape, mesh and loads on an obstacle with a gap, held at its left or its upper
/// side, there sometimes moved.
template <int dim>
struct RandomCase
{
  std::mt19937 random;
  bool is_held_above = false;
  double between(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  bool happens(unsigned once_in) { return random() % once_in == 0; }

  ProblemData<dim> data()
  {
    const std::array<double, 5> ratios = {-0.3, 0, 0.3, 0.45, 0.49};
    is_held_above = happens(2);
    const std::string held = is_held_above ? "top" : "left";
    const double moved = happens(3) ? between(is_held_above ? -0.05 : 0, 0.05) : 0;
    const problem::ContactLaw law =
        happens(3) ? problem::ContactLaw(Frictionless()) : problem::ContactLaw(Tresca(between(0.001, 0.1)));
    const problem::Field gap =
        happens(2) ? problem::Field(0.0) : formula(fmt::format("{}*x", between(0, 0.01)));
    // in 3D projected loads would have another solution
    const std::string load = fmt::format(fmt::runtime(dim == 2 ? "{}*x^2*y" : "{}*x"), between(-0.3, 0.1));
    ProblemData<dim> data{
        .boundaries = {fixed<dim>(held, 0.5 * moved, moved), obstacle<dim>("bottom", law, gap),
                       loaded<dim>(is_held_above ? "left" : "top", between(-0.05, 0.05), between(-0.2, 0.01),
                                   between(-0.05, 0.05)),
                       loaded<dim>("right", between(-0.1, 0.1), between(-0.1, 0.1))},
        .body_force = components<dim, problem::Field>(formula(fmt::format("{}", between(-0.1, 0.1))),
                                                      formula(load), 0.0)};
    data.material = problem::lame(1, ratios[random() % ratios.size()]);
    return data;
  }

  mesh::MeshData<dim> mesh()
  {
    const double phase = between(0, 6);
    const double height = between(0.4, 2);
    const auto map = [&](const Point<dim>& x) -> Point<dim>
    {
      Point<dim> y = x;
      for (int a = 0; a < dim; ++a)
        y[a] += 0.1 * std::sin(std::numbers::pi * x[a] / (a == 0 ? 2 : 1)) *
                std::cos(2 * x[(a + 1) % dim] + a + phase);
      y[1] *= height;
      return y;
    };
    const int n = 3 + static_cast<int>(random() % 3);
    return renumbered(mapped<dim>(block<dim>({n, 2}, {2, 1, 1}), map), 11);
  }
};

/// The resultant of T(u) on the bottom with the weight min(1, x/2), or 1.
template <int dim>
double force_on_bottom(const DiscreteProblem<dim>& c, std::span<const double> u, const Point<dim>& direction,
                       bool is_weighted)
{
  const std::vector<Point<dim>> t = c.form.traction(u);
  double sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
  {
    const contact::ContactPoint<dim>& point = c.form.contact_points()[i];
    sum += point.weight * t[i].dot(direction) * (is_weighted ? point.x[0] / 2 : 1);
  }
  return sum;
}

/// The mean of u . direction over a boundary.
template <int dim>
double mean_over(const DiscreteProblem<dim>& c, std::span<const double> u, const std::string& name,
                 const Point<dim>& direction)
{
  double sum = 0;
  double measure = 0;
  for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
  {
    if (facet.tag < 0 || c.mesh.boundary_names()[facet.tag] != name) continue;
    const auto table =
        c.space.basis().tabulate(fem::points_on_facet<dim>(facet.local, c.form.facet_rule().points));
    for (const auto& [q, x, dx] : fem::facet_points(c.mesh, facet.cell, facet.local, c.form.facet_rule()))
    {
      sum += dx * direction.dot(fem::value_at<dim>(c.space.cell_nodes(facet.cell), u, table.values_at(q)));
      measure += dx;
    }
  }
  return sum / measure;
}

/// Quantities of a random block and their values for a discrete solution, by other code.
template <int dim>
struct Asked
{
  Quantities<dim> quantities;
  std::vector<std::function<double(const DiscreteProblem<dim>&, std::span<const double>)>> values;

  explicit Asked(bool is_held_above)
  {
    using U = std::span<const double>;
    using C = DiscreteProblem<dim>;
    quantities.push_back({.name = "energy"});
    values.push_back([](const C& c, U u)
                     { return contact::stress_norms<dim>(c.problem, c.space, u).energy; });
    quantities.push_back({.name = "work", .kind = QuantityKind::load_work});
    values.push_back([](const C& c, U u) { return c.space.dot(c.form.load(), u); });
    for (const Point<dim>& e : {Point<dim>(Point<dim>::Unit(1)), Point<dim>(Point<dim>::Unit(0))})
    {
      quantities.push_back(contact_force<dim>("bottom", e, is_held_above ? 0 : 2));
      values.push_back([=](const C& c, U u) { return force_on_bottom<dim>(c, u, e, !is_held_above); });
    }
    for (const char* const name : {"right", "bottom"})
    {
      const Point<dim> e = Point<dim>::Ones().normalized();
      quantities.push_back(mean_displacement<dim>(name, e));
      values.push_back([=](const C& c, U u) { return mean_over<dim>(c, u, name, e); });
    }
    if (!is_held_above) return;
    Quantity<dim> moment{.name = "moment", .kind = QuantityKind::contact_moment, .boundary = "bottom"};
    moment.point = Point<dim>(2.5 * Point<dim>::Unit(0));
    moment.direction = Point<dim>(Point<dim>::Unit(dim - 1));
    quantities.push_back(moment);
    values.push_back(
        [](const C& c, U u)
        {
          const std::vector<Point<dim>> t = c.form.traction(u);
          double sum = 0;
          for (std::size_t i = 0; i < t.size(); ++i)
          {
            const auto& point = c.form.contact_points()[i];
            sum += point.weight * ((point.x[0] - 2.5) * t[i][1] - point.x[1] * t[i][0]);
          }
          return sum;
        });
  }
};

/// How much wider intervals are than they have to be, by name: half the width over the distance of u_h.
struct Widths
{
  std::map<std::string, std::vector<double>> ratios;
  std::map<std::string, double> largest_share;  ///< of half the width between centre and truth
  int n_narrow_failures = 0;                    ///< of intervals a tenth as wide
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

/// Every interval of every iterate holds what a much richer solution has.
template <int dim>
void try_random_block(unsigned seed, int p, Widths& widths)
{
  RandomCase<dim> block_of{std::mt19937(seed)};
  const ProblemData<dim> data = block_of.data();
  DiscreteProblem<dim> c(block_of.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-11}});
  const int refinements = dim == 2 ? 2 : 1;
  const DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, refinements).mesh), data,
                                  {.degree = std::min(p + 1, 4), .newton = {.tolerance = 1e-11}});
  const solve::NewtonResult<dim> truth = rich.solve();
  const Asked<dim> asked(block_of.is_held_above);
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
    const EnergyBound bound = estimator(u);
    ASSERT_EQ(bound.reason, "");
    for (std::size_t i = 0; i < asked.values.size(); ++i)
    {
      const double value = asked.values[i](rich, truth.u);
      expect_contains(bound.quantities[i], value, fmt::format(", seed {}", seed));
      EXPECT_NEAR(bound.quantities[i].value, asked.values[i](c, u), 1e-12) << bound.quantities[i].name;
      widths.add(bound.quantities[i], value);
    }
  }
}

/// TRIBOUND_RANDOM_CASES times as many where that is set.
unsigned n_cases(unsigned n)
{
  const char* const factor = std::getenv("TRIBOUND_RANDOM_CASES");
  return factor == nullptr ? n : n * static_cast<unsigned>(std::atoi(factor));
}

TEST(QuantityRandom, NoIntervalFails)
{
  Widths widths;
  for (unsigned seed = 0; seed < n_cases(60); ++seed)
    try_random_block<2>(seed, 1 + static_cast<int>(seed % 4), widths);
  widths.print();
  EXPECT_GE(widths.n_narrow_failures, 20);
}

/// The solution w of Tresca's problem with the threshold -mu_F t_h^n, which the bottom has along x.
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
    try_random_block<3>(seed, 1 + static_cast<int>(seed % 2), widths);
  widths.print();
}

}  // namespace

}  // namespace tribound::test
