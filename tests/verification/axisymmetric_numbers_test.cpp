/// @file axisymmetric_numbers_test.cpp
/// Quantities and sections of bodies of revolution, against exact solutions and statics.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/input_error.h"
#include "support/meridian_problem.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/energy/quantity_parts.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/io/record/sections.h"
#include "verification/quantities.h"

namespace tribound::test
{

namespace
{

constexpr double two_pi = 2 * std::numbers::pi;

/// The values, and the intervals if asked for.
std::vector<double> values(const MeridianProblem& c, const Quantities<2>& quantities,
                           std::vector<QuantityInterval>* intervals = nullptr)
{
  std::vector<double> result;
  for (const QuantityInterval& interval :
       adapt::energy_bound<2>(c.form, c.method, c.solve().u, quantities).quantities)
  {
    EXPECT_EQ(interval.reason, "") << interval.name;
    result.push_back(interval.value);
    if (intervals != nullptr) intervals->push_back(interval);
  }
  return result;
}

/// Lame's thick cylinder between two planes, with pressure in its bore: u_r = A r + B / r.
TEST(AxisymmetricQuantities, OfAThickCylinder)
{
  constexpr double inner = 1;
  constexpr double outer = 2;
  constexpr double height = 0.5;
  constexpr double pressure = 0.1;
  const problem::Material material = lame(1, 0.3);
  const MeridianProblem c(box<2>({inner, 0}, {outer, height}, {8, 2}),
                          {.boundaries = {pressed<2>("left", pressure), fixed<2>("bottom", free, 0.0),
                                          fixed<2>("top", free, 0.0)},
                           .material = material},
                          {.degree = 3});
  const double squares = outer * outer - inner * inner;
  const double a = pressure * inner * inner / squares / 2 / (material.lambda + material.mu);
  const double b = pressure * inner * inner * outer * outer / squares / 2 / material.mu;
  const auto u = [&](double r) { return a * r + b / r; };
  const double work = two_pi * inner * height * pressure * u(inner);
  std::vector<QuantityInterval> intervals;
  const std::vector<double> found = values(c,
                                           {{.name = "energy"},
                                            {.name = "work", .kind = QuantityKind::load_work},
                                            mean_displacement<2>("right", {1, 0}),
                                            mean_displacement<2>("top", {2, 0})},
                                           &intervals);
  EXPECT_NEAR(found[0], work, 1e-6 * work);
  EXPECT_NEAR(found[1], work, 1e-6 * work);
  EXPECT_NEAR(found[2], u(outer), 1e-6 * u(outer));
  const double moment = a * (std::pow(outer, 3) - std::pow(inner, 3)) / 3 + b * (outer - inner);
  EXPECT_NEAR(found[3], moment / (squares / 2), 1e-6 * u(outer));  // the mean over a ring
  const std::array<double, 4> exact = {work, work, u(outer), moment / (squares / 2)};
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const double rounding = 1e-13 * exact[i];
    EXPECT_LE(intervals[i].lower, exact[i] + rounding) << i;
    EXPECT_GE(intervals[i].upper, exact[i] - rounding) << i;
    EXPECT_LE(intervals[i].upper - intervals[i].lower, 1e-5 * exact[i]) << i;
  }
}

/// A ring that is shrunk on another one, which alone holds it: the force between them, and how far they are
/// from sliding.
TEST(AxisymmetricQuantities, OfAPressFit)
{
  constexpr double height = 1;
  constexpr double inner = 1;
  constexpr double joint = 2;
  constexpr double outer = 3;
  constexpr double interference = 0.01;
  mesh::MeshData<2> data = side_by_side(box<2>({inner, 0}, {joint, height}, {4, 4}),
                                        box<2>({joint, 0}, {outer, height}, {4, 4}), "_outer");
  data.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
  ProblemData<2> rings{.boundaries = {fixed<2>("bottom", free, 0.0), fixed<2>("top", free, 0.0),
                                      loaded<2>("right_outer", 0, 0.0001)},
                       .material = lame(1, 0.0)};
  rings.pairs = {pair<2>("left_outer", "right", Coulomb(0.4))};
  rings.pairs[0].contact.gap = -interference;
  const MeridianProblem c(std::move(data), rings, {.degree = 3, .newton = {.tolerance = 1e-12}});
  const auto stiffness = [](double a, double b) { return (b * b - a * a) / (b * b + a * a); };
  const double pressure = interference / joint / (1 / stiffness(inner, joint) + 1 / stiffness(joint, outer));
  const double normal = two_pi * joint * height * pressure;
  const double pull = two_pi * outer * height * 0.0001;
  std::vector<QuantityInterval> intervals;
  const std::vector<double> found =
      values(c,
             {contact_force<2>("left_outer", {1, 0}),
              {.name = "normal", .kind = QuantityKind::contact_force, .boundary = "left_outer"},
              contact_force<2>("left_outer", {0, -1}),
              {.name = "safety", .kind = QuantityKind::safety_factor, .boundary = "left_outer"}},
             &intervals);
  EXPECT_NEAR(found[0], normal, 2e-3 * normal);  // bent a little by the pull
  EXPECT_DOUBLE_EQ(found[1], -found[0]);
  EXPECT_TRUE(intervals[2].exact);
  EXPECT_NEAR(intervals[2].lower, pull, 1e-12 * pull);
  EXPECT_NEAR(intervals[2].upper, pull, 1e-12 * pull);
  EXPECT_NEAR(found[2], pull, 5e-3 * pull);  // T(u_h) on a finer mesh, where friction has a kink
  EXPECT_NEAR(found[3], 0.4 * found[0] / found[2], 1e-9 * found[3]);
}

TEST(AxisymmetricQuantities, SafetyIsThatOfCylinders)
{
  const MeridianProblem c(box<2>({0, 0}, {1, 1}, {2, 2}),
                          {.boundaries = {loaded<2>("top", 0, -0.1), obstacle<2>("bottom", Coulomb(0.3))}},
                          {.degree = 1});
  const auto of = [&](const Quantity<2>& quantity)
  { return adapt::energy_bound<2>(c.form, c.method, c.solve().u, {quantity}).quantities[0].reason; };
  EXPECT_EQ(of({.kind = QuantityKind::safety_factor, .boundary = "bottom"}),
            "a body of revolution slides on cylinders alone");
  EXPECT_EQ(of(mean_displacement<2>("left", {0, 1})), "the boundary is the axis");
  EXPECT_NE(message_of([&] { return of({.kind = QuantityKind::contact_moment}); })
                .find("the moments on bodies of revolution cancel around the axis"),
            std::string::npos);
}

/// What quadrature may miss of the water in a cylindrical joint grows with its radius.
TEST(AxisymmetricQuantities, WhatMayBeMissedOfUpliftHasTheWeight)
{
  std::vector<certify::KnownNumber> found;
  for (const double radius : {2.0, 4.0})
  {
    ProblemData<2> data{.boundaries = {obstacle<2>("right", Coulomb(0.3)), fixed<2>("bottom", free, 0.0)}};
    data.boundaries[0].contact->water = problem::Water(formula("0.05 + 0.02*sqrt(y + 0.001)"));
    const MeridianProblem c(box<2>({radius - 1, 0}, {radius, 1}, {2, 2}), data, {.degree = 2});
    const Quantity<2> safety{.kind = QuantityKind::safety_factor, .boundary = "right"};
    found.push_back(certify::parts_of<2>(c.form, safety).uplift);
  }
  EXPECT_GT(found[0].uncertainty, 1e-12 * found[0].value);  // more than rounding
  EXPECT_NEAR(found[1].value / found[0].value, 2, 1e-9);
  EXPECT_NEAR(found[1].uncertainty / found[0].uncertainty, 2, 1e-9);
}

std::vector<io::SectionRecord> sections(const MeridianProblem& c, const std::vector<io::Section<2>>& of)
{
  const solve::NewtonResult<2> solved = c.solve();
  adapt::CertifiedLevel<2> level;
  level.u = solved.u;
  level.traction = solved.traction;
  level.stress = certify::equilibrate<2>(c.form, solved.u, solved.traction);
  io::check_sections<2>(c.mesh, of);
  return io::read_sections<2>(c.form, level, of);
}

constexpr double body = 0.3;   // f_z
constexpr double side = -0.2;  // the axial traction on the outer side

/// The axial traction on top at r, integrated from `inner` to 1 with the weight r.
constexpr double on_top(double inner)
{
  return 0.1 * (1 - inner * inner) / 2 + 0.5 * (1 - inner * inner * inner) / 3;
}

ProblemData<2> pulled(problem::BoundaryCondition<2> held)
{
  ProblemData<2> data{.boundaries = {std::move(held),
                                     loaded<2>("top", formula("0.3*x"), formula("0.1 + 0.5*x")),
                                     loaded<2>("right", formula("0.2*y"), side)}};
  data.body_force = {0.1, body};
  return data;
}

/// Across the axis: the loads above.
TEST(AxisymmetricSections, CarryTheLoadsAboveThem)
{
  for (const double inner : {0.0, 0.4})
    for (const int p : {1, 2, 3, 4})
    {
      const MeridianProblem c(random_meridian(inner, 3, static_cast<unsigned>(p)),
                              pulled(fixed<2>("bottom", free, 0.0)), {.degree = p});
      const double z = 0.37;
      const auto found = sections(c, {{.name = "cut", .point = {0.5, z}, .normal = {0, 1}, .where = {}}});
      const double area = (1 - inner * inner) / 2;
      const double force = two_pi * (body * (1 - z) * area + side * (1 - z) + on_top(inner));
      EXPECT_NEAR(found[0].measure, two_pi * area, 1e-12);
      EXPECT_NEAR(found[0].N, force, 1e-11) << "p = " << p << ", inner = " << inner;
      EXPECT_NEAR(found[0].force[1], force, 1e-11);
      EXPECT_EQ(found[0].force[0], 0);
      EXPECT_EQ(found[0].M, std::vector<double>{0});
      EXPECT_EQ(found[0].note, "");
    }
}

/// Cylinders and cones around the axis: the loads outside.
TEST(AxisymmetricSections, CarryTheLoadsOutsideThem)
{
  constexpr double r = 0.7;
  for (const double slope : {0.0, 0.2, -0.3})
    for (const int p : {1, 2, 3})
    {
      const MeridianProblem c(random_meridian(0.3, 3, static_cast<unsigned>(p)),
                              pulled(fixed<2>("left", free, 0.0)), {.degree = p});
      const Point<2> normal = Point<2>(1, slope).normalized();
      const auto found = sections(c, {{.name = "cut", .point = {r, 0.5}, .normal = normal, .where = {}}});
      const double outside = body / 2 * (1 - r * r - slope * slope / 12);
      const double force = two_pi * (outside + side + on_top(r - slope / 2));
      EXPECT_NEAR(found[0].force[1], force, 1e-11) << "p = " << p << ", slope = " << slope;
      EXPECT_NEAR(found[0].N * normal[1] + found[0].V[0] * normal[0], force, 1e-11);
    }
}

}  // namespace

}  // namespace tribound::test
