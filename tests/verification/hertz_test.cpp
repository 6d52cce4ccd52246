/// @file hertz_test.cpp
/// The Hertz examples against half-space theory, and SSNV128 against its published displacements. The case
/// files of the examples themselves are solved; what is printed is in their README.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "support/discrete_case.h"

namespace tribound::test
{

namespace
{

using std::numbers::pi;

constexpr double E = 200000;  ///< MPa, as in both Hertz examples
constexpr double nu = 0.3;
constexpr double R = 10;  ///< mm

Config example(const std::string& name)
{
  return read_config(std::filesystem::path(EXAMPLES) / name / "case.toml");
}

template <int dim>
NewtonResult<dim> converged(const DiscreteCase<dim>& c)
{
  NewtonResult<dim> newton = c.solve();
  EXPECT_EQ(newton.status, NewtonStatus::converged) << newton.message;
  fmt::print("{} dofs, {} contact facets, {} Newton steps\n", c.space.n_dofs(),
             c.form.contact_facets().size(), newton.steps.size());
  return newton;
}

/// Hertz's pressure p(r) = p0 (1 - (r/a)^2)^(1/2) for r < a.
struct Hertz
{
  double a;   ///< radius or half width of the contact
  double p0;  ///< largest pressure

  [[nodiscard]] double pressure(double r) const { return r < a ? p0 * std::sqrt(1 - r * r / (a * a)) : 0; }
};

/// P: force per length.
Hertz cylinder_theory(double P)
{
  const double a = std::sqrt(4 * P * R * (1 - nu * nu) / (pi * E));
  return {a, 2 * P / (pi * a)};
}

Hertz sphere_theory(double F)
{
  const double a = std::cbrt(3 * F * R * (1 - nu * nu) / (4 * E));
  return {a, 3 * F / (2 * pi * a * a)};
}

/// The pressure at one point of the contact boundary, and its share of the boundary's measure.
struct Sample
{
  double r;
  double pressure;
  double weight;
};

/// At the quadrature points of the contact boundary, r the distance from the axis x = 0 (2D) or x = z = 0
/// (3D).
template <int dim>
std::vector<Sample> pressure_samples(const DiscreteCase<dim>& c, std::span<const double> u)
{
  const Quadrature<dim - 1>& rule = c.form.facet_rule();
  const auto table = tabulate_on_facets<dim>(c.space.basis(), rule.points);
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < c.form.contact_facets().size(); ++k)
  {
    const double scale = c.form.contact_facets()[k].geometry.measure * (dim - 1);
    const auto states = c.form.contact_states(u, static_cast<int>(k), table);
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim>& x = states[q].point;
      const double r = dim == 2 ? std::abs(x[0]) : std::hypot(x[0], x[dim - 1]);
      samples.push_back({r, states[q].pressure, scale * rule.weights[q]});
    }
  }
  return samples;
}

/// The a and p0 of the profile p^2 = p0^2 (1 - (r/a)^2) that fits the samples with r < r_max best (least
/// squares).
Hertz fitted(std::span<const Sample> samples, double r_max)
{
  double w = 0, x = 0, xx = 0, y = 0, xy = 0;
  for (const Sample& s : samples)
  {
    if (s.r > r_max) continue;
    const double r2 = s.r * s.r;
    const double p2 = s.pressure * s.pressure;
    w += s.weight;
    x += s.weight * r2;
    xx += s.weight * r2 * r2;
    y += s.weight * p2;
    xy += s.weight * r2 * p2;
  }
  const double slope = (w * xy - x * y) / (w * xx - x * x);
  const double p2_at_0 = (y - slope * x) / w;
  return {std::sqrt(-p2_at_0 / slope), std::sqrt(p2_at_0)};
}

/// The measure of the part of the contact boundary that is closed.
double closed_measure(std::span<const Sample> samples)
{
  double sum = 0;
  for (const Sample& s : samples)
    if (s.pressure > 0) sum += s.weight;
  return sum;
}

/// Root of the mean of (p - p_theory)^2 over r < r_max, over p0.
double mean_deviation(std::span<const Sample> samples, const Hertz& theory, double r_max)
{
  double sum = 0;
  double weight = 0;
  for (const Sample& s : samples)
  {
    if (s.r > r_max) continue;
    sum += s.weight * std::pow(s.pressure - theory.pressure(s.r), 2);
    weight += s.weight;
  }
  return std::sqrt(sum / weight) / theory.p0;
}

/// Means over rings of width a/10.
void print_profile(std::span<const Sample> samples, const Hertz& theory)
{
  fmt::print("{:>10} {:>10} {:>10}\n", "r/a", "p/p0", "theory");
  for (int ring = 0; ring < 11; ++ring)
  {
    double weight = 0, p = 0, expected = 0;
    for (const Sample& s : samples)
    {
      if (static_cast<int>(10 * s.r / theory.a) != ring) continue;
      weight += s.weight;
      p += s.weight * s.pressure;
      expected += s.weight * theory.pressure(s.r);
    }
    fmt::print("{:>10.2f} {:>10.4f} {:>10.4f}\n", 0.1 * ring + 0.05, p / weight / theory.p0,
               expected / weight / theory.p0);
  }
}

