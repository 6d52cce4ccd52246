/// @file section_test.cpp
/// Forces and moments through planes against statics: what the loads in front of the plane add up to, by
/// integrals in coordinates that share nothing with the program.

#include "tribound/io/record/sections.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/two_blocks.h"
#include "tribound/certify/bound/balance.h"
#include "verification/observed.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

/// c_0 + c_1 x + c_2 y + c_3 z + c_4 x y.
struct Polynomial
{
  std::array<double, 5> c{};

  [[nodiscard]] double operator()(const Point<3>& x) const
  {
    return c[0] + c[1] * x[0] + c[2] * x[1] + c[3] * x[2] + c[4] * x[0] * x[1];
  }
  [[nodiscard]] problem::Field field(int dim) const
  {
    return formula(fmt::format("{:.17g} + {:.17g}*x + {:.17g}*y + {:.17g}*{} + {:.17g}*x*y", c[0], c[1], c[2],
                               dim == 3 ? c[3] : 0.0, dim == 3 ? "z" : "y", c[4]));
  }
};

using Vector = std::array<Polynomial, 3>;

Point<3> at(const Vector& vector, const Point<3>& x)
{
  return {vector[0](x), vector[1](x), vector[2](x)};
}

/// The loads of a block (0, 2) x (0, 1) [x (0, 1)].
struct BlockLoads
{
  Vector body;
  Vector top;
  Vector right;

  BlockLoads(std::mt19937& random, int dim, int p)
  {
    std::uniform_real_distribution<double> between(-1, 1);
    for (Vector* vector : {&body, &top, &right})
      for (int i = 0; i < dim; ++i)
        for (int k = 0; k < 5; ++k)
        {
          const bool is_allowed = k == 0 || (k < 4 && p > 1) || (p > 2 || (vector != &body && p > 1));
          if (is_allowed && (dim == 3 || k != 3)) (*vector)[i].c[k] = between(random);
        }
  }
};

/// Gauss's rule with five points on (a, b).
template <class Function>
void integrate(double a, double b, const Function& f)
{
  const double root = 2 * std::sqrt(10.0 / 7);
  const std::array x = {std::sqrt(5 - root) / 3, std::sqrt(5 + root) / 3};
  const std::array w = {(322 + 13 * std::sqrt(70.0)) / 900, (322 - 13 * std::sqrt(70.0)) / 900};
  const double half = (b - a) / 2;
  f((a + b) / 2, half * 128 / 225);
  for (int k = 0; k < 2; ++k)
    for (const int sign : {-1, 1}) f((a + b) / 2 + sign * half * x[k], half * w[k]);
}

struct Statics
{
  Point<3> force = Point<3>::Zero();
  Point<3> moment = Point<3>::Zero();

  void add(const Point<3>& arm, const Point<3>& f)
  {
    force += f;
    moment += mesh::cross(arm, f);
  }
};

/// The resultant of the loads in front of the plane, which crosses the block between its ends.
Statics loads_in_front(const BlockLoads& loads, int dim, const Point<3>& point, const Point<3>& n)
{
  const auto height = [&](double y, double z)
  { return point[0] - ((y - point[1]) * n[1] + (z - point[2]) * n[2]) / n[0]; };
  Statics sum;
  const auto over_depth = [&](const auto& f)
  {
    if (dim == 3)
      integrate(0, 1, f);
    else
      f(0.0, 1.0);
  };
  over_depth(
      [&](double z, double dz)
      {
        integrate(0, 1,
                  [&](double y, double dy)
                  {
                    const Point<3> end(2, y, z);
                    sum.add(end - point, dy * dz * at(loads.right, end));
                    integrate(height(y, z), 2,
                              [&](double x, double dx)
                              {
                                const Point<3> here(x, y, z);
                                sum.add(here - point, dx * dy * dz * at(loads.body, here));
                              });
                  });
        integrate(height(1, z), 2,
                  [&](double x, double dx)
                  {
                    const Point<3> here(x, 1, z);
                    sum.add(here - point, dx * dz * at(loads.top, here));
                  });
      });
  return sum;
}

