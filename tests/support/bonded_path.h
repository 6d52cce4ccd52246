#pragma once

/// @file bonded_path.h
/// A block peeled off what it is bonded to, pushed back, sheared and peeled again: a load path for tests.

#include <vector>

#include "support/problem_data.h"
#include "support/two_blocks.h"
#include "tribound/adapt/load_path.h"

namespace tribound::test
{

/// Laws with every way to break, for E = 1.
[[nodiscard]] inline std::vector<problem::ContactLaw> bonded_laws()
{
  using problem::Unloading;
  return {problem::JointLaw({.tension = {0.05, 0.003}, .coefficient = 0.5}),
          problem::JointLaw({.tension = {0.04, 0.003, Unloading::vertical},
                             .cohesion = 0.05,
                             .slip_length = 0.08,
                             .coefficient = 0.6},
                            0.01),
          problem::JointLaw({.cohesion = 0.02, .coefficient = 0.4}),
          problem::MixedLaw({.tension = {0.05, 0.003}, .shear_ratio = 0.9, .coefficient = 0.5}),
          problem::EndoLaw({5, 4, 0.8, 0.3, 0.12, 0.003}),
          Coulomb(0.4)};
}

/// Values of t, one for each step.
inline constexpr std::array path_of_t = {0.5, 1.1, 0.4, -0.8, 1.5};

/// Integrals over the contact boundary after a step.
struct InterfaceIntegrals
{
  double damage = 0;
  double slipped = 0;
  double dissipated = 0;  ///< in the step
  double stored = 0;
};

template <int dim>
[[nodiscard]] InterfaceIntegrals integrals(const adapt::LoadStep<dim>& step)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  std::array<double, 4> sums{};
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
  {
    const double weight = form.contact_points()[i].weight;
    const problem::InterfaceResponse<dim>& response = step.responses[i];
    sums[0] += weight * response.state.damage;
    sums[1] += weight * response.state.slipped;
    sums[2] += weight * response.dissipated;
    sums[3] += weight * response.stored;
  }
  form.space().mesh().ranks().sum(std::span(sums));
  return {sums[0], sums[1], sums[2], sums[3]};
}

/// On the block of `block()`, or on two blocks where `pairs`.
template <int dim>
[[nodiscard]] ProblemData<dim> peeled(problem::ContactLaw law, bool pairs)
{
  std::array<std::optional<problem::Field>, dim> lifted;
  std::array<problem::Field, dim> pulled;
  lifted[0] = formula("0.015*t*x");
  lifted[1] = formula("0.045*t*x");
  pulled[0] = formula("0.01*t");
  if constexpr (dim == 3) lifted[2] = formula("0.01*t*x*z");
  ProblemData<dim> data{.boundaries = {clamped<dim>("left"), problem::with_displacement<dim>("top", lifted),
                                       problem::with_traction<dim>("right", pulled)}};
  if (!pairs)
  {
    data.boundaries.push_back(obstacle<dim>("bottom", std::move(law)));
    return data;
  }
  data.boundaries.push_back(clamped<dim>("bottom_below"));
  data.regions = {{.name = "box_below", .material = lame(3, 0.2)}};
  data.pairs = {pair<dim>("bottom", "top_below", std::move(law))};
  return data;
}

/// The same with water from the end that is peeled off: t is its level, with a drain, and full in the crack,
/// part of which is there from the beginning.
template <int dim>
[[nodiscard]] ProblemData<dim> peeled_under_water(problem::ContactLaw law, bool pairs)
{
  ProblemData<dim> data = peeled<dim>(std::move(law), pairs);
  problem::Contact& contact = pairs ? data.pairs[0].contact : *data.boundaries.back().contact;
  const auto place = [](double x)
  {
    std::vector<double> point(dim, 0.0);
    point[0] = x;
    return point;
  };
  contact.broken = formula("x > 0.95");
  contact.base.emplace(problem::BaseLine{place(2), place(0)});
  contact.water.emplace(problem::Seepage{.head = formula("t"),
                                         .weight = 0.02,
                                         .line = *contact.base,
                                         .crack = true,
                                         .drain = problem::Drain{.at = 1.1, .efficiency = 0.4}});
  return data;
}

/// The mesh of peeled().
template <int dim>
[[nodiscard]] mesh::MeshData<dim> peeled_mesh(bool pairs)
{
  return pairs ? two_blocks<dim>() : block<dim>({6, 3}, {3, 2, 1});
}

}  // namespace tribound::test