void print_comparison(const std::string& what, double computed, double theory)
{
  fmt::print("{:<32} {:>10.4f} {:>10.4f} {:>+8.2f} %\n", what, computed, theory,
             100 * (computed / theory - 1));
}

template <int dim>
double largest_facet_in_contact(const DiscreteCase<dim>& c, double a)
{
  double largest = 0;
  for (const ContactFacet<dim>& facet : c.form.contact_facets())
  {
    const auto vertices = facet_vertices(c.mesh.cell(facet.facet.cell), facet.facet.local);
    const bool near =
        std::ranges::any_of(vertices, [&](Index v) { return c.mesh.vertex(v).norm() < 1.1 * a; });
    if (near) largest = std::max(largest, facet.geometry.diameter);
  }
  return largest;
}

/// Compares profile and radius; `closed_radius` is the radius of the closed part of the boundary.
template <int dim>
void compare(const DiscreteCase<dim>& c, std::span<const Sample> samples, const Hertz& theory,
             double closed_radius, double p0_tolerance)
{
  const double h = largest_facet_in_contact(c, theory.a);
  const Hertz fit = fitted(samples, 0.8 * theory.a);
  const double deviation = mean_deviation(samples, theory, 0.9 * theory.a);
  fmt::print("facets of size {:.4f} = a/{:.1f}\n{:<32} {:>10} {:>10}\n", h, theory.a / h, "", "computed",
             "theory");
  print_comparison("p0 (fit over r < 0.8 a)", fit.p0, theory.p0);
  print_comparison("a (fit over r < 0.8 a)", fit.a, theory.a);
  print_comparison("a (closed part)", closed_radius, theory.a);
  fmt::print("mean deviation of p for r < 0.9 a: {:.2f} % of p0\n", 100 * deviation);
  print_profile(samples, theory);

  EXPECT_NEAR(fit.p0, theory.p0, p0_tolerance * theory.p0);
  EXPECT_NEAR(fit.a, theory.a, p0_tolerance * theory.a);
  EXPECT_NEAR(closed_radius, theory.a, h);
  EXPECT_LE(deviation, p0_tolerance);
}

TEST(Hertz, Cylinder)
{
  const DiscreteCase<2> c(example("03b_hertz_cylinder"));
  const NewtonResult<2> newton = converged(c);
  const double half = -contact_resultants<2>(c.form, newton.traction).normal;
  EXPECT_NEAR(half, 2000, 1e-6 * half);
  const std::vector<Sample> samples = pressure_samples(c, newton.u);
  compare(c, samples, cylinder_theory(2 * half), closed_measure(samples), 0.01);
}

TEST(Hertz, Sphere)
{
  const DiscreteCase<3> c(example("03_hertz_sphere"));
  const NewtonResult<3> newton = converged(c);
  const double quarter = -contact_resultants<3>(c.form, newton.traction).normal;
  EXPECT_NEAR(quarter, 100 * pi * R * R / 4,
              5e-3 * quarter);  // straight facets leave out a part of the loaded disc
  const std::vector<Sample> samples = pressure_samples(c, newton.u);
  compare(c, samples, sphere_theory(4 * quarter), std::sqrt(4 * closed_measure(samples) / pi), 0.03);
}

/// u_x at the node of the base y = 0 next to x.
double base_displacement(const DiscreteCase<2>& c, std::span<const double> u, double x)
{
  const std::vector<Point<2>> nodes = c.space.node_points();
  const auto distance = [&](const Point<2>& node) { return (node - Point<2>(x, 0)).norm(); };
  const auto nearest = std::ranges::min_element(nodes, {}, distance) - nodes.begin();
  return u[2 * nearest];
}

TEST(Ssnv128, HorizontalDisplacementOfTheBase)
{
  const DiscreteCase<2> c(example("04_ssnv128"));
  const NewtonResult<2> newton = converged(c);
  struct Published
  {
    double x;    ///< mm
    double u_x;  ///< 1e-5 m
  };
  constexpr std::array<Published, 5> published = {
      {{0, 2.86}, {1.25, 2.72}, {5, 2.28}, {7.5, 1.98}, {11.25, 1.5}}};
  for (const auto& [x, u_x] : published)
  {
    const double computed = base_displacement(c, newton.u, 1e-3 * x) * 1e5;
    print_comparison(fmt::format("u_x at x = {} mm, 1e-5 m", x), computed, u_x);
    EXPECT_NEAR(computed, u_x, 0.05 * u_x);
  }
}

}  // namespace

}  // namespace tribound::test
