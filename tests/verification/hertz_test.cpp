/// @file hertz_test.cpp
/// The Hertz examples against half-space theory, and SSNV128 against its published displacements. The
/// examples themselves are run, adaptively; the printed numbers are in their README.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "support/contact_points.h"
#include "tribound/adapt/loop.h"
#include "tribound/case/resolve.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/import/read.h"

namespace tribound::test
{

namespace
{

using std::numbers::pi;

constexpr double E = 200000;  ///< MPa, as in both Hertz examples
constexpr double nu = 0.3;
constexpr double R = 10;  ///< mm

case_file::Config example(const std::string& name)
{
  return case_file::read_config(std::filesystem::path(EXAMPLES) / name / "case.toml");
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

/// The pressure at one point of the contact boundary, and the point's share of the boundary's measure.
struct Sample
{
  double r;
  double pressure;
  double weight;
};

/// Samples at the contact points; r is the distance from the axis x = 0 (2D) or x = z = 0 (3D).
template <int dim>
std::vector<Sample> pressure_samples(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  const std::span<const contact::ContactPoint<dim>> points = form.contact_points();
  const std::vector<contact::ContactState<dim>> states = contact_states(form, u);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Point<dim>& x = points[i].x;
    const double r = dim == 2 ? std::abs(x[0]) : std::hypot(x[0], x[dim - 1]);
    samples.push_back({r, states[i].pressure, points[i].weight});
  }
  return samples;
}

/// The largest contact facet with a point at r < r_max.
template <int dim>
double largest_facet(const contact::NitscheForm<dim>& form, double r_max)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  double largest = 0;
  for (const contact::ContactSegment<dim>& segment : form.segments())
  {
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
    if (std::ranges::any_of(vertices, [&](Index v) { return mesh.vertex(v).norm() < r_max; }))
      largest = std::max(largest, segment.h);
  }
  return largest;
}

/// Runs the example as the program does; `look` is called with every level, the last one last.
template <int dim>
void run_example(const case_file::Config& config,
                 const std::function<void(const adapt::LevelView<dim>&)>& look)
{
  mesh::Mesh<dim> mesh = std::get<mesh::Mesh<dim>>(mesh::read_mesh(config.mesh));
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  auto first = std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, config.method);
  const auto show = [&](const adapt::LevelView<dim>& view)
  {
    fmt::print("level {}: {} cells, {} contact facets, {} Newton steps, bound {:.3g} %\n", view.number,
               view.discrete.mesh.n_cells(), view.discrete.form.segments().size(), view.level.steps.size(),
               100 * view.level.estimate.total_sharp / view.level.norms.sigma);
    look(view);
  };
  const certify::Verdict verdict =
      adapt::adapt<dim>(problem, config.method, config.adapt, std::move(first), {{}, show}, false);
  EXPECT_EQ(verdict.status, certify::RunStatus::certified) << verdict.reason;
}

/// The contact boundary of the last level.
struct ContactZone
{
  double force = 0;  ///< -(integral of T^n)
  double h = 0;      ///< the largest facet in contact
  std::vector<Sample> samples;
};

template <int dim>
ContactZone contact_zone(const case_file::Config& config, double a)
{
  ContactZone zone;
  run_example<dim>(config,
                   [&](const adapt::LevelView<dim>& view)
                   {
                     const contact::NitscheForm<dim>& form = view.discrete.form;
                     const auto t = form.traction(view.level.u);
                     zone = {-contact::contact_resultants<dim>(form, t).normal, largest_facet(form, a),
                             pressure_samples(form, view.level.u)};
                   });
  return zone;
}

/// The a and p0 of the profile p^2 = p0^2 (1 - (r/a)^2), fitted by least squares to the samples with
/// r < r_max.
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

/// The measure of the closed part of the contact boundary.
double closed_measure(std::span<const Sample> samples)
{
  double sum = 0;
  for (const Sample& s : samples)
    if (s.pressure > 0) sum += s.weight;
  return sum;
}