/// Moves vertices inside the block, none on its sides.
template <int dim>
mesh::MeshData<dim> moved_inside(mesh::MeshData<dim> data)
{
  return mapped<dim>(std::move(data),
                     [](const Point<dim>& x) -> Point<dim>
                     {
                       double bubble = 0.07 * std::sin(std::numbers::pi * x[0] / 2);
                       for (int i = 1; i < dim; ++i) bubble *= std::sin(std::numbers::pi * x[i]);
                       Point<dim> y = x;
                       for (int i = 0; i < dim; ++i) y[i] += bubble * (i == 0 ? 1 : -0.6);
                       return y;
                     });
}

template <int dim>
io::Section<dim> section(const Point<3>& point, const Point<3>& normal)
{
  return {.name = "cut",
          .point = point.head<dim>(),
          .normal = normal.head<dim>().normalized(),
          .within = {},
          .where = {.file = {}, .key = "section.cut"}};
}

/// The record against what statics says, relative to `scale`.
template <int dim>
void expect_statics(const io::SectionRecord& found, const Point<3>& force, const Point<3>& moment,
                    double scale, bool has_moments = true)
{
  const double zero = 1e-10 * scale;
  for (int i = 0; i < dim; ++i) EXPECT_NEAR(found.force[i], force[i], zero) << i;
  EXPECT_EQ(found.note.empty(), has_moments);
  ASSERT_EQ(found.moment.size(), dim == 2 ? 1u : 3u);
  for (int i = dim == 2 ? 2 : 0; i < 3 && has_moments; ++i)
    EXPECT_NEAR(found.moment[dim == 2 ? 0 : i], moment[i], zero) << i;
  // In its own axes.
  Point<dim> sum = Point<dim>::Zero();
  Point<dim> turned = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
  {
    const Point<dim> axis(&found.axes[dim * k]);
    EXPECT_NEAR(axis.norm(), 1, 1e-14);
    sum += (k == 0 ? found.N : found.V[k - 1]) * axis;
    if (dim == 3) turned += found.M[k] * axis;
  }
  for (int i = 0; i < dim; ++i) EXPECT_NEAR(sum[i], found.force[i], 1e-13 * scale);
  if (dim == 2)
  {
    EXPECT_EQ(found.M[0], found.moment[0]);
  }
  else
    for (int i = 0; i < dim; ++i) EXPECT_NEAR(turned[i], found.moment[i], 1e-13 * scale);
}

/// The boundary conditions of these loads, and a clamp on the left.
template <int dim>
ProblemData<dim> data_of(const BlockLoads& loads)
{
  const auto field = [](const Polynomial& component) { return component.field(dim); };
  const auto boundary = [&](const char* name, const Vector& v)
  { return loaded<dim>(name, field(v[0]), field(v[1]), field(v[2])); };
  return {.boundaries = {clamped<dim>("left"), boundary("top", loads.top), boundary("right", loads.right)},
          .body_force = components<dim>(field(loads.body[0]), field(loads.body[1]), field(loads.body[2]))};
}

/// Random planes across a cantilever, both ways, from the bound's stress by rows and from the symmetric one.
template <int dim>
void expect_equilibrium(int p, bool is_structured)
{
  std::mt19937 random(100 * dim + p);
  const BlockLoads loads(random, dim, p);
  mesh::MeshData<dim> mesh = block<dim>({4, 3}, {4, 2, 2});
  if (!is_structured) mesh = renumbered(moved_inside<dim>(std::move(mesh)), 17);
  const DiscreteProblem<dim> c(std::move(mesh), data_of<dim>(loads), {.degree = p});
  std::uniform_real_distribution<double> between(-1, 1);
  for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
  {
    const adapt::CertifiedLevel<dim> level = observed(c, kind);
    for (int k = 0; k < 6; ++k)
    {
      SCOPED_TRACE(k);
      const bool is_along = k < 2;  // through vertices, for a structured mesh along facets
      const Point<3> point(is_along ? 1 : 1 + 0.4 * between(random), 0.5, dim == 3 ? 0.5 : 0);
      Point<3> n(1, is_along ? 0 : 0.4 * between(random), is_along || dim == 2 ? 0 : 0.4 * between(random));
      const Statics expected = loads_in_front(loads, dim, point, n);
      const int sign = k % 2 == 0 ? 1 : -1;
      const auto found = io::read_sections<dim>(c.form, level, std::vector{section<dim>(point, sign * n)})[0];
      expect_statics<dim>(found, sign * expected.force, sign * expected.moment, 1, p > 1);
      EXPECT_NEAR(found.measure, n.norm(), 1e-12);
    }
  }
}

