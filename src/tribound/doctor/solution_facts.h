#pragma once

/// @file solution_facts.h
/// Properties of a computed contact: penetration, zigzags and peaks of the pressure, sliding, damage.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/damage_facts.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

struct ContactOutcome
{
  std::string boundary;
  bool has_master = false;  ///< a body is on the other side
  long facets = 0;
  long closed_facets = 0;  ///< with pressure at every quadrature point
  double closed = 0;       ///< measure of the part under pressure
  double slipping = 0;     ///< part of it that slips
  bool carries = false;    ///< any traction, including a bond in tension
  bool has_friction = false;
  std::optional<double> coefficient;  ///< Coulomb's
  double force = 0;                   ///< integral of the pressure
  double largest_pressure = 0;
  double penetration = 0;  ///< max (u^n - g) at the quadrature points, 0 if nowhere positive
  Place penetration_at;

  /// The relative oscillation of the pressure from facet to facet. p_F is the mean pressure of a closed
  /// facet, and d_F its excess over the linear function through those of its neighbours (2 in 2D, 3 in 3D,
  /// all of them closed). Where at least two neighbours have a d of the opposite sign, p_F zigzags by a_F,
  /// half the smaller of |d_F| and the second largest of their |d|; elsewhere a_F = 0. The value is (sum |F|
  /// a_F^2 / sum |F| p_F^2)^(1/2) over the closed facets. A steep or curved pressure has d of one sign; a
  /// smooth one has d = O(h^2).
  double zigzag = 0;
  Place zigzag_at;  ///< where a_F is largest

  double kink = 0;           ///< degrees: the largest kink() where there is pressure on either side
  double kink_pressure = 0;  ///< the largest on facets that meet at a kink
  Place kink_at;             ///< where it is

  DamageFacts damage{};

  /// Over the closed part; 0 where there is none.
  [[nodiscard]] double mean_pressure() const { return closed > 0 ? force / closed : 0; }
};

/// The outcome on every contact boundary that has facets and is not tied, in the order of the problem.
template <int dim>
[[nodiscard]] std::vector<ContactOutcome> contact_outcomes(const contact::NitscheForm<dim>& form,
                                                           std::span<const double> u);

}  // namespace tribound::doctor
