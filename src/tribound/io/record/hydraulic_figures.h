#pragma once

/// @file hydraulic_figures.h
/// Safety figures of the base of a hydraulic structure after a load step (method section 12.6).

#include <optional>

#include "tribound/adapt/load_path.h"

namespace tribound::io
{

/// Figures from the forces on the body of the slave, per unit depth in 2D. N and V are normal to and in the
/// mean plane of the interface, with n out of the body and N < 0 in compression; s is the distance from the
/// heel along the line from heel to toe, which has length L; N_eff = N + U.
struct HydraulicFigures
{
  double effective_normal = 0;  ///< N_eff
  double uplift = 0;            ///< U = integral of p_w, >= 0
  /// s where the line of action of the effective forces crosses the base line, in the plane of that line and
  /// the mean normal; absent unless N_eff < 0.
  std::optional<double> resultant_x{};
  std::optional<double> resultant_x_total{};  ///< the same for the total forces; absent unless N < 0
  std::optional<bool> in_kernel{};            ///< L/3 <= resultant_x <= 2L/3
  // Over |V|, and absent where |V| < 1e-10 |N|; mu and strength are those of the law.
  std::optional<double> sliding_safety{};  ///< mu max(-N_eff, 0) / |V|
  /// (strength at D = 0 over the whole base + mu max(-N_eff, 0)) / |V|; absent for laws without a shear
  /// strength of their own: endo, and a bond that sticks.
  std::optional<double> sff_intact{};
  std::optional<double> sff_now{};  ///< the same at the current D, where delta^n = 0
  /// Sum of the stabilising over the sum of the overturning moments about the toe. The moments are those of
  /// the body force of each region, each Cartesian component of the load on each boundary, and the uplift,
  /// which always counts as overturning; loads are those on the bodies that own the slave. Absent where
  /// nothing overturns.
  std::optional<double> overturning{};
  // For a single interface, not for a sum:
  std::optional<double> crack_tip{};       ///< a, the largest over the steps so far
  std::optional<double> crack_farthest{};  ///< CrackTip::farthest of this step
  std::optional<double> cmod{};            ///< delta^n at contact::crack_mouth()
  std::optional<double> csd{};             ///< slip of the slave there, positive from heel to toe
};

/// The figures of the interface whose slave has boundary number `tag`; absent without Contact::base. All
/// ranks call it together and obtain the same.
template <int dim>
[[nodiscard]] std::optional<HydraulicFigures> hydraulic_figures(const adapt::LoadStep<dim>& step, int tag);

}  // namespace tribound::io
