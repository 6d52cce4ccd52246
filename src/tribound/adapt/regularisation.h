#pragma once

/// @file regularisation.h
/// How the regularised variant chooses delta, method section 7.

#include <span>

#include "tribound/certify/bound/estimate.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/solve/newton.h"

namespace tribound::adapt
{

/// The regularised variant, method section 7.
struct RegularisationOptions
{
  double delta = 1.0;      ///< > 0, initial: multiple of the mean contact traction of the first step
  double factor = 0.25;    ///< in (0, 1): the reduction of delta in each update
  double gamma_reg = 0.1;  ///< eta_reg <= gamma_reg * (the discretisation components)
  int max_updates = 20;    ///< of delta on a mesh
};

/// Whether reducing delta further is pointless:
/// eta_reg1 + eta_reg2n + eta_reg2t <= gamma_reg (eta_osc + eta_quad + eta_str + eta_Neu + eta_cnt +
/// eta_frc).
[[nodiscard]] bool regularisation_is_negligible(const certify::BoundComponents& eta, double gamma_reg);

/// The root mean square of |t| over Gamma_C, with t given at the contact points; 0 without contact.
template <int dim>
[[nodiscard]] double mean_contact_traction(const contact::NitscheForm<dim>& form,
                                           std::span<const Point<dim>> t);

/// The outer loop of the regularised variant around Newton's method on one mesh.
struct DeltaUpdates
{
  RegularisationOptions config;
  double delta = 0;   ///< of the next Newton step; 0 until the first step has shown the size of the traction
  int n_updates = 0;  ///< on this mesh

  /// What to do after the step that gave `iterate`, whose components are `eta`. `inner_done`: the iteration
  /// with the current delta has ended. The first delta is config.delta times the mean contact traction. At
  /// the end of an iteration delta is reduced by config.factor, until the regularisation is negligible or
  /// config.max_updates is reached. The iterate is then good enough; its bound holds in any case.
  template <int dim>
  [[nodiscard]] solve::NewtonAdvice advise(const contact::NitscheForm<dim>& form,
                                           const solve::NewtonIterate<dim>& iterate,
                                           const certify::BoundComponents& eta, bool inner_done);
};

}  // namespace tribound::adapt
