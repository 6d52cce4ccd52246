#pragma once

/// @file energy_effectivity.h
/// The bound of the energy-norm error, against distances from much richer solutions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/earlier_slip.h"
#include "support/meshes.h"
#include "support/random_cases.h"
#include "tribound/adapt/persistent.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/refine.h"

namespace tribound::test
{

template <int dim>
[[nodiscard]] certify::EnergyBound energy_bound(const DiscreteProblem<dim>& c, std::span<const double> u)
{
  return certify::EnergyEstimator<dim>(c.form, c.method.solver)(u);
}

/// Cells of all shapes in (0,2) x (0,1) (x (0,1)); the sides of the box stay flat.
template <int dim>
[[nodiscard]] mesh::MeshData<dim> irregular(mesh::MeshData<dim> data, double phase = 0)
{
  const auto map = [&](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    for (int a = 0; a < dim; ++a)
      y[a] += 0.1 * std::sin(std::numbers::pi * x[a] / (a == 0 ? 2 : 1)) *
              std::cos(2 * x[(a + 1) % dim] + a + phase);
    return y;
  };
  return renumbered(mapped<dim>(std::move(data), map), 11);
}

/// A much richer solution, found from scratch.
template <int dim>
class RicherReference
{
 public:
  RicherReference(const DiscreteProblem<dim>& c, const certify::RicherSpace& richer)
      : RicherReference(c.form, c.method, richer)
  {
  }
  RicherReference(const contact::NitscheForm<dim>& of, adapt::Method method,
                  const certify::RicherSpace& richer)
      : coarse_(of.space()),
        refined_(mesh::refine_uniformly(of.space().mesh(), richer.refinements)),
        space_(refined_.mesh, richer.degree),
        form_(of.problem(), space_, contact::default_gamma0(richer.degree))
  {
    if (of.history()) remember_as<dim>(of, form_);
    method.degree = richer.degree;
    method.newton = {.tolerance = 1e-11};
    const auto found = adapt::solve_persistently<dim>(form_, {}, method, {}, 0, [](const auto&) {});
    EXPECT_EQ(found.message, "");
    u_ = found.u;
  }

  /// ||u - w||_en, where w is this solution.
  [[nodiscard]] double distance(std::span<const double> u) const
  {
    std::vector<double> error = fem::nested_interpolant<dim>(coarse_, u, refined_, space_);
    for (std::size_t i = 0; i < error.size(); ++i) error[i] -= u_[i];
    return std::sqrt(contact::stress_norms<dim>(form_.problem(), space_, error).energy);
  }
  [[nodiscard]] const contact::NitscheForm<dim>& form() const { return form_; }
  [[nodiscard]] std::span<const double> u() const { return u_; }

 private:
  const fem::LagrangeSpace<dim>& coarse_;
  mesh::Refined<dim> refined_;
  fem::LagrangeSpace<dim> space_;
  contact::NitscheForm<dim> form_;
  std::vector<double> u_;
};

/// bound / distance from a richer solution.
template <int dim>
[[nodiscard]] double effectivity(const RicherReference<dim>& reference, std::span<const double> u,
                                 const certify::EnergyBound& eta)
{
  EXPECT_EQ(eta.reason, "");
  EXPECT_LE(eta.cell_balance, 1e-11);
  return eta.bound / reference.distance(u);
}

/// Returns the bound.
template <int dim>
certify::EnergyBound expect_effectivity(const char* name, const ProblemData<dim>& data,
                                        mesh::MeshData<dim> mesh, int p, const certify::RicherSpace& richer,
                                        double largest)
{
  const DiscreteProblem<dim> c(std::move(mesh), data, {.degree = p, .newton = {.tolerance = 1e-12}});
  const std::vector<double> u = c.solve().u;
  const certify::EnergyBound eta = energy_bound(c, u);
  const double found = effectivity<dim>(RicherReference<dim>(c, richer), u, eta);
  fmt::print("{:<14} {}D p = {}: {:.3f}; bound {:.3e}, ||c|| {:.1e}, G_c {:.1e}, O {:.1e}\n", name, dim, p,
             found, eta.bound, eta.correction, eta.contact, eta.oscillation);
  EXPECT_GE(found, 1) << name << p;
  EXPECT_LE(found, largest) << name << p;
  return eta;
}

/// No bound fails in n_cases(n) random problems make(seed).
template <int dim, class Make>
void expect_no_failure(const char* name, unsigned n, const Make& make, int refinements = 2)
{
  double smallest = HUGE_VAL;
  double largest = 0;
  for (unsigned seed = 0; seed < n_cases(n); ++seed)
  {
    const auto c = make(seed);
    const std::vector<double> u = c.solve().u;
    const RicherReference<dim> reference(c, {.refinements = refinements, .degree = c.space.degree() + 2});
    const double found = effectivity<dim>(reference, u, energy_bound(c, u));
    EXPECT_GE(found, 1) << seed;
    smallest = std::min(smallest, found);
    largest = std::max(largest, found);
  }
  fmt::print("{}: effectivity {:.3f} to {:.3f}\n", name, smallest, largest);
}

}  // namespace tribound::test
