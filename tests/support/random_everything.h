#pragma once

/// @file random_everything.h
/// Random problems in which all that a case may contain occurs together: one body or a pair, sheared and
/// turned, with supports, springs, sliders, contact, loads, initial stress and temperature.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/problem/quantity.h"

namespace tribound::test
{

/// What the data may be.
enum class Roughness
{
  any,       ///< formulas with jumps, kinks and waves
  enclosed,  ///< where bounds of the energy error are for interpolated data, polynomials of the degree p
};

template <int dim>
class RandomEverything
{
 public:
  /// p: the degree of the method.
  RandomEverything(unsigned seed, int p, Roughness roughness)
      : random_(seed),
        degree_(p),
        is_any_(roughness == Roughness::any),
        has_rough_loads_(is_any_ || happens(3))
  {
  }

  struct Made
  {
    mesh::MeshData<dim> mesh;
    ProblemData<dim> data;
    bool matches = true;  ///< the facets of the pair, if there is one
  };

  [[nodiscard]] Made make()
  {
    const bool is_pair = happens(2);
    Made made{.mesh = {}, .data = {.boundaries = {}}, .matches = happens(2)};
    made.mesh = mesh(is_pair, made.matches);
    choose_displacement();
    const bool is_tied = is_pair && add_pair(made);
    add_body(made.data, "", is_pair, is_tied);
    if (is_pair) add_body(made.data, "_below", true, false);
    return made;
  }

  [[nodiscard]] bool happens(unsigned once_in) { return random_() % once_in == 0; }
  [[nodiscard]] double between(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  [[nodiscard]] unsigned pick(unsigned n) { return random_() % n; }

  // the body

  [[nodiscard]] std::array<int, dim> cells()
  {
    std::array<int, dim> n;
    for (int& of_axis : n) of_axis = 1 + static_cast<int>(pick(2));
    n[0] += dim == 2 ? static_cast<int>(pick(3)) : 0;
    return n;
  }

  /// Inner vertices moved; then an affine map, so that sides stay plane.
  [[nodiscard]] mesh::MeshData<dim> mesh(bool is_pair, bool matches)
  {
    const std::array<int, dim> n = cells();
    const Point<dim> upper = Point<dim>::Ones() + Point<dim>::Unit(0);
    mesh::MeshData<dim> made = box<dim>(Point<dim>::Zero(), upper, n);
    bool overhangs = false;
    if (is_pair)
    {
      Point<dim> from = -Point<dim>::Unit(1);
      Point<dim> to = upper - Point<dim>::Unit(1);
      overhangs = !matches && happens(2);
      if (overhangs) from[0] += between(-0.6, 0.6);
      if (overhangs) to[0] += between(-0.3, 0.7);
      made = side_by_side(std::move(made), box<dim>(from, to, matches ? n : cells()), "_below");
      made.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
    }
    const double phase = between(0, 6);
    if (!overhangs)
      made = mapped<dim>(std::move(made),
                         [&](const Point<dim>& x) -> Point<dim>
                         {
                           Point<dim> y = x;
                           for (int a = 0; a < dim; ++a)
                             y[a] += 0.08 * std::sin(std::numbers::pi * x[a] / (a == 0 ? 2 : 1)) *
                                     std::cos(2 * x[(a + 1) % dim] + a + phase);
                           return y;
                         });
    choose_map();
    return renumbered(
        mapped<dim>(std::move(made), [&](const Point<dim>& x) -> Point<dim> { return map_ * x; }), pick(100));
  }

  void choose_map()
  {
    Tensor<dim> shear = Tensor<dim>::Identity();
    if (happens(2))
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b) shear(a, b) = a == b ? between(0.6, 1.5) : between(-0.2, 0.2);
    map_ = happens(2) ? Tensor<dim>(rotation<dim>() * shear) : shear;
  }

  /// The outward normal of a side of the box.
  [[nodiscard]] Point<dim> normal(const std::string& side) const
  {
    const auto name = side.substr(0, side.find('_'));
    const auto at = std::ranges::find(side_names<dim>, name) - side_names<dim>.begin();
    const Point<dim> before = (at % 2 == 0 ? -1.0 : 1.0) * Point<dim>::Unit(at / 2);
    return (map_.inverse().transpose() * before).normalized();
  }

  [[nodiscard]] problem::Region<dim> region(const std::string& name)
  {
    const std::array<double, 6> ratios = {-0.3, 0, 0.2, 0.3, 0.45, 0.49};
    const auto plane = dim == 2 && happens(4) ? problem::PlaneModel::stress : problem::PlaneModel::strain;
    const double E = happens(2) ? 1 : std::pow(10, between(-1.5, 1.5));
    problem::Region<dim> region{.name = name, .material = lame(E, ratios[pick(ratios.size())], plane)};
    for (problem::Field& f : region.body_force)
      if (happens(2)) f = datum(0.05 * E);
    if (happens(2))
    {
      region.material.expansion = 0.02;
      region.temperature = datum(1);
      if (happens(2)) region.reference_temperature = datum(1);
    }
    for (problem::Field& entry : region.initial_stress)
      if (happens(4)) entry = datum(0.02 * E);
    stiffness_ = E;
    return region;
  }

