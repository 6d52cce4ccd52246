/// @file quantity_test.cpp
/// Intervals of quantities of the solution, against an independent program, exact solutions and statics.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "support/meshes.h"
#include "support/two_blocks.h"
#include "tribound/adapt/mark.h"
#include "tribound/mesh/bisect.h"
#include "verification/affine.h"
#include "verification/quantities.h"

namespace tribound::test
{

namespace
{

/// T2D on nx x nx/2 squares: results of an independent program, whose tractions obey the law in another way;
/// radii of the resultants with the weight min(1, 2x), intervals of the energy.
struct ReferenceCase
{
  int p;
  int nx;
  double normal_radius;
  double tangential_radius;
  double energy_lower;
  double energy_upper;
};

class QuantityT2D : public ::testing::TestWithParam<ReferenceCase>
{
};

TEST_P(QuantityT2D, IsAsSharpAsThatOfAnIndependentProgram)
{
  const auto& [p, nx, normal, tangential, energy_lower, energy_upper] = GetParam();
  const DiscreteProblem<2> c(block<2>({nx, nx / 2}), pressed_block<2>(),
                             {.degree = p, .newton = {.tolerance = 1e-12, .damping = false}});
  const auto found = intervals<2>(c,
                                  {{.name = "energy"},
                                   contact_force<2>("bottom", {0, -1}, 0.5),
                                   contact_force<2>("bottom", {1, 0}, 0.5),
                                   mean_displacement<2>("right", {0, 1}),
                                   {.name = "work", .kind = QuantityKind::load_work}},
                                  c.solve().u);
  expect_contains(found[0], 0.016804338613842063);
  expect_contains(found[1], -0.096161343);
  expect_contains(found[2], -0.041322732);
  const auto is_weighted = [](const QuantityInterval& interval)
  { return interval.note.find("weighted") != std::string::npos; };
  EXPECT_EQ(std::ranges::count_if(found, is_weighted), 2);  // the forces, next to the clamped side
  const auto half_width = [](const QuantityInterval& interval)
  { return (interval.upper - interval.lower) / 2; };
  if (normal > 0)
  {
    EXPECT_LE(half_width(found[1]), 1.12 * normal);  // the bound itself is up to 1.08 times as large
    EXPECT_LE(half_width(found[2]), 1.12 * tangential);
  }
  if (energy_upper > 0)
  {
    EXPECT_NEAR(found[0].lower, energy_lower, 0.1 * (energy_upper - energy_lower));
    EXPECT_NEAR(found[0].upper, energy_upper, 0.2 * (energy_upper - energy_lower));
  }
  for (const QuantityInterval& q : found)
    fmt::print("T2D p = {}, {:2d}: {:<8} {:.6f} in [{:.6f}, {:.6f}], {}\n", p, nx, q.name, q.value, q.lower,
               q.upper, q.basis);
}

INSTANTIATE_TEST_SUITE_P(Uniform, QuantityT2D,
                         ::testing::Values(ReferenceCase{1, 4, 0.0269514, 0.0383817, 0, 0},
                                           ReferenceCase{1, 8, 0, 0, 0.015437006, 0.018041860},
                                           ReferenceCase{2, 4, 0.0103228, 0.0141702, 0, 0},
                                           ReferenceCase{2, 8, 0, 0, 0.016634358, 0.016888637},
                                           ReferenceCase{2, 16, 0, 0, 0.016747641, 0.016833214},
                                           ReferenceCase{3, 4, 0.0055586, 0.0076341, 0, 0},
                                           ReferenceCase{3, 8, 0, 0, 0.016745982, 0.016827092}));

/// T2D on meshes adapted to the energy, p = 2, with the same weight. The independent program had these
/// second-order radii on such meshes with 171 and 466 cells.
TEST(QuantityT2D, SharpensOnAdaptedMeshes)
{
  const Quantities<2> quantities = {contact_force<2>("bottom", {0, -1}, 0.5),
                                    contact_force<2>("bottom", {1, 0}, 0.5),
                                    mean_displacement<2>("right", {0, 1})};
  const std::map<Index, std::array<double, 3>> radii = {{171, {4.7e-4, 2.2e-3, 5.1e-3}},
                                                        {466, {1.2e-4, 4.9e-4, 1.5e-3}}};
  auto next = radii.begin();
  std::array<double, 3> lower{-0.09616134301, -0.04132273276, -1};
  std::array<double, 3> upper{-0.09616134299, -0.04132273274, 1};
  mesh::Mesh<2> mesh(block<2>({4, 2}));
  while (next != radii.end())
  {
    const DiscreteProblem<2> c(std::move(mesh), pressed_block<2>(),
                               {.degree = 2, .newton = {.tolerance = 1e-12}});
    const bool is_compared = c.mesh.n_cells() >= next->first;
    const EnergyBound bound =
        EnergyEstimator<2>(c.form, c.method.solver, is_compared ? quantities : Quantities<2>())(c.solve().u);
    for (std::size_t i = 0; i < bound.quantities.size(); ++i)
    {
      const QuantityInterval& q = bound.quantities[i];
      fmt::print("T2D, {} cells: {:<8} {:.7f} +- {:.2e}, {}\n", c.mesh.n_cells(), q.name,
                 (q.lower + q.upper) / 2, (q.upper - q.lower) / 2, q.basis);
      EXPECT_EQ(q.basis, "second order");
      EXPECT_LE((q.upper - q.lower) / 2, next->second[i]);
      lower[i] = std::max(lower[i], q.lower);
      upper[i] = std::min(upper[i], q.upper);
      EXPECT_LE(lower[i], upper[i]);
    }
    if (is_compared) ++next;
    std::vector<double> eta;
    for (const double square : bound.cells) eta.push_back(std::sqrt(square));
    mesh = mesh::bisect(c.mesh, std::span<const Index>(adapt::mark_doerfler(eta, 0.6)), 1).mesh;
  }
}

/// For constant stress every interval is the number itself.
template <int dim>
void expect_exact_numbers(int p)
{
  for_all_states<dim>(
      Tensor<dim>::Identity(),
      [&](const AffineCase<dim>& exact, const Point<dim>& right, const Point<dim>& down)
      {
        const DiscreteProblem<dim> c(structured<dim>(), affine_data<dim>(exact, right), affine_method(p));
        const Tensor<dim> sigma = contact::sigma<dim>(affine_material, exact.gradient);
        Point<dim> along = Point<dim>::Unit(0);
        const auto found = intervals<dim>(c,
                                          {{.name = "energy"},
                                           contact_force<dim>("bottom", down, 2),
                                           contact_force<dim>("bottom", along, 2),
                                           mean_displacement<dim>("right", along),
                                           mean_displacement<dim>("bottom", along)},
                                          c.solve().u);
        const auto near = [&](const QuantityInterval& interval, double truth)
        {
          const double size = std::max(std::abs(truth), 0.1);
          EXPECT_EQ(interval.reason, "") << exact.name;
          EXPECT_LE(interval.lower, truth + 1e-13 * size) << interval.name << exact.name;
          EXPECT_GE(interval.upper, truth - 1e-13 * size) << interval.name << exact.name;
          // mid is a square root: of rounding if s |v^t| + t^t . v^t vanishes by cancellation
          EXPECT_LE(interval.upper - interval.lower, 1e-7 * size) << interval.name << exact.name;
        };
        near(found[0], 2 * (sigma.array() * exact.gradient.array()).sum());  // volume 2
        // the right side is free in 3D, too: the weight vanishes at the other ends of the bottom
        if (dim == 2) near(found[1], 1.0 * down.dot(sigma * down));
        if (dim == 2) near(found[2], 1.0 * along.dot(sigma * down));
        const Point<dim> middle = 0.5 * Point<dim>::Ones();
        Point<dim> on_right = middle;
        on_right[0] = 2;
        near(found[3], along.dot(exact.gradient * on_right + exact.offset));
        Point<dim> on_bottom = middle;
        on_bottom[0] = 1;
        on_bottom[1] = 0;
        near(found[4], along.dot(exact.gradient * on_bottom + exact.offset));
      });
}

class QuantityExact : public ::testing::TestWithParam<int>
{
};

TEST_P(QuantityExact, NumbersOfConstantStress)
{
  expect_exact_numbers<2>(GetParam());
  if (GetParam() <= 2) expect_exact_numbers<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, QuantityExact, ::testing::Range(1, 5));

template <int dim>
QuantityInterval interval_from_statics(const ProblemData<dim>& data, const Quantity<dim>& quantity)
{
  const DiscreteProblem<dim> c(block<dim>({4, 2}, {2, 2, 2}), data, {.degree = 2});
  const std::vector<double> anything(c.space.n_dofs(), 0.0);
  return intervals<dim>(c, {quantity}, anything).front();
}

void expect_known(const QuantityInterval& interval, double truth)
{
  expect_contains(interval, truth);
  EXPECT_TRUE(interval.exact);
  EXPECT_EQ(interval.basis, "equilibrium");
  EXPECT_LE(interval.upper - interval.lower, 1e-13 * (0.8 + std::abs(truth)));  // 0.8: the loads
}

TEST(QuantityWeight, ThereMustBeOneOnTheFirstMesh)
{
  ProblemData<2> data = pressed_block<2>();
  data.boundaries.push_back(clamped<2>("right"));
  std::erase_if(data.boundaries, [](const auto& b) { return b.name == "right" && !b.fixes_any(); });
  const DiscreteProblem<2> coarse(block<2>({1, 1}), data, {.degree = 2});
  const DiscreteProblem<2> fine(block<2>({2, 1}), data, {.degree = 2});
  const Quantity<2> force = contact_force<2>("bottom", {0, 1}, 0.1);
  EXPECT_NE(intervals<2>(coarse, {force}, coarse.solve().u).front().reason.find("begin with a finer one"),
            std::string::npos);
  EXPECT_EQ(intervals<2>(fine, {force}, fine.solve().u).front().reason, "");
}

/// A block of volume 2 and weight 0.3 per volume, pressed down by 0.1 on its upper side of length or area 2.
template <int dim>
ProblemData<dim> resting_block(problem::ContactLaw law, std::vector<problem::BoundaryCondition<dim>> others)
{
  ProblemData<dim> data{.boundaries = {obstacle<dim>("bottom", std::move(law)), loaded<dim>("top", 0, -0.1)},
                        .body_force = components<dim, problem::Field>(0, -0.3, 0)};
  for (problem::BoundaryCondition<dim>& other : others) data.boundaries.push_back(std::move(other));
  return data;
}

template <int dim>
void expect_statics()
{
  const ProblemData<dim> on_rollers =
      resting_block<dim>(Frictionless(), {fixed<dim>("left", 0.0, free, free)});
  expect_known(interval_from_statics<dim>(on_rollers, contact_force<dim>("bottom", Point<dim>::Unit(1))),
               0.8);
  expect_known(interval_from_statics<dim>(on_rollers, contact_force<dim>("", -2 * Point<dim>::Unit(1))),
               -0.8);
  Quantity<dim> down{.name = "by its normal", .kind = QuantityKind::contact_force, .boundary = "bottom"};
  expect_known(interval_from_statics<dim>(on_rollers, down), -0.8);
  EXPECT_FALSE(
      interval_from_statics<dim>(on_rollers, contact_force<dim>("bottom", Point<dim>::Unit(0))).exact);

  const ProblemData<dim> pushed =
      resting_block<dim>(Coulomb(0.3), {loaded<dim>("right", formula("0.03*y^2"), 0.0)});
  const Quantity<dim> factor{.name = "sliding", .kind = QuantityKind::safety_factor, .boundary = "bottom"};
  expect_known(interval_from_statics<dim>(pushed, factor), 0.3 * 0.8 / 0.01);
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Coulomb(0.3)),
        {problem::JointLaw({.tension = {0.05, 0.003}, .cohesion = 0.1, .coefficient = 0.3})}})
  {
    ProblemData<dim> lifted = resting_block<dim>(law, {loaded<dim>("right", formula("0.03*y^2"), 0.0)});
    for (problem::BoundaryCondition<dim>& boundary : lifted.boundaries)
      if (boundary.contact) boundary.contact->water.emplace(formula("0.1 + 0.05*x"));
    expect_known(interval_from_statics<dim>(lifted, factor), 0.3 * (0.8 - 0.3) / 0.01);
    for (problem::BoundaryCondition<dim>& boundary : lifted.boundaries)
      if (boundary.contact) boundary.contact->water.emplace(formula("0.2*abs(x^2 - 2)"));
    const QuantityInterval kinked = interval_from_statics<dim>(lifted, factor);
    expect_contains(kinked, 0.3 * (0.8 - 0.2 * (8 * std::sqrt(2.0) - 4) / 3) / 0.01);
    for (problem::BoundaryCondition<dim>& boundary : lifted.boundaries)
      if (boundary.contact) boundary.contact->water.emplace(formula("1"));
    expect_known(interval_from_statics<dim>(lifted, factor), 0);  // the bond is in tension
  }
  Quantity<dim> moment{.name = "tilting", .kind = QuantityKind::contact_moment, .boundary = "bottom"};
  moment.point = Point<dim>::Unit(0);  // below the centre of gravity: the push alone turns, by y^3
  moment.direction = dim == 2 ? std::nullopt : std::optional(Point<dim>(Point<dim>::Unit(dim - 1)));
  expect_known(interval_from_statics<dim>(pushed, moment), 0.03 / 4);

  const ProblemData<dim> wedged =
      resting_block<dim>(Frictionless(), {obstacle<dim>("left"), fixed<dim>("right", free, free, 0.0)});
  const Quantity<dim> all = contact_force<dim>("", Point<dim>(Point<dim>::Unit(1)));
  expect_known(interval_from_statics<dim>(wedged, all), 0.8);
  EXPECT_FALSE(interval_from_statics<dim>(wedged, contact_force<dim>("left", Point<dim>::Unit(1))).exact);
}

