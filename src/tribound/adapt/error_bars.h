#pragma once

/// @file error_bars.h
/// Bounds of the adaptive algorithm beside that of the residual: the error in the energy norm.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/certify/energy/energy_bound.h"

namespace tribound::adapt
{

/// The levels whose error is bounded in the energy norm.
enum class EnergyLevels
{
  off,
  last,
  every
};

struct ErrorBars
{
  EnergyLevels levels = EnergyLevels::off;
  std::optional<double> energy_tolerance{};  ///< of bound / ||u_h||_en; no requirement where absent
  std::string goal{};                        ///< the quantity whose share marks cells; empty: none
  std::optional<double> goal_tolerance{};    ///< of its bar / |value|; no requirement where absent

  /// Whether levels need their error bars before the last level is known.
  [[nodiscard]] bool on_every_level() const { return levels == EnergyLevels::every; }
};

/// The bound of the error of u in the energy norm, and the intervals of the quantities. A failure becomes the
/// reason in the bound: the level remains valid, and so do the values of the quantities. `korn`: K of
/// certify/bound/korn.h, of a mesh of which this is a refinement.
template <int dim>
[[nodiscard]] certify::EnergyBound energy_bound(const contact::NitscheForm<dim>& form, const Method& method,
                                                std::span<const double> u,
                                                const std::vector<problem::Quantity<dim>>& quantities = {},
                                                std::optional<double> korn = {});

/// energy_bound() of a level with this verdict; a reason where it has no bound of the residual.
template <int dim>
[[nodiscard]] certify::EnergyBound error_bars(const contact::NitscheForm<dim>& form, const Method& method,
                                              const CertifiedLevel<dim>& level,
                                              const certify::Verdict& verdict,
                                              const std::vector<problem::Quantity<dim>>& quantities);

/// The interval of that name; null where there is none.
[[nodiscard]] const certify::QuantityInterval* find_interval(const certify::EnergyBound& bound,
                                                             const std::string& name);

/// Squares per own cell for marking: the contributions to the error of the goal, else to the bound in the
/// energy norm. Empty where neither is known.
[[nodiscard]] std::span<const double> shares_of_cells(const ErrorBars& bars,
                                                      const std::optional<certify::EnergyBound>& bound);

/// The unmet requirements, as text; empty: none. `energy_norm`: ||u_h||_en.
[[nodiscard]] std::string unmet(const ErrorBars& bars, const certify::EnergyBound& bound, double energy_norm);

}  // namespace tribound::adapt
