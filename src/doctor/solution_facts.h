#pragma once

/// @file solution_facts.h
/// What a computed contact looks like: penetration, oscillation of the pressure, sliding.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/nitsche.h"
#include "doctor/place.h"

namespace tribound
{

struct ContactOutcome
{
  std::string boundary;
  long facets = 0;
  long closed_facets = 0;  ///< with pressure at every quadrature point
  double closed = 0;       ///< measure at which there is pressure
  double slipping = 0;     ///< part of it that slips
  bool has_friction = false;
  std::optional<double> coefficient;  ///< Coulomb's
  double largest_pressure = 0;
  double penetration = 0;  ///< max (u^n - g) at the quadrature points, 0 if nowhere positive
  Place penetration_at;
  /// A zigzag: with d_F the mean pressure of a closed facet minus what a linear function through those of its
  /// neighbours gives in its centre, the largest min(|d_F|, |d_G|) over neighbours F, G with d of opposite
  /// sign. Facets count whose neighbours are all there (2 in 2D, 3 in 3D) and closed: smooth pressures have
  /// d = O(h^2).
  double zigzag = 0;
  Place zigzag_at;
};

/// The outcome on every contact boundary that has facets, in the order of the problem.
template <int dim>
[[nodiscard]] std::vector<ContactOutcome> contact_outcomes(const NitscheForm<dim>& form,
                                                           std::span<const double> u);

}  // namespace tribound