  // data

  /// A polynomial of this degree, of about the given size.
  [[nodiscard]] std::string polynomial(double size, int degree)
  {
    const std::array<const char*, 3> axes = {"x", "y", dim == 3 ? "z" : "x"};
    std::string text = fmt::format("{:.6g}", size * between(-1, 1));
    std::string powers;
    for (int k = 1; k <= degree; ++k)
    {
      powers += fmt::format("*{}", axes[pick(3)]);
      text += fmt::format(" + ({:.6g}){}", size * between(-0.5, 0.5), powers);
    }
    return text;
  }
  [[nodiscard]] std::string rough(double size)
  {
    const double c = between(-0.5, 1);
    const std::array<std::string, 7> shapes = {"sin(4*x + y)",
                                               "exp(x)*cos(2*y)",
                                               fmt::format("(x < {:.4g} ? 1 : -0.5)", c),
                                               fmt::format("(x + y < {:.4g} ? y : 0.3)", c),
                                               fmt::format("abs(y - {:.4g})", c),
                                               fmt::format("max(0, x - {:.4g})", c),
                                               "(x^5*y - x*y^3)/4"};
    return fmt::format("{:.6g}*{}", size * between(-1, 1), shapes[pick(shapes.size())]);
  }
  /// Loads, temperatures and stresses, which bounds enclose.
  [[nodiscard]] problem::Field datum(double size)
  {
    if (happens(3)) return size * between(-1, 1);
    return formula(has_rough_loads_ && happens(2) ? rough(size)
                                                  : polynomial(size, 1 + static_cast<int>(pick(4))));
  }
  /// For n at most `degree` a polynomial unless the data may be any; not negative.
  [[nodiscard]] problem::Field positive(double size, int degree)
  {
    const double c = between(-0.5, 1);
    const std::string value = fmt::format("{:.6g}", size);
    switch (pick(is_any_ ? 5 : 3))
    {
      case 0:
        return size;
      case 1:
        return formula(value + "*(1 + 0.1*x - 0.05*y)");
      case 2:
        return degree < 2 ? problem::Field(size) : formula(fmt::format("{}*(x - {:.4g})^2", value, c));
      case 3:
        return formula(fmt::format("x < {:.4g} ? {} : 0.1*{}", c, value, value));
      default:
        return formula(value + "*exp(0.5*x - 0.3*y)");
    }
  }

  /// One displacement for all supports, so that they agree where they meet.
  void choose_displacement()
  {
    for (std::string& component : displacement_) component = "0";
    if (happens(2)) return;
    for (std::string& component : displacement_)
      component = polynomial(0.01, 1) + (is_any_ && happens(3) ? " + " + rough(0.005) : "");
  }
  /// u_D . n
  [[nodiscard]] std::string along(const Point<dim>& n) const
  {
    std::string text = "0";
    for (int a = 0; a < dim; ++a) text += fmt::format(" + ({:.17g})*({})", n[a], displacement_[a]);
    return text;
  }

  // the boundary