class Sections : public ::testing::TestWithParam<int>
{
};
TEST_P(Sections, AreInEquilibriumIn2D)
{
  expect_equilibrium<2>(GetParam(), false);
  expect_equilibrium<2>(GetParam(), true);
}
TEST_P(Sections, AreInEquilibriumIn3D)
{
  expect_equilibrium<3>(GetParam(), false);
  expect_equilibrium<3>(GetParam(), true);
}
INSTANTIATE_TEST_SUITE_P(Degrees, Sections, ::testing::Range(1, 4));

/// Before Newton's method has converged the running traction holds the balance, also here.
template <int dim>
void expect_equilibrium_of_iterates()
{
  std::mt19937 random(7);
  const BlockLoads loads(random, dim, 2);
  ProblemData<dim> data = data_of<dim>(loads);
  data.boundaries.back() = obstacle<dim>("right", Coulomb(0.4), formula("0.1*y - 0.05"));
  DiscreteProblem<dim> c(renumbered(block<dim>({4, 3}, {3, 2, 2}), 3), data, {.degree = 2});
  BlockLoads others = loads;
  others.right = {};
  const Point<3> point(0.9, 0.4, dim == 3 ? 0.5 : 0);
  const Point<3> n(1, 0.2, dim == 3 ? -0.3 : 0);
  for (const int steps : {1, 2, 40})
  {
    c.method.newton.max_steps = steps;
    const adapt::CertifiedLevel<dim> level = observed(c, certify::PatchStress::rows);
    Statics expected = loads_in_front(others, dim, point, n);
    const certify::Balance balance =
        certify::balance<dim>(c.form, level.u, level.traction, point.head<dim>());
    for (const certify::BalanceRow& row : balance.rows)
    {
      if (row.kind != certify::BalanceKind::contact) continue;
      for (int i = 0; i < dim; ++i) expected.force[i] += row.force[i];
      for (int i = dim == 2 ? 2 : 0; i < 3; ++i) expected.moment[i] += row.moment[dim == 2 ? 0 : i];
    }
    expect_statics<dim>(io::read_sections<dim>(c.form, level, std::vector{section<dim>(point, n)})[0],
                        expected.force, expected.moment, 1);
  }
}

TEST(Section, IsInEquilibriumAtEveryIterate)
{
  expect_equilibrium_of_iterates<2>();
  expect_equilibrium_of_iterates<3>();
}

