/// @file energy_directions_test.cpp
/// The bound of the energy-norm error where directions of contact vary along facets: above the distance from
/// much richer solutions, to which only quadratic interpolation of the direction is missing.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "support/earlier_slip.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/energy/contact_frames.h"
#include "verification/arched_block.h"
#include "verification/energy_effectivity.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

/// Without Coulomb's law, whose bound is for another problem than the reference.
const std::vector<problem::ContactLaw>& fixed_laws()
{
  static const std::vector<problem::ContactLaw> all = {Frictionless(), Tresca(0.004)};
  return all;
}

template <int dim>
void expect_bound(const DiscreteProblem<dim>& c, const std::string& name, int refinements)
{
  const std::vector<double> u = c.solve().u;
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u);
  const RicherReference<dim> reference(c, {.refinements = refinements, .degree = c.space.degree() + 1});
  const double found = effectivity<dim>(reference, u, bound);
  fmt::print("{}: {:.3f}; bound {:.3e}, ||c|| {:.1e}, G_c {:.1e}, transfer {:.1e}, directions {:.1e}\n", name,
             found, bound.bound, bound.correction, bound.contact, bound.transfer, bound.direction_remainder);
  EXPECT_GT(bound.direction_remainder, 0);
  EXPECT_GE(found, 1) << name;
  EXPECT_LE(found, dim == 2 ? 2.2 : 3.5) << name;
}

TEST(EnergyDirections, ObstaclesHaveABound)
{
  const auto all = obstacles(2);
  for (const int p : {1, 2, 3})
    for (std::size_t i = 1; i < all.size(); ++i)
      for (const problem::ContactLaw& law : fixed_laws())
        expect_bound<2>({arched_block<2>(6),
                         pressed_on<2>(contact_with(all[i].second, law, 2)),
                         {.degree = p, .newton = {.tolerance = 1e-12}}},
                        fmt::format("{}, p = {}, {}", all[i].first, p, problem::name(law)), 2);
  for (const problem::ContactLaw& law : fixed_laws())
    expect_bound<3>({arched_block<3>(3),
                     pressed_on<3>(contact_with(obstacles(3)[1].second, law, 3)),
                     {.degree = 1, .newton = {.tolerance = 1e-12}}},
                    fmt::format("punch in 3D, {}", problem::name(law)), 2);
}

TEST(EnergyDirections, PairsHaveABound)
{
  for (const problem::ContactLaw& law : fixed_laws())
  {
    for (const int p : {1, 2, 3})
    {
      auto [data, problem] = pair_on_arc<2>(5, law);
      expect_bound<2>({std::move(data), problem, {.degree = p, .newton = {.tolerance = 1e-12}}},
                      fmt::format("pair, p = {}, {}", p, problem::name(law)), 2);
    }
    auto [data, problem] = pair_on_arc<3>(3, law);
    expect_bound<3>({std::move(data), problem, {.degree = 1, .newton = {.tolerance = 1e-12}}},
                    fmt::format("pair in 3D, {}", problem::name(law)), 2);
  }
}

/// A block, pressed down and sideways on a random round obstacle.
template <int dim>
ProblemData<dim> random_block(unsigned seed)
{
  std::mt19937 random(seed);
  const auto between = [&](double low, double high)
  { return std::uniform_real_distribution<double>(low, high)(random); };
  const double r = between(0.4, 2);
  const Point<dim> centre =
      between(-0.2, 0.2) * Point<dim>::Unit(0) - (r + between(0, 0.01)) * Point<dim>::Unit(1);
  const std::vector<double> x(centre.data(), centre.data() + dim);
  const problem::Surface punch =
      dim == 2 ? problem::sphere(x, r, problem::Positive::outside)
               : problem::cylinder(x, point({0, 0, 1}, 3), r, problem::Positive::outside);
  const problem::ContactLaw law =
      seed % 2 == 0 ? problem::ContactLaw(Frictionless()) : problem::ContactLaw(Tresca(between(0.001, 0.02)));
  ProblemData<dim> data = pressed_on<dim>(contact_with(punch, law, dim));
  data.boundaries[0] = fixed<dim>("top", between(-0.02, 0.02), -between(0.005, 0.03));
  data.boundaries.push_back(loaded<dim>("right", between(-0.05, 0.05), between(-0.05, 0.05)));
  data.material = lame(1, between(-0.2, 0.45));
  return data;
}