  [[nodiscard]] problem::ContactLaw law()
  {
    switch (pick(3))
    {
      case 0:
        return Frictionless();
      case 1:
        return Tresca(positive(stiffness_ * std::pow(10, between(-3.5, -1.5)), degree_));
      default:
        return Coulomb(between(0, 1));
    }
  }
  /// What it has beside its law. The gap lets supports move as they do where they meet it.
  void complete(problem::Contact& contact, const std::string& supports)
  {
    contact.gap = formula(supports);
    if (happens(3)) contact.gap = formula(fmt::format("{} + {:.4g}", supports, between(0, 0.02)));
    if (is_any_ && happens(4)) contact.gap = formula(fmt::format("{} + {}", supports, rough(0.01)));
    if (is_any_ && happens(8)) contact.water.emplace(positive(0.03 * stiffness_, degree_));
  }
  /// Whether the upper body is tied to the lower one, which then holds it.
  [[nodiscard]] bool add_pair(Made& made)
  {
    const bool is_tied = happens(4);
    const bool slides = !is_tied && happens(6);
    made.data.pairs = {pair<dim>("bottom", "top_below",
                                 is_tied  ? problem::ContactLaw(Tied())
                                 : slides ? problem::ContactLaw(problem::Slider())
                                          : law())};
    if (is_tied || slides) return is_tied;
    problem::Contact& contact = made.data.pairs[0].contact;
    complete(contact, "0");
    if (happens(4)) contact.gap.reset();
    return false;
  }
  [[nodiscard]] problem::BoundaryCondition<dim> support(const std::string& name, bool is_complete)
  {
    problem::BoundaryCondition<dim> condition;
    condition.name = name;
    const auto only = static_cast<int>(pick(dim));
    for (int a = 0; a < dim; ++a)
      if (is_complete || a == only)
        condition.displacement[a] = formula(displacement_[a]);
      else
        condition.traction[a] = datum(0.03 * stiffness_);
    return condition;
  }
  /// Springs; such as hold a body where `holds`.
  void add_spring(problem::BoundaryCondition<dim>& condition, bool holds)
  {
    const double k = stiffness_ * std::pow(10, between(-1, 1.5));
    problem::Spring<dim> spring{holds ? problem::Field(k) : positive(k, 2), holds ? problem::Field(k / 3)
                                                                            : happens(2)
                                                                                ? problem::Field(0.0)
                                                                                : positive(k / 3, 2)};
    for (problem::Field& rest : spring.rest)
      if (happens(2)) rest = is_any_ ? datum(0.01) : formula(polynomial(0.01, 1));
    condition.spring = spring;
  }
  [[nodiscard]] problem::BoundaryCondition<dim> holder(const std::string& name)
  {
    const unsigned kind = pick(5);
    if (kind < 2) return support(name, true);
    problem::BoundaryCondition<dim> condition = kind == 2 ? support(name, false) : other(name, 1);
    add_spring(condition, true);
    return condition;
  }
  [[nodiscard]] problem::BoundaryCondition<dim> touching(const std::string& name)
  {
    problem::BoundaryCondition<dim> condition = obstacle<dim>(name, law());
    complete(*condition.contact, along(normal(name)));
    return condition;
  }
  [[nodiscard]] problem::BoundaryCondition<dim> other(const std::string& name, unsigned kind)
  {
    switch (kind)
    {
      case 0:
      case 1:
        return loaded<dim>(name, datum(0.05 * stiffness_), datum(0.05 * stiffness_),
                           datum(0.02 * stiffness_));
      case 2:
        return pressed<dim>(name, datum(0.05 * stiffness_));
      case 3:
        return touching(name);
      case 4:
        return obstacle<dim>(name, problem::Slider(), formula(along(normal(name))));
      case 5:
        return support(name, false);
      default:
      {
        problem::BoundaryCondition<dim> condition = other(name, 1);
        add_spring(condition, false);
        return condition;
      }
    }
  }
  void add_body(ProblemData<dim>& data, const std::string& suffix, bool is_pair, bool is_held)
  {
    data.regions.push_back(region("box" + suffix));
    std::vector<std::string> sides;
    for (const std::string side : side_names<dim>)
      if (!is_pair || side != (suffix.empty() ? "bottom" : "top")) sides.push_back(side + suffix);
    std::ranges::shuffle(sides, random_);
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (i == 0 && !is_held)
        data.boundaries.push_back(holder(sides[i]));
      else if (i == 1 && !is_pair)
        data.boundaries.push_back(touching(sides[i]));
      else if (!happens(5))
        data.boundaries.push_back(other(sides[i], pick(8)));
  }

  std::mt19937 random_;
  int degree_;
  bool is_any_;
  bool has_rough_loads_;
  Tensor<dim> map_;
  std::array<std::string, dim> displacement_;
  double stiffness_ = 1;  ///< of the region that was chosen last
};

/// All numbers that can be asked of a problem.
template <int dim>
[[nodiscard]] std::vector<problem::Quantity<dim>> all_quantities(const ProblemData<dim>& data)
{
  using problem::QuantityKind;
  const Point<dim> e = Point<dim>::Ones().normalized();
  std::vector<problem::Quantity<dim>> all = {{.name = "energy"},
                                             {.name = "work", .kind = QuantityKind::load_work}};
  const auto add = [&](QuantityKind kind, const std::string& boundary, const Point<dim>& direction)
  {
    all.push_back({.name = fmt::format("{} {}", problem::to_string(kind), boundary),
                   .kind = kind,
                   .boundary = boundary,
                   .direction = direction});
  };
  for (const problem::BoundaryCondition<dim>& boundary : data.boundaries)
  {
    add(QuantityKind::mean_displacement, boundary.name, e);
    if (boundary.spring) add(QuantityKind::spring_force, boundary.name, e);
    if (!boundary.contact) continue;
    add(QuantityKind::contact_force, boundary.name, e);
    add(QuantityKind::contact_moment, boundary.name, Point<dim>::Unit(dim - 1));
  }
  if (!data.pairs.empty()) add(QuantityKind::contact_force, "bottom", e);
  return all;
}

}  // namespace tribound::test
