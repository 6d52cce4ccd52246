#pragma once

/// @file random_quantities.h
/// Random problems, and quantities of their solutions with values computed by other code.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/meshes.h"
#include "support/random_cases.h"
#include "support/two_blocks.h"
#include "tribound/fem/evaluation.h"
#include "verification/quantities.h"

namespace tribound::test
{

/// A block of random material, shape, mesh and loads. Its left or upper side is held, sometimes with a given
/// motion. It stands on an obstacle with a gap, or on another block, which is held below and matches or not.
template <int dim>
struct RandomCase
{
  std::mt19937 random;
  bool is_on_another = false;
  bool matches = true;
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
    const std::string load = fmt::format("{}*x^2*y", between(-0.3, 0.1));
    ProblemData<dim> data{.boundaries = {fixed<dim>(held, 0.5 * moved, moved),
                                         loaded<dim>(is_held_above ? "left" : "top", between(-0.05, 0.05),
                                                     between(-0.2, 0.01), between(-0.05, 0.05)),
                                         loaded<dim>("right", between(-0.1, 0.1), between(-0.1, 0.1))},
                          .body_force = components<dim, problem::Field>(
                              formula(fmt::format("{}", between(-0.1, 0.1))), formula(load), 0.0)};
    data.material = problem::lame(1, ratios[random() % ratios.size()]);
    if (!is_on_another)
    {
      data.boundaries.push_back(obstacle<dim>("bottom", law, gap));
      return data;
    }
    const bool is_tied = happens(3) && (dim == 2 || matches);
    data.pairs = {pair<dim>("bottom", "top_below", is_tied ? problem::ContactLaw(problem::Tied()) : law)};
    if (!is_tied) data.pairs[0].contact.gap = gap;
    data.boundaries.push_back(clamped<dim>("bottom_below"));
    data.boundaries.push_back(loaded<dim>("right_below", between(-0.1, 0.1), between(-0.1, 0.1)));
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
    return renumbered(mapped<dim>(!is_on_another ? block<dim>({n, 2}, {2, 1, 1})
                                  : matches      ? matching_blocks<dim>()
                                                 : two_blocks<dim>(),
                                  map),
                      11);
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

/// Quantities of a random block, and their values for a discrete solution by other code.
template <int dim>
struct Asked
{
  Quantities<dim> quantities;
  std::vector<std::function<double(const DiscreteProblem<dim>&, std::span<const double>)>> values;

  explicit Asked(bool is_held_above, bool is_on_another = false)
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
    for (const char* const name : {"right", "bottom", "top_below"})
    {
      if (!is_on_another && std::string_view(name) == "top_below") continue;
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

}  // namespace tribound::test
