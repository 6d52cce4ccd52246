#pragma once

/// @file problem_data.h
/// Problems as values, in few words: what the body is made of and what holds on its boundaries.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/problem/problem.h"

namespace tribound::test
{

using problem::Coulomb;
using problem::Frictionless;
using problem::lame;
using problem::Tied;
using problem::Tresca;

/// A component of the displacement that is not prescribed.
inline constexpr std::nullopt_t free = std::nullopt;

/// The text stands for the place of the formula in messages, too.
[[nodiscard]] inline problem::Field formula(const std::string& text)
{
  return {text, Where{.file = {}, .key = text}};
}

/// The components of a vector; z counts in 3D only.
template <int dim, class Component = problem::Field>
[[nodiscard]] std::array<Component, dim> components(Component x, Component y, Component z)
{
  if constexpr (dim == 2)
    return {std::move(x), std::move(y)};
  else
    return {std::move(x), std::move(y), std::move(z)};
}

/// u_D on a boundary.
template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> fixed(const std::string& name, std::optional<problem::Field> x,
                                                    std::optional<problem::Field> y,
                                                    std::optional<problem::Field> z = 0.0)
{
  return problem::with_displacement<dim>(name, components<dim>(std::move(x), std::move(y), std::move(z)));
}

/// u_D = 0 on a boundary.
template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> clamped(const std::string& name)
{
  return fixed<dim>(name, 0.0, 0.0);
}

/// g_N on a boundary, beside what `condition` fixes there.
template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> loaded(problem::BoundaryCondition<dim> condition,
                                                     problem::Field x, problem::Field y,
                                                     problem::Field z = 0.0)
{
  condition.traction = components<dim>(std::move(x), std::move(y), std::move(z));
  return condition;
}

/// g_N on a boundary.
template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> loaded(const std::string& name, problem::Field x,
                                                     problem::Field y, problem::Field z = 0.0)
{
  return problem::with_traction<dim>(name, components<dim>(std::move(x), std::move(y), std::move(z)));
}

/// g_N = -pressure n on a boundary.
template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> pressed(const std::string& name, const problem::Field& pressure)
{
  problem::BoundaryCondition<dim> condition;
  condition.name = name;
  condition.pressure = pressure;
  return condition;
}

/// Contact on a boundary, called in messages as in a case file.
template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> obstacle(const std::string& name,
                                                       problem::ContactLaw law = Frictionless(),
                                                       problem::Field gap = 0.0)
{
  problem::BoundaryCondition<dim> condition =
      problem::with_contact<dim>(name, std::move(law), std::move(gap));
  condition.where.key = "boundary." + name;
  return condition;
}

template <int dim>
[[nodiscard]] problem::BoundaryCondition<dim> obstacle(const std::string& name,
                                                       const problem::Contact& contact)
{
  return obstacle<dim>(name, contact.law, *contact.gap);
}

/// Contact between bodies without a gap.
template <int dim>
[[nodiscard]] problem::ContactPair<dim> pair(const std::string& slave, const std::string& master,
                                             problem::ContactLaw law = Frictionless())
{
  return {.slave = {slave},
          .master = {master},
          .contact = problem::Contact(std::move(law)),
          .pairing = {},
          .where = {.file = {}, .key = "contact"}};
}

/// A problem before it meets a mesh. No member is initialised with {}: GCC 12 ends there with an internal
/// error.
template <int dim>
struct ProblemData
{
  std::vector<problem::BoundaryCondition<dim>> boundaries;
  problem::Material material = lame(1.0, 0.3);  ///< of every region without an entry of its own
  std::array<problem::Field, dim> body_force;   ///< the same
  std::vector<problem::Region<dim>> regions;    ///< those with an entry of their own
  std::vector<problem::ContactPair<dim>> pairs;

  template <class Mesh>
  [[nodiscard]] problem::Problem<dim> on(const Mesh& mesh) const
  {
    std::vector<problem::Region<dim>> all = regions;
    all.push_back({.name = {}, .material = material, .body_force = body_force});
    return {mesh, all, boundaries, pairs};
  }
};

/// Clamped on the left, pressed down on top, pulled at the right side, in 3D obliquely, on an obstacle below:
/// the data of problem T2D and its sibling in 3D.
template <int dim>
[[nodiscard]] ProblemData<dim> pressed_block(problem::ContactLaw law = Tresca(0.03))
{
  return {.boundaries = {clamped<dim>("left"), loaded<dim>("top", 0, -0.1),
                         loaded<dim>("right", 0.04, 0.06, 0.02), obstacle<dim>("bottom", std::move(law))}};
}

}  // namespace tribound::test