/// Two blocks on each other: a plane along their interface has what the upper one carries, and a plane across
/// both has the loads of both.
TEST(Section, CutsAllBodies)
{
  const DiscreteProblem<2> c(
      matching_blocks<2>(),
      {.boundaries = {clamped<2>("left"), loaded<2>("top", 0.05, formula("-0.2 - 0.1*x")),
                      clamped<2>("left_below"), loaded<2>("right_below", 0.03, 0.02)},
       .pairs = {pair<2>("bottom", "top_below", Tresca(0.01))}},
      {.degree = 2});
  const adapt::CertifiedLevel<2> level = observed(c, certify::PatchStress::rows);
  const std::vector sections = {section<2>({1.3, 0, 0}, {1, 0.25, 0}), section<2>({1, 0, 0}, {0, 1, 0}),
                                section<2>({1, 1, 0}, {0, 1, 0})};
  const auto found = io::read_sections<2>(c.form, level, sections);
  // in front of the first: top from x = 1.05, right below
  const double from = 1.05;
  const double width = 2 - from;
  const Point<3> top(0.05 * width, -0.2 * width - 0.05 * (4 - from * from), 0);
  const double lever =
      -0.2 * (4 - from * from) / 2 - 0.1 * (8 - std::pow(from, 3)) / 3;  // of the top about x = 0
  const double moment = lever - 1.3 * top[1] - 1 * top[0] + (0.7 * 0.02 + 0.5 * 0.03);
  expect_statics<2>(found[0], {top[0] + 0.03, top[1] + 0.02, 0}, {0, 0, moment}, 1);
  const certify::Balance balance = certify::balance<2>(c.form, level.u, level.traction, {1, 0});
  for (const certify::BalanceRow& row : balance.rows)
  {
    if (row.kind != certify::BalanceKind::contact || row.name != "top_below") continue;
    expect_statics<2>(found[1], {row.force[0], row.force[1], 0}, {0, 0, row.moment[0]}, 1);
  }
  // along the loaded side: its load
  expect_statics<2>(found[2], {0.1, -0.6, 0}, {0, 0, -0.2 * 2 - 0.1 * 8 / 3 + 0.6}, 1);
}

/// Two columns side by side; `within` chooses one of them.
TEST(Section, CanBeOfAPart)
{
  const DiscreteProblem<2> c(
      side_by_side(box<2>({0, 0}, {1, 2}, {2, 4}), box<2>({3, 0}, {4, 2}, {2, 4}), " b"),
      {.boundaries = {clamped<2>("bottom"), loaded<2>("top", 0.02, -0.1), clamped<2>("bottom b"),
                      loaded<2>("top b", 0, -0.3)}},
      {.degree = 2});
  const adapt::CertifiedLevel<2> level = observed(c, certify::PatchStress::rows);
  std::vector sections(3, section<2>({0, 0.8, 0}, {0, 1, 0}));
  sections[1].within = formula("2 - x");
  sections[2].within = formula("x - 2");
  const auto found = io::read_sections<2>(c.form, level, sections);
  expect_statics<2>(found[0], {0.02, -0.4, 0}, {0, 0, -0.05 - 0.3 * 3.5 - 0.02 * 1.2}, 1);
  expect_statics<2>(found[1], {0.02, -0.1, 0}, {0, 0, -0.05 - 0.02 * 1.2}, 1);
  expect_statics<2>(found[2], {0, -0.3, 0}, {0, 0, -0.3 * 3.5}, 1);
  EXPECT_NEAR(found[0].measure, 2, 1e-13);
  EXPECT_NEAR(found[2].measure, 1, 1e-13);
  EXPECT_NEAR(found[2].N, -0.3, 1e-10);
}

TEST(Section, MustMeetTheBody)
{
  const mesh::Mesh<2> mesh(block<2>({4, 2}));
  const auto message = [&](const io::Section<2>& of)
  {
    try
    {
      io::check_sections<2>(mesh, std::vector{of});
    }
    catch (const InputError& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(section<2>({1, 0.3, 0}, {1, 0, 0})), "");
  EXPECT_EQ(message(section<2>({0, 1, 0}, {0, 1, 0})), "");  // the top, from within
  EXPECT_THAT(message(section<2>({0, 1, 0}, {0, -1, 0})), HasSubstr("section.cut: cuts no cell"));
  EXPECT_THAT(message(section<2>({3, 0, 0}, {1, 0, 0})), HasSubstr("cuts no cell"));
  io::Section<2> nowhere = section<2>({1, 0.3, 0}, {1, 0, 0});
  nowhere.within = formula("y - 1");
  EXPECT_THAT(message(nowhere), HasSubstr("has no part where within is positive"));
}

}  // namespace

}  // namespace tribound::test
