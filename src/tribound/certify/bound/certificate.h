#pragma once

/// @file certificate.h
/// What may be claimed of a computed solution: the verdict on its bound, and in words what is guaranteed,
/// under which assumptions, and what is not covered.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

/// From the second value on, each is worse than the one before.
enum class RunStatus
{
  uncertified,    ///< no bound computed
  certified,      ///< the identities hold and the bound is below the tolerance
  budget,         ///< the identities and the bound hold, but the tolerance was not reached
  not_certified,  ///< an identity is violated: the numbers are not a bound
  failed          ///< no solution
};

[[nodiscard]] const char* to_string(RunStatus status);

/// Whether the numbers are a bound, possibly above the tolerance.
[[nodiscard]] bool is_bound(RunStatus status);

/// An identity counts as violated above this value, relative to ||sigma_h||.
inline constexpr double identity_limit = 1e-8;

/// A status and why it is not `certified`; the reason is empty when it is.
struct Verdict
{
  RunStatus status;
  std::string reason;
};

/// Whether sigma(u) and the bound of its error are only rounding: then the exact stress is zero as far as can
/// be known, and identities relative to it mean nothing.
[[nodiscard]] bool is_round_off(const Bound& bound, const contact::StressNorms& norms);

/// Certified if the stress is only rounding, or if the identities hold to identity_limit and
/// bound.total_sharp <= tolerance * ||sigma(u)||. Numbers that are not finite are never certified.
[[nodiscard]] Verdict judge(const Bound& bound, const IdentityDefects& identities,
                            const contact::StressNorms& norms, double tolerance);

/// Why the computed numbers are not a bound: an identity is violated by more than identity_limit. Empty if
/// all hold. `defect`: IdentityDefects::largest.
[[nodiscard]] std::string identity_violation(double defect);

/// The statements of a certificate.
struct Statements
{
  std::vector<std::string> covered;                              ///< what the bound bounds
  std::string law;                                               ///< existence and uniqueness
  std::vector<std::pair<std::string, double>> constants;         ///< used in the bound, by name
  std::vector<std::pair<std::string, std::string>> assumptions;  ///< what the result rests on, by topic
  std::vector<std::string> not_covered;                          ///< errors outside the bound
};

/// `friedrichs`: C_F of the bound. All ranks call this and the next two functions together.
template <int dim>
[[nodiscard]] Statements statements(const contact::NitscheForm<dim>& form, ContactRule rule,
                                    const std::optional<FriedrichsConstant>& friedrichs = {});

/// Adds the statements for a load step. `left_early`: an adaptive criterion stopped Newton's method, which
/// leaves a linearisation error in the committed history. `carried`: whether the history was transferred
/// between meshes.
void add_history(Statements& statements, bool left_early, bool carried = false);

/// The largest |u_D - I u_D| at the points of the facet rule, over the fixed components on Gamma_D, with I
/// the interpolation at the nodes; a length.
template <int dim>
[[nodiscard]] double dirichlet_interpolation_error(const contact::NitscheForm<dim>& form);

/// An upper bound of |u_D - I u_D| everywhere: on a facet (1 + Lambda) times an enclosed distance of u_D from
/// P^p, plus Lambda times the possible jump of u_D at a node. Lambda is the Lebesgue constant of the nodes.
template <int dim>
[[nodiscard]] double dirichlet_interpolation_bound(const contact::NitscheForm<dim>& form);

}  // namespace tribound::certify
