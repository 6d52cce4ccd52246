#pragma once

/// @file traction.h
/// The contact conditions at one point: P, the friction limit S_h and the contact traction T, method
/// section 2.

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/problem/problem.h"
#include "tribound/problem/projection.h"

namespace tribound::contact
{

/// P = sigma n - gamma (u - g n), so that P^n = P.n and P^t = P - P^n n.
template <int dim>
[[nodiscard]] Point<dim> augmented_traction(const problem::Material& material, double gamma, double gap,
                                            const Point<dim>& n, const Point<dim>& u,
                                            const Tensor<dim>& gradient)
{
  return sigma<dim>(material, gradient) * n - gamma * (u - gap * n);
}

/// S_h for the normal part P^n: 0 | s | -mu_F [P^n]_{-,delta}.
[[nodiscard]] inline double friction_limit(const case_file::FrictionLaw& law, double threshold, double p_n,
                                           double delta = 0)
{
  if (std::holds_alternative<case_file::Tresca>(law)) return threshold;
  if (const auto* coulomb = std::get_if<case_file::Coulomb>(&law))
    return -coulomb->coefficient * problem::negative_part(p_n, delta);
  return 0;
}

/// s(x) where the law is Tresca's, else 0.
template <int dim>
[[nodiscard]] double threshold_if_any(const case_file::FrictionLaw& law, const Point<dim>& x)
{
  const auto* tresca = std::get_if<case_file::Tresca>(&law);
  return tresca ? problem::threshold_at<dim>(*tresca, x) : 0.0;
}

/// T = [P^n]_- n + [P^t]_S from P; T_delta with the regularised projections for delta > 0.
template <int dim>
[[nodiscard]] Point<dim> contact_traction(const case_file::FrictionLaw& law, double threshold,
                                          const Point<dim>& p, const Point<dim>& n, double delta = 0)
{
  const double p_n = p.dot(n);
  const double limit = friction_limit(law, threshold, p_n, delta);
  return problem::negative_part(p_n, delta) * n + problem::ball_projection<dim>(p - p_n * n, limit, delta);
}

}  // namespace tribound::contact
