#pragma once

/// @file constant_stress.h
/// Boxes pressed on a frictionless floor, in constant stress: every degree reproduces the solution.

#include <array>
#include <string>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/adapt/level.h"
#include "tribound/certify/equilibrate/equilibrate.h"

namespace tribound::test
{

/// On (0, 2) x (0, 1) [x (0, 1)]: u = (0.1 x, -0.3 y) or (0.1 x, 0.1 y, -0.3 z); the floor is the side
/// "bottom" or "back".
template <int dim>
DiscreteProblem<dim> constant_stress_problem(int degree, int n)
{
  const std::string floor = dim == 2 ? "bottom" : "back";
  ProblemData<dim> data{.boundaries = {obstacle<dim>(floor)}, .material = lame(1, 0.25)};
  for (const char* side : side_names<dim>)
    if (side != floor)
      data.boundaries.push_back(
          fixed<dim>(side, formula("0.1*x"), formula(dim == 2 ? "-0.3*y" : "0.1*y"), formula("-0.3*z")));
  return {block<dim>({n, n}, {n, n, n}), data, {.degree = degree}};
}

template <int dim>
Point<dim> constant_stress_displacement(const Point<dim>& x)
{
  Point<dim> u = 0.1 * x;
  u[dim - 1] = -0.3 * x[dim - 1];
  return u;
}

/// The stress; zz in 2D is that of plane strain.
template <int dim>
std::array<double, 3> constant_stress()
{
  const double lambda = 0.4;  // = mu
  const double trace = dim == 2 ? -0.2 : -0.1;
  const double xx = lambda * trace + 0.08;
  const double last = lambda * trace - 0.24;
  if constexpr (dim == 2) return {xx, last, lambda * trace};
  return {xx, xx, last};
}

/// The level as the adaptive loop would hand it over.
template <int dim>
adapt::CertifiedLevel<dim> constant_stress_level(const DiscreteProblem<dim>& box)
{
  adapt::CertifiedLevel<dim> level;
  level.u = interpolate(box.space, constant_stress_displacement<dim>);
  level.stress = certify::equilibrate<dim>(box.form, level.u, box.form.traction(level.u));
  level.estimate = certify::estimate<dim>(box.form, level.u, level.stress);
  return level;
}

}  // namespace tribound::test