template <int dim>
void expect_that_none_fails(unsigned n)
{
  std::vector<double> found;
  for (unsigned seed = 0; seed < n_cases(n); ++seed)
  {
    const ProblemData<dim> data = random_block<dim>(seed);
    const int p = 1 + static_cast<int>(seed / 2 % (dim == 2 ? 3 : 2));
    const DiscreteProblem<dim> c(arched_block<dim>(3 + static_cast<int>(seed % 4)), data,
                                 {.degree = p, .newton = {.tolerance = 1e-12}});
    const std::vector<double> u = c.solve().u;
    const Asked<dim> asked(true);
    const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u, asked.quantities);
    ASSERT_EQ(bound.reason, "") << seed;
    const DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, 2).mesh), data,
                                    {.degree = p + 1, .newton = {.tolerance = 1e-11}});
    const std::vector<double> truth = rich.solve().u;
    found.push_back(bound.bound / RicherReference<dim>(c, {.refinements = 2, .degree = p + 1}).distance(u));
    EXPECT_GE(found.back(), 1) << seed;
    for (std::size_t i = 0; i < asked.values.size(); ++i)
      expect_contains(bound.quantities[i], asked.values[i](rich, truth), fmt::format(", seed {}", seed));
  }
  std::ranges::sort(found);
  fmt::print("{}D: effectivity {:.2f} to {:.2f}, median {:.2f}\n", dim, found.front(), found.back(),
             found[found.size() / 2]);
}

TEST(EnergyDirections, NoBoundOrIntervalFails)
{
  expect_that_none_fails<2>(10);
  expect_that_none_fails<3>(1);
}

/// Friction that counts from an earlier slip is not turned.
TEST(EnergyDirections, NoBoundAfterSlip)
{
  DiscreteProblem<2> c(arched_block<2>(3),
                       pressed_on<2>(contact_with(obstacles(2)[1].second, Tresca(0.1), 2)), {.degree = 1});
  set_random_slip<2>(c.form, 1, true);
  EXPECT_EQ(adapt::energy_bound<2>(c.form, c.method, c.solve().u).reason,
            "a direction of contact varies along facets that may have slipped in earlier load steps");
}

/// M is nearly a rotation, takes N_0 nearly to N, and is the better the smaller the facets are.
TEST(EnergyDirections, FramesApproximateRotations)
{
  std::vector<double> remainders;
  for (const int n : {3, 6})
  {
    const DiscreteProblem<3> c(arched_block<3>(n),
                               pressed_on<3>(contact_with(obstacles(3)[1].second, Frictionless(), 3)),
                               {.degree = 2});
    const certify::ContactFrames<3> frames(c.form);
    remainders.push_back(frames.remainder());
    for (std::size_t k = 0; k < c.form.segments().size(); ++k)
    {
      ASSERT_TRUE(frames.turns(k));
      for (int q = 0; q < c.form.n_segment_points(); ++q)
      {
        const Tensor<3> m = frames.at_point(k, q);
        EXPECT_LE((m.transpose() * m - Tensor<3>::Identity()).norm(), 10 * remainders.back() + 1e-12);
        EXPECT_LE((m - frames.at(k, c.form.facet_rule().points[q])).norm(), 1e-14);
      }
    }
  }
  EXPECT_GT(remainders[0], 6 * remainders[1]);
}

}  // namespace

}  // namespace tribound::test
