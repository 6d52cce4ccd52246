#pragma once

/// @file energy_bound.h
/// The guaranteed bound of the error in the energy norm, method section 13.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/certify/energy/quantity_interval.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/problem/quantity.h"

namespace tribound::certify
{

/// The solution whose distance from u_h is bounded.
enum class EnergyTarget
{
  solution,          ///< the exact solution
  computed_friction  ///< Coulomb: the exact solution of Tresca's problem with the computed threshold -mu_F
                     ///< t_h^n
};

/// ||u - u_h||_en <= bound, ||v||_en^2 = (sigma(v), eps(v)). Energies have the unit of a(u, u); B_v, mid,
/// dist, correction and oscillation are roots of energies.
struct EnergyBound
{
  std::string reason{};  ///< why there is no bound; empty: there is one
  double bound = 0;      ///< min(B_v + correction, mid + dist)
  EnergyTarget target = EnergyTarget::solution;
  double b_v = 0;                  ///< bounds ||u - v||_en
  double mid = 0;                  ///< bounds the distance of sigma(u) from (tau + sigma(v))/2
  double dist = 0;                 ///< the distance of sigma(u_h) from the same
  double gap = 0;                  ///< E, the duality gap of v and tau, plus ||O|| B_v
  double correction = 0;           ///< ||u_h - v||_en
  double contact = 0;              ///< G_c
  double springs = 0;              ///< (K (u~ - v), u~ - v)_S, of which E has half
  double oscillation = 0;          ///< ||O||, the contribution of data that are not polynomials, and transfer
  double transfer = 0;             ///< of ||O||: what tractions lose between meshes that do not match
  double cell_balance = 0;         ///< largest part of the data of a cell that it cannot balance
  double gap_remainder = 0;        ///< largest |g - g_h| at the contact points; length
  double threshold_remainder = 0;  ///< largest |s - s_h| there; stress
  double direction_remainder = 0;  ///< largest |N - M N_0| there, M of contact_frames.h
  bool is_open = true;  ///< whether v with facets in transition taken as open and slipping is the better one
  /// Per own cell A_T^2 + 4 G_F of its facets, A_T = ||tau - sigma(v)|| + O_T, for marking.
  std::vector<double> cells{};
  /// Intervals of the requested numbers. Those that follow from equilibrium exist even without a bound.
  std::vector<QuantityInterval> quantities{};
};

/// If a cell leaves more than this fraction of the stress unbalanced, there is no bound.
inline constexpr double cell_balance_limit = 1e-8;

/// No bound of u, for this reason, but the values of the quantities and the intervals that follow from
/// equilibrium alone. Throws InputError for quantities that the problem does not have. All ranks together.
template <int dim>
[[nodiscard]] EnergyBound no_energy_bound(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                          std::span<const problem::Quantity<dim>> quantities,
                                          const std::string& reason);

template <int dim>
class QuantityBounds;

/// Bounds the error of functions on one mesh. tau is a statically admissible stress with the contact traction
/// t_h, the nearest to T(u) that obeys the law everywhere: u~ with a(u~, v) = L(v) + (t_h, v)_C is
/// equilibrated on vertex patches, then made symmetric cell by cell. v is a kinematically admissible
/// displacement near u. Then with
///     E = 1/2 ||tau - sigma(v)||^2 + G_c,
/// E >= 1/2 ||u - v||_en^2 + 1/2 ||sigma(u) - tau||^2, norms of stresses in C^{-1}. Any function u_h of the
/// space has a bound, converged or not. All ranks construct and call it together.
template <int dim>
class EnergyEstimator
{
 public:
  /// The form must outlive the object. `solver` is for u~, which is solved to 1e-12. `korn`: K of korn.h, of
  /// a mesh of which this is a refinement. The other norm for its patches also gives a bound, but a less
  /// sharp one near incompressibility. Throws InputError for quantities that the problem does not have, and
  /// SolveError if their dual problems cannot be solved.
  EnergyEstimator(const contact::NitscheForm<dim>& form, const algebra::SolverOptions& solver,
                  const std::vector<problem::Quantity<dim>>& quantities = {}, std::optional<double> korn = {},
                  PatchStress patches = PatchStress::afw_compliance);
  ~EnergyEstimator();
  EnergyEstimator(const EnergyEstimator&) = delete;
  EnergyEstimator& operator=(const EnergyEstimator&) = delete;

  /// Why there can be no bound for this form; empty: there can be one.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Throws SolveError as the equilibration does.
  [[nodiscard]] EnergyBound operator()(std::span<const double> u) const;

 private:
  struct Parts;

  /// The bound without quantities; calls `use` with what it was computed from.
  template <class Use>
  [[nodiscard]] EnergyBound bound(std::span<const double> u, const Use& use) const;

  const contact::NitscheForm<dim>& form_;
  algebra::SolverOptions solver_;
  std::string reason_;
  std::unique_ptr<Parts> parts_;
  std::unique_ptr<QuantityBounds<dim>> quantities_;  ///< null: none
};

}  // namespace tribound::certify
