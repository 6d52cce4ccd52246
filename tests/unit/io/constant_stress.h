#pragma once

/// @file constant_stress.h
/// Boxes pressed on a floor without friction, in constant stress: every degree has the solution exactly.

#include <string>

#include "tribound/adapt/level.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "unit/io/box_case.h"

namespace tribound::test
{

/// On (0, 2) x (0, 1) [x (0, 1)]: u = (0.1 x, -0.3 y) or (0.1 x, 0.1 y, -0.3 z); the floor is the side
/// "bottom" or "back".
template <int dim>
std::string constant_stress_case(int degree, int n)
{
  const std::string cells = std::to_string(n);
  std::string text = "degree = " + std::to_string(degree) + "\nmaterial = { E = 1.0, nu = 0.25 }\n";
  if (dim == 2)
  {
    text += "mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [" + cells + ", " + cells + "] } }\n";
    for (const char* side : {"left", "right", "top"})
      text += std::string("[boundary.") + side + "]\ndisplacement = ['0.1*x', '-0.3*y']\n";
    return text + "[boundary.bottom]\ncontact = {}\n";
  }
  text += "mesh = { box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [" + cells + ", " + cells + ", " +
          cells + "] } }\n";
  for (const char* side : {"left", "right", "top", "bottom", "front"})
    text += std::string("[boundary.") + side + "]\ndisplacement = ['0.1*x', '0.1*y', '-0.3*z']\n";
  return text + "[boundary.back]\ncontact = {}\n";
}

template <int dim>
Point<dim> constant_stress_displacement(const Point<dim>& x)
{
  Point<dim> u = 0.1 * x;
  u[dim - 1] = -0.3 * x[dim - 1];
  return u;
}

/// Its stress; zz in 2D is that of plane strain.
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

/// What the adaptive loop would hand over.
template <int dim>
adapt::CertifiedLevel<dim> constant_stress_level(const BoxCase<dim>& box)
{
  adapt::CertifiedLevel<dim> level;
  level.u = box.interpolate(constant_stress_displacement<dim>);
  level.stress = certify::equilibrate<dim>(box.form, level.u, box.form.traction(level.u));
  level.estimate = certify::estimate<dim>(box.form, level.u, level.stress);
  return level;
}

}  // namespace tribound::test