/// Three blocks: two stand side by side on the third.
template <int dim>
void expect_intervals_of_three(const problem::ContactLaw& law, int p)
{
  ProblemData<dim> data{
      .boundaries = {clamped<dim>("bottom_below"), clamped<dim>("left"), fixed<dim>("top_b", 0.0, -0.02, 0.0),
                     loaded<dim>("top", 0.02, -0.1), loaded<dim>("right_b", -0.05, 0.03)},
      .pairs = {pair<dim>("bottom", "top_below", law), pair<dim>("right", "left_b", law)}};
  data.pairs[0].slave.emplace_back("bottom_b");
  const DiscreteProblem<dim> c(three_blocks<dim>(dim - 1), data,
                               {.degree = p, .newton = {.tolerance = 1e-11}});
  const DiscreteProblem<dim> rich(three_blocks<dim>(4), data,
                                  {.degree = p + 1, .newton = {.tolerance = 1e-11}});
  const Point<dim> along = Point<dim>::Ones().normalized();
  Quantities<dim> quantities = {{.name = "energy"}, {.name = "work", .kind = QuantityKind::load_work}};
  for (const char* const name : {"", "bottom", "bottom_b", "right"})
    quantities.push_back(contact_force<dim>(name, along, 1));
  for (const char* const name : {"top", "bottom_b", "left_b", "top_below"})
    quantities.push_back(mean_displacement<dim>(name, along));
  const auto found = intervals<dim>(c, quantities, c.solve().u);
  const std::vector<double> truth_u = rich.solve().u;
  const auto truth = intervals<dim>(rich, quantities, truth_u);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    expect_contains(found[i], truth[i].value, fmt::format(", {}D, p = {}", dim, p));
    expect_contains(truth[i], truth[i].value);
    EXPECT_LE(truth[i].upper - truth[i].lower, found[i].upper - found[i].lower) << found[i].name;
  }
}

