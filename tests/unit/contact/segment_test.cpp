/// @file segment_test.cpp
/// Contact on segments: two elastic blocks on matching or non-matching meshes, parts of facets, and normals
/// that are not those of the facets.

#include "tribound/contact/nitsche/segment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/contact_tangent.h"
#include "support/fields.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/base/error.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/contact_moments.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

constexpr double distance = 0.1;  ///< between the blocks

template <int dim>
mesh::MeshData<dim> blocks(int n_upper, int n_lower)
{
  Point<dim> corner = Point<dim>::Ones();
  corner[0] = 2;
  Point<dim> low = Point<dim>::Zero();
  Point<dim> low_top = corner;
  low[1] = -1 - distance;
  low_top[1] = -distance;
  std::array<int, dim> upper;
  std::array<int, dim> lower;
  upper.fill(n_upper);
  lower.fill(n_lower);
  return side_by_side(box<dim>(Point<dim>::Zero(), corner, upper), box<dim>(low, low_top, lower), "_below");
}

struct Setting
{
  problem::ContactLaw law = Frictionless();
  int p = 1;
  int n_upper = 3;
  int n_lower = 3;
  double E_below = 2;
  double shift = 0;
  bool confined = false;
  bool swapped = false;              ///< the lower block is the slave
  std::optional<double> gap = 0.01;  ///< absent: the distance
  double pressed = 0.05;             ///< displacement of the top, downwards
};

/// The upper block pressed on the lower one and moved sideways by `shift`. If `confined`, both blocks have no
/// displacement normal to their sides.
template <int dim>
problem::Problem<dim> pressed_blocks(const mesh::Mesh<dim>& mesh, const Setting& setting)
{
  std::vector<problem::BoundaryCondition<dim>> conditions = {
      fixed<dim>("top", setting.shift, -setting.pressed), clamped<dim>("bottom_below")};
  for (const std::string suffix : {"", "_below"})
    for (const char* side : {"left", "right", "back", "front"})
    {
      const bool along_z = side[0] == 'b' || side[0] == 'f';
      if (!setting.confined || (dim == 2 && along_z)) continue;
      conditions.push_back(along_z ? fixed<dim>(side + suffix, free, free, 0.0)
                                   : fixed<dim>(side + suffix, 0.0, free, free));
    }
  problem::ContactPair<dim> pair{{"bottom"}, {"top_below"}, problem::Contact(setting.law, std::nullopt)};
  if (setting.gap) pair.contact.gap = problem::Field(*setting.gap);
  if (setting.swapped) std::swap(pair.slave, pair.master);
  return problem::Problem<dim>(mesh,
                               {{.name = "box", .material = lame(1, 0.3)},
                                {.name = "box_below", .material = lame(setting.E_below, 0.2)}},
                               conditions, {pair});
}

template <int dim>
solve::NewtonResult<dim> solve_directly(const contact::NitscheForm<dim>& form)
{
  const solve::NewtonResult<dim> newton =
      solve::solve<dim>(form, {}, {}, {.method = algebra::LinearMethod::direct});
  EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  return newton;
}

template <int dim>
struct Blocks
{
  explicit Blocks(const Setting& setting)
      : mesh(blocks<dim>(setting.n_upper, setting.n_lower)),
        problem(pressed_blocks<dim>(mesh, setting)),
        space(mesh, setting.p),
        gamma0(contact::default_gamma0(setting.p)),
        form(problem, space, gamma0)
  {
  }

  [[nodiscard]] solve::NewtonResult<dim> solve() const { return solve_directly(form); }

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  double gamma0;
  contact::NitscheForm<dim> form;
};

const std::vector<problem::ContactLaw> laws = {Frictionless(), Tresca(0.005), Coulomb(0.3)};

std::vector<problem::ContactLaw> laws_between_bodies()
{
  std::vector<problem::ContactLaw> all = laws;
  all.emplace_back(problem::Tied());
  return all;
}

