#pragma once

/// @file hydraulic_figures.h
/// What is asked of the base of a hydraulic structure after a load step (method section 12.6).

#include <optional>

#include "tribound/adapt/load_path.h"

namespace tribound::io
{

/// Of the forces on the body of the slave per unit depth in 2D: N and V are normal to and in the mean plane
/// of the interface, n out of the body and N < 0 in compression; s is the distance from the heel along the
/// line from heel to toe, of the length L; N_eff = N + U.
struct HydraulicFigures
{
  double effective_normal = 0;  ///< N_eff
  double uplift = 0;            ///< U = integral of p_w, >= 0
  /// s where the line of action of the effective forces crosses the base line, in the plane of that line and
  /// the mean normal; absent unless N_eff < 0.
  std::optional<double> resultant_x{};
  std::optional<double> resultant_x_total{};  ///< the same of the total forces; absent unless N < 0
  std::optional<bool> in_kernel{};            ///< L/3 <= resultant_x <= 2L/3
  // Over |V|, and absent where that is less than 1e-10 |N|; mu and strength as the law has them.
  std::optional<double> sliding_safety{};  ///< mu max(-N_eff, 0) / |V|
  /// (strength at D = 0 over all of the base + mu max(-N_eff, 0)) / |V|; absent for laws without a strength
  /// of their own in shear: endo, and a bond that sticks.
  std::optional<double> sff_intact{};
  std::optional<double> sff_now{};  ///< the same at the present D, where delta^n = 0
  /// Sum of the stabilising over the sum of the overturning moments about the toe of: the body force of each
  /// region, each Cartesian component of the load of each boundary, and the uplift, which always counts among
  /// the overturning ones. Loads of the bodies that own the slave. Absent where nothing overturns.
  std::optional<double> overturning{};
  // Of one interface, not of a sum:
  std::optional<double> crack_tip{};       ///< a, the largest of the steps so far
  std::optional<double> crack_farthest{};  ///< CrackTip::farthest of this step
  std::optional<double> cmod{};            ///< delta^n at contact::crack_mouth()
  std::optional<double> csd{};             ///< slip of the slave there, positive from heel to toe
};

/// Of the interface whose slave has boundary number `tag`; absent without Contact::base. On several ranks all
/// call it together and have the same.
template <int dim>
[[nodiscard]] std::optional<HydraulicFigures> hydraulic_figures(const adapt::LoadStep<dim>& step, int tag);

}  // namespace tribound::io
