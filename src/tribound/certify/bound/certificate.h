#pragma once

/// @file certificate.h
/// What may be claimed of a computed solution: the verdict on its bound, and in words what is guaranteed,
/// under which assumptions, and what lies outside.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

/// From the second on the later the worse.
enum class RunStatus
{
  uncertified,    ///< no bound computed
  certified,      ///< the identities hold and the bound is below the tolerance
  budget,         ///< the identities hold, so does the bound; the tolerance was not reached
  not_certified,  ///< an identity is violated: the numbers are no bound
  failed          ///< no solution
};

[[nodiscard]] const char* to_string(RunStatus status);

/// Whether the numbers are a bound, even if it is above the tolerance.
[[nodiscard]] bool is_bound(RunStatus status);

/// Above this, relative to ||sigma_h||, an identity counts as violated.
inline constexpr double identity_limit = 1e-8;

/// A status and why it is not `certified`; the reason is empty when it is.
struct Verdict
{
  RunStatus status;
  std::string reason;
};

/// Whether sigma(u) and the bound of its error are nothing but rounding: the exact stress is zero as far as
/// can be known, and what the identities say relative to it means nothing.
[[nodiscard]] bool is_round_off(const Bound& bound, const contact::StressNorms& norms);

/// Certified if the stress is nothing but rounding, or the identities hold to identity_limit and
/// bound.total_sharp <= tolerance * ||sigma(u)||; numbers that are not finite are never certified.
[[nodiscard]] Verdict judge(const Bound& bound, const IdentityDefects& identities, int degree,
                            const contact::StressNorms& norms, double tolerance);

/// Why what was computed is no bound: an identity is violated by more than identity_limit; empty when all
/// hold. `defect`: IdentityDefects::largest.
[[nodiscard]] std::string identity_violation(double defect);

/// The words of a certificate.
struct Statements
{
  std::vector<std::string> covered;                              ///< what the bound bounds
  std::string law;                                               ///< existence and uniqueness
  std::vector<std::pair<std::string, double>> constants;         ///< used in the bound, by name
  std::vector<std::pair<std::string, std::string>> assumptions;  ///< what the result rests on, by topic
  std::vector<std::string> not_covered;                          ///< errors outside the bound
};

/// C_F is that of the bound. All ranks call this and the next two together.
template <int dim>
[[nodiscard]] Statements statements(const contact::NitscheForm<dim>& form, ContactRule rule,
                                    const std::optional<FriedrichsConstant>& friedrichs = {});

/// What they say in addition where it is a load step that was solved. `left_early`: by an adaptive criterion,
/// which leaves a linearisation error in what the step commits. `carried`: whether the history has gone from
/// mesh to mesh.
void add_history(Statements& statements, bool left_early, bool carried = false);

/// The largest |u_D - I u_D| at the points of the facet rule, I the interpolation at the nodes, in a fixed
/// component on Gamma_D; length.
template <int dim>
[[nodiscard]] double dirichlet_interpolation_error(const contact::NitscheForm<dim>& form);

/// An upper bound of it anywhere: on a facet (1 + Lambda) times an enclosed distance of u_D from P^p, Lambda
/// the Lebesgue constant of the nodes, and Lambda times what u_D may jump by at a node.
template <int dim>
[[nodiscard]] double dirichlet_interpolation_bound(const contact::NitscheForm<dim>& form);

}  // namespace tribound::certify