/// In uniaxial strain the stress is constant, also across non-matching facets.
template <int dim>
void expect_constant_pressure(Setting setting)
{
  setting.confined = true;
  const Blocks<dim> c(setting);
  const auto stiffness = [&](int region)
  { return c.problem.material(region).lambda + 2 * c.problem.material(region).mu; };
  const double pressure =
      (setting.pressed - setting.gap.value_or(distance)) / (1 / stiffness(0) + 1 / stiffness(1));
  const double rounding = 1e-11 * std::abs(pressure);
  const solve::NewtonResult<dim> newton = c.solve();
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : c.form.contact_states(newton.u, k))
    {
      EXPECT_NEAR(state.pressure, pressure, rounding);
      EXPECT_NEAR(state.gap, 0, 1e-12);
    }
  const contact::ContactResultants<dim> sum = contact::contact_resultants<dim>(c.form, newton.traction);
  EXPECT_NEAR(sum.normal, -2 * pressure, rounding);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<dim>(c.form, newton.traction, stress).largest(), 1e-10);
}

/// The area of the interface, [0, 2] x {0} (x [0, 1]) opposite y = -distance, times the arm of its centroid.
TEST(ContactSegments, MomentsOfAConstantTractionOnBothSides)
{
  const Blocks<2> flat({.n_upper = 4, .n_lower = 3});
  const Point<2> t(0.3, -0.5);
  const contact::ContactMoments<2> m =
      contact::contact_moments<2>(flat.form, std::vector<Point<2>>(flat.form.n_contact_points(), t));
  EXPECT_NEAR(m.slave[0], 2 * t[1], 1e-13);
  EXPECT_NEAR(m.master[0], -2 * (t[1] + distance * t[0]), 1e-13);

  const Blocks<3> solid({.n_upper = 2, .n_lower = 3});
  const Point<3> t3(0.3, -0.5, 0.2);
  const std::vector<Point<3>> all(solid.form.n_contact_points(), t3);
  const contact::ContactMoments<3> m3 = contact::contact_moments<3>(solid.form, all);
  EXPECT_LE((m3.slave - 2 * Point<3>(0.25, -0.05, -0.5)).norm(), 1e-13);
  EXPECT_LE((m3.master + 2 * Point<3>(0.23, -0.05, -0.47)).norm(), 1e-13);
  EXPECT_EQ(contact::contact_moments<3>(solid.form, all, 99).slave.norm(), 0);
}

TEST(ContactSegments, ConstantPressureThroughFacetsThatDoNotMatch)
{
  for (const int p : {1, 2, 3})
    for (const double E_below : {1e-2, 2.0, 1e2})
    {
      expect_constant_pressure<2>({.p = p, .n_upper = 4, .n_lower = 3, .E_below = E_below});
      expect_constant_pressure<2>({.p = p, .n_upper = 2, .n_lower = 5, .E_below = E_below});
    }
  for (const int p : {1, 2})
    for (const double E_below : {1e-2, 1e2})
      expect_constant_pressure<3>({.p = p, .n_upper = 2, .n_lower = 3, .E_below = E_below});
  for (const int p : {3, 4}) expect_constant_pressure<3>({.p = p, .n_upper = 2, .n_lower = 1, .E_below = 5});
}

TEST(ContactSegments, TheGapMayBeTheDistanceOfTheBodies)
{
  expect_constant_pressure<2>({.p = 2, .n_upper = 4, .n_lower = 3, .gap = {}, .pressed = 0.13});
  expect_constant_pressure<3>({.p = 1, .n_upper = 2, .n_lower = 3, .gap = {}, .pressed = 0.13});
}

TEST(ContactSegments, WhatIsTiedMayBePulled)
{
  for (const double push : {0.05, -0.05})
  {
    const Setting setting{
        .law = problem::Tied(), .p = 2, .n_upper = 2, .n_lower = 3, .gap = 0, .pressed = push};
    expect_constant_pressure<2>(setting);
    expect_constant_pressure<3>(setting);
  }
}

