#pragma once

/// @file certifier.h
/// The bounds of the iterates on one mesh, as solve_and_certify() asks for them.

#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "tribound/adapt/level.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::adapt
{

/// The largest eta_lin1 + eta_lin2n + eta_lin2t that is negligible beside the other components.
[[nodiscard]] inline double negligible_linearisation(const certify::BoundComponents& eta, double gamma_lin)
{
  return gamma_lin * (eta.discretisation() + eta.regularisation());
}

/// The components lin1, lin2n and lin2t alone.
[[nodiscard]] inline certify::BoundComponents linearisation_part(const certify::BoundComponents& eta)
{
  certify::BoundComponents part;
  for (const certify::Component& c : certify::all_components)
    if (c.cause == certify::BoundCause::linearisation) part.*c.value = eta.*c.value;
  return part;
}

/// Bounds the iterates on one mesh.
template <int dim>
class Certifier
{
 public:
  Certifier(const contact::NitscheForm<dim>& form, const Method& method,
            const std::optional<double>& expected,
            const std::optional<certify::FriedrichsConstant>& friedrichs)
      : form_(form),
        method_(method),
        known_(expected),
        equilibrator_(form, method.stress),
        estimator_(form, method.contact_rule, friedrichs)
  {
  }

  /// Whether sigma_lin admits the iterate as a candidate for the solution on the mesh, so that its bound is
  /// needed.
  [[nodiscard]] bool is_candidate(const solve::NewtonIterate<dim>& iterate, CertifiedStep& step)
  {
    if (!known_ && !stress_) stress_ = contact::stress_norms<dim>(form_, iterate.rough_u()).sigma;
    const Stopping criterion = method_.stopping.criterion;
    if (criterion == Stopping::tolerance || method_.regularisation) return true;
    const bool may_be_accepted = linearisation_may_be_negligible(iterate, step);
    return may_be_accepted && criterion != Stopping::last_bounded;
  }

  /// Whether the iterate whose bound the level has may be kept as the solution.
  [[nodiscard]] bool accepts(const CertifiedLevel<dim>& level) const
  {
    return linearisation_is_negligible(level.estimate, method_.stopping, form_.space().mesh().ranks());
  }

  /// Whether <R_lin, phi_i> is negligible beside the expected bound; always false without C_F.
  [[nodiscard]] bool is_balanced(std::span<const double> residual) const
  {
    constexpr double of_stress = 0.1;  // as a rule, bounds on first meshes are no smaller
    const std::optional<double> eta = known_    ? known_
                                      : stress_ ? std::optional(of_stress * *stress_)
                                                : std::nullopt;
    return eta && estimator_.algebraic_bound(residual, method_.stress) <= method_.solver.gamma_alg * *eta;
  }
  /// Whether alg is a small enough part of the level's bound; 1 % is allowed for systems solved to a
  /// tolerance.
  [[nodiscard]] bool is_balanced(const CertifiedLevel<dim>& level) const
  {
    const double gamma = method_.solver.gamma_alg > 0 ? method_.solver.gamma_alg : 0.01;
    return level.estimate.global.alg <= gamma * level.estimate.total_sharp;
  }

  /// Of the iterate that complete() was called for last.
  [[nodiscard]] certify::IdentityDefects identities(const CertifiedLevel<dim>& level) const
  {
    return certify::check_identities<dim>(form_, level.traction, level.stress, rho_);
  }

  /// The stress of the iterate and its bound.
  void complete(std::span<const double> u, std::span<const Point<dim>> t, CertifiedStep& step,
                CertifiedLevel<dim>& level)
  {
    level.stress = equilibrator_(u, t, step.step.delta);
    rho_ = estimator_.algebraic_remainder(u, level.stress);
    level.estimate = estimator_(u, level.stress, rho_);
    level.friedrichs = estimator_.friedrichs();
    level.norms = contact::stress_norms<dim>(form_, u);
    step.bound = level.estimate.bound();
    step.linearisation = linearisation_part(level.estimate.global);
    if (level.norms.sigma > 0) step.relative = level.estimate.total_sharp / level.norms.sigma;
    known_ = level.estimate.global.discretisation();
  }

 private:
  /// Whether the linearisation error may be negligible. The discretisation error is taken as last known or,
  /// before any is known, as at most the stress of the first iterate. An error that is negligible on every
  /// cell is so up to a factor: |x| + |y| + |z| <= 3^{1/2} |x + y + z| for vectors x, y, z >= 0.
  bool linearisation_may_be_negligible(const solve::NewtonIterate<dim>& iterate, CertifiedStep& step)
  {
    const double factor = method_.stopping.criterion == Stopping::adaptive_local ? std::numbers::sqrt3 : 1;
    step.linearisation =
        estimator_.linearisation(equilibrator_.linearisation(iterate.contact_u, iterate.traction));
    return step.linearisation->linearisation() <=
           factor * method_.stopping.gamma_lin * (known_ ? *known_ : *stress_);
  }

  const contact::NitscheForm<dim>& form_;
  const Method& method_;
  std::optional<double> known_;   ///< discretisation() of the last complete bound, or its expected value
  std::optional<double> stress_;  ///< ||sigma(u^1)||
  certify::Equilibrator<dim> equilibrator_;
  certify::Estimator<dim> estimator_;
  certify::AffineFields<dim> rho_;
};

}  // namespace tribound::adapt