/// The root mean square of p - p_theory over r < r_max, divided by p0.
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

/// Compares profile and radius; `closed_radius` is the radius of the closed part of the boundary.
void compare(const ContactZone& zone, const Hertz& theory, double closed_radius, double tolerance)
{
  const Hertz fit = fitted(zone.samples, 0.8 * theory.a);
  const double deviation = mean_deviation(zone.samples, theory, 0.9 * theory.a);
  fmt::print("facets in contact up to {:.4f} = a/{:.1f}\n{:<32} {:>10} {:>10}\n", zone.h, theory.a / zone.h,
             "", "computed", "theory");
  print_comparison("p0 (fit over r < 0.8 a)", fit.p0, theory.p0);
  print_comparison("a (fit over r < 0.8 a)", fit.a, theory.a);
  print_comparison("a (closed part)", closed_radius, theory.a);
  fmt::print("mean deviation of p for r < 0.9 a: {:.2f} % of p0\n", 100 * deviation);
  print_profile(zone.samples, theory);

  EXPECT_NEAR(fit.p0, theory.p0, tolerance * theory.p0);
  EXPECT_NEAR(fit.a, theory.a, tolerance * theory.a);
  EXPECT_NEAR(closed_radius, theory.a, zone.h);
  EXPECT_LE(deviation, tolerance);
}

TEST(Hertz, Cylinder)
{
  const Hertz whole = cylinder_theory(4000);
  const ContactZone zone = contact_zone<2>(example("03b_hertz_cylinder"), whole.a);
  EXPECT_NEAR(zone.force, 2000, 1e-4 * zone.force);
  compare(zone, cylinder_theory(2 * zone.force), closed_measure(zone.samples), 0.01);
}

TEST(Hertz, Sphere)
{
  const Hertz whole = sphere_theory(100 * pi * R * R);
  const ContactZone zone = contact_zone<3>(example("03_hertz_sphere"), whole.a);
  EXPECT_NEAR(zone.force, 100 * pi * R * R / 4,
              2e-2 * zone.force);  // straight facets leave out part of the loaded disc
  compare(zone, sphere_theory(4 * zone.force), std::sqrt(4 * closed_measure(zone.samples) / pi), 0.03);
}

/// u_x on the base y = 0, piecewise linear between the quadrature points (and beyond the outermost ones).
double base_displacement(const contact::NitscheForm<2>& form, std::span<const double> u, double x)
{
  std::vector<std::pair<double, double>> points;
  for (const contact::ContactState<2>& state : contact_states(form, u))
    points.emplace_back(state.point[0], state.slip[0]);
  std::ranges::sort(points);
  const auto after = std::ranges::upper_bound(points, std::pair(x, 0.0));
  const auto i = std::clamp<std::ptrdiff_t>(after - points.begin(), 1, std::ssize(points) - 1);
  const auto& [x0, u0] = points[i - 1];
  const auto& [x1, u1] = points[i];
  return u0 + (u1 - u0) * (x - x0) / (x1 - x0);
}

TEST(Ssnv128, HorizontalDisplacementOfTheBase)
{
  constexpr std::array<double, 5> x = {0, 1.25, 5, 7.5, 11.25};               // mm
  constexpr std::array<double, 5> published = {2.86, 2.72, 2.28, 1.98, 1.5};  // 1e-5 m
  std::array<double, 5> computed{};
  run_example<2>(example("04_ssnv128"),
                 [&](const adapt::LevelView<2>& view)
                 {
                   for (std::size_t i = 0; i < x.size(); ++i)
                     computed[i] = 1e5 * base_displacement(view.discrete.form, view.level.u, 1e-3 * x[i]);
                 });
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    print_comparison(fmt::format("u_x at x = {} mm, 1e-5 m", x[i]), computed[i], published[i]);
    EXPECT_NEAR(computed[i], published[i], 0.05 * published[i]);
  }
}

}  // namespace

}  // namespace tribound::test