/// The directional derivative of T(u) against differences, and the tangent against the derivative.
template <int dim>
void expect_tangent(const contact::NitscheForm<dim>& form)
{
  const std::vector<double> pushed = interpolate<dim>(
      form.space(),
      [](const Point<dim>& x) -> Point<dim>
      {
        return x[1] > -distance / 2 ? Point<dim>(0.05 * Point<dim>::Unit(0) - 0.1 * Point<dim>::Unit(1))
                                    : Point<dim>(Point<dim>::Zero());
      });
  expect_contact_tangent(form, sum(pushed, 1, random_free_vector(form.constraints(), 0.003, 1)), 1e-6);
}

/// Tractions are evaluated through the nodes of the segments, states directly at the points.
template <int dim>
void expect_tractions_of_states(int p)
{
  const Blocks<dim> c({.law = problem::Tied(), .p = p, .n_upper = 2, .n_lower = 3, .gap = 0});
  const std::vector<double> u = random_free_vector(c.form.constraints(), 0.1, 5);
  const std::vector<Point<dim>> t = c.form.traction(u);
  double largest = 0;
  for (const Point<dim>& at : t) largest = std::max(largest, at.norm());
  EXPECT_GT(largest, 0);
  for (std::size_t k = 0, i = 0; k < c.form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : c.form.contact_states(u, k))
      EXPECT_LE((state.traction - t[i++]).norm(), 1e-12 * largest);
}

TEST(ContactSegments, TractionsAreThoseOfTheStates)
{
  for (int p = 1; p <= 4; ++p) expect_tractions_of_states<2>(p);
  for (int p = 1; p <= 3; ++p) expect_tractions_of_states<3>(p);
}

TEST(ContactSegments, TangentIsTheDerivative)
{
  for (const problem::ContactLaw& law : laws)
  {
    for (const int p : {1, 3})
      expect_tangent(Blocks<2>({.law = law, .p = p, .n_upper = 4, .n_lower = 3}).form);
    expect_tangent(Blocks<3>({.law = law, .p = 2, .n_upper = 1, .n_lower = 2}).form);
  }
}

/// Every body is in equilibrium: the identities hold on both sides, and no force is lost between them.
template <int dim>
void expect_equilibrium(const Setting& setting)
{
  const Blocks<dim> c(setting);
  const solve::NewtonResult<dim> newton = c.solve();
  const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, newton.u, newton.traction);
  const certify::IdentityDefects identities = certify::check_identities<dim>(c.form, newton.traction, stress);
  EXPECT_LE(identities.largest(), 1e-10);
  std::vector<double> forces(c.space.n_dofs(), 0.0);
  c.form.add_contact_load(newton.traction, forces);
  Point<dim> sum = Point<dim>::Zero();
  for (Index node = 0; node < c.space.n_nodes(); ++node) sum += Point<dim>(&forces[dim * node]);
  EXPECT_GT(norm(forces), 1e-4);
  EXPECT_LE(sum.norm(), 1e-13 * norm(forces));
}

TEST(ContactSegments, BothBodiesAreInEquilibrium)
{
  for (const problem::ContactLaw& law : laws_between_bodies())
  {
    for (const int p : {1, 2, 3})
      expect_equilibrium<2>({.law = law, .p = p, .n_upper = 4, .n_lower = 3, .shift = 0.02, .gap = 0});
    for (const int p : {1, 2})
      expect_equilibrium<3>({.law = law, .p = p, .n_upper = 2, .n_lower = 3, .shift = 0.02, .gap = 0});
  }
}

TEST(ContactSegments, OnAFlatInterfaceEitherSideMayBeTheSlave)
{
  for (const problem::ContactLaw& law : laws_between_bodies())
  {
    Setting setting{.law = law, .p = 2, .n_upper = 4, .n_lower = 3, .E_below = 30, .shift = 0.02, .gap = 0};
    const std::vector<double> u = Blocks<2>(setting).solve().u;
    setting.swapped = true;
    const std::vector<double> of_swapped = Blocks<2>(setting).solve().u;
    EXPECT_LE(norm(sum(u, -1, of_swapped)), 1e-9 * norm(u));
  }
}