TEST(QuantityJunction, IntervalsHoldWhereThreeBodiesMeet)
{
  const problem::ContactLaw tresca = Tresca(0.02);
  for (const problem::ContactLaw& law : {problem::ContactLaw(Frictionless()), tresca, {problem::Tied()}})
    for (const int p : {1, 2, 3}) expect_intervals_of_three<2>(law, p);
  expect_intervals_of_three<3>(tresca, 1);
}

/// A body that rests on another is pressed by it, however that one is held.
template <int dim>
void expect_statics_of_two()
{
  ProblemData<dim> data{.boundaries = {clamped<dim>("bottom_below"), loaded<dim>("top", 0, -0.1)},
                        .pairs = {pair<dim>("bottom", "top_below", Coulomb(0.3))}};
  const DiscreteProblem<dim> c(two_blocks<dim>(), data, {.degree = 1});
  const std::vector<double> anything(c.space.n_dofs(), 0.0);
  const auto found = intervals<dim>(c, {contact_force<dim>("bottom", Point<dim>::Unit(1))}, anything);
  expect_known(found.front(), 0.2);
}

TEST(QuantityStatics, FollowFromEquilibriumAlone)
{
  expect_statics_of_two<2>();
  expect_statics_of_two<3>();
  expect_statics<2>();
  expect_statics<3>();
}

TEST(QuantityErrors, NameWhatIsWrong)
{
  const auto message = [](const Quantity<2>& quantity)
  {
    try
    {
      (void)interval_from_statics<2>(pressed_block<2>(), quantity);
    }
    catch (const InputError& error)
    {
      return error.problem();
    }
    return std::string();
  };
  EXPECT_EQ(message(contact_force<2>("top", {0, 1})), "boundary \"top\" touches nothing");
  EXPECT_EQ(message(contact_force<2>("bottom", {0, 0})), "the direction is 0");
  EXPECT_NE(message(mean_displacement<2>("nowhere", {0, 1})), "");
  EXPECT_EQ(message({.name = "f", .kind = QuantityKind::safety_factor, .boundary = "bottom"}),
            "boundary \"bottom\" has no Coulomb friction");
}

}  // namespace

}  // namespace tribound::test