TEST(ContactSegments, AStiffMasterIsAnObstacle)
{
  const Blocks<2> c({.law = Coulomb(0.3), .p = 2, .n_upper = 3, .n_lower = 3, .E_below = 1e8, .shift = 0.02});
  const problem::Problem<2> alone(
      c.mesh, {{.name = "box", .material = lame(1, 0.3)}, {.name = "box_below", .material = lame(1e8, 0.2)}},
      {fixed<2>("top", 0.02, -0.05), clamped<2>("bottom_below"),
       problem::with_contact<2>("bottom", Coulomb(0.3), 0.01)});
  const contact::NitscheForm<2> on_obstacle(alone, c.space, c.gamma0);
  const auto force = [](const contact::NitscheForm<2>& form)
  { return contact::contact_resultants<2>(form, solve_directly(form).traction).force; };
  const Point<2> expected = force(on_obstacle);
  EXPECT_LE((force(c.form) - expected).norm(), 1e-6 * expected.norm());
}

/// Any unit vector may define normal and tangential parts.
TEST(ContactSegments, NormalsNeedNotBeThoseOfTheFacets)
{
  const Blocks<2> c({.law = Coulomb(0.3), .p = 2, .n_upper = 4, .n_lower = 3, .shift = 0.02});
  std::vector<contact::ContactSegment<2>> segments(c.form.segments().begin(), c.form.segments().end());
  for (auto& segment : segments) segment.normal = Point<2>(0.3, -1).normalized();
  const contact::NitscheForm<2> form(c.problem, c.space, c.gamma0, std::move(segments));
  expect_tangent(form);
  const solve::NewtonResult<2> newton = solve_directly(form);
  const certify::Stress<2> stress = certify::equilibrate<2>(form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<2>(form, newton.traction, stress).largest(), 1e-10);
}

/// A boundary in a pair may not be used otherwise.
TEST(ContactSegments, BoundariesOfPairsAreInNothingElse)
{
  const mesh::Mesh<2> mesh(blocks<2>(1, 1));
  const auto message = [&](const std::vector<problem::ContactPair<2>>& pairs)
  {
    return message_of(
        [&] { problem::Problem<2>(mesh, {{.material = lame(1, 0.3)}}, {clamped<2>("top")}, pairs); });
  };
  const problem::Contact contact{Frictionless()};
  EXPECT_EQ(message({{{"bottom"}, {"top_below"}, contact}}), "");
  EXPECT_THAT(message({{{"bottom"}, {"bottom"}, contact}}), HasSubstr("\"bottom\" already is in contact"));
  EXPECT_THAT(message({{{"bottom"}, {"top_below"}, contact}, {{"right"}, {"top_below"}, contact}}),
              HasSubstr("\"top_below\" already is in contact"));
  EXPECT_THAT(message({{{"top"}, {"top_below"}, contact}}), HasSubstr("\"top\" has a condition of its own"));
  EXPECT_THAT(message({{{}, {"top_below"}, contact}}), HasSubstr("a side of the contact is empty"));
  EXPECT_THAT(message({{{"bottom"}, {"roof"}, contact}}), HasSubstr("the mesh has no boundary \"roof\""));
  const problem::Contact tied(problem::Tied(), 0.1);
  EXPECT_THAT(message({{{"bottom"}, {"top_below"}, tied}}), HasSubstr("a tied contact has no gap"));
}

TEST(ContactSegments, ASlaveWithoutAnythingOppositeIsAnError)
{
  const mesh::Mesh<2> mesh(blocks<2>(1, 1));
  const problem::Problem<2> problem(mesh, {{.material = lame(1, 0.3)}}, {},
                                    {{{"bottom"}, {"right_below"}, problem::Contact(Frictionless())}});
  EXPECT_THAT(message_of([&] { (void)contact::contact_segments<2>(problem, mesh, 10); }),
              HasSubstr("nothing of the master lies opposite the slave"));
}

}  // namespace

}  // namespace tribound::test
