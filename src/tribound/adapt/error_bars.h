#pragma once

/// @file error_bars.h
/// What the adaptive algorithm bounds beside the residual: the error in the energy norm.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/method.h"
#include "tribound/certify/energy/energy_bound.h"

namespace tribound::adapt
{

/// Which levels get the bound of the error in the energy norm.
enum class EnergyLevels
{
  off,
  last,
  every
};

struct ErrorBars
{
  EnergyLevels levels = EnergyLevels::off;
  std::optional<double> energy_tolerance{};  ///< of bound / ||u_h||_en; no demand where absent
  std::string goal{};                        ///< the quantity whose share marks cells; empty: none
  std::optional<double> goal_tolerance{};    ///< of its bar / |value|; no demand where absent

  /// Whether levels need their error bars before it is known which one is the last.
  [[nodiscard]] bool on_every_level() const { return levels == EnergyLevels::every; }
};

/// The bound of the error of u in the energy norm, and the intervals of the quantities. What fails in it
/// becomes its reason: the level it belongs to holds all the same, and so do the values of the quantities.
template <int dim>
[[nodiscard]] certify::EnergyBound energy_bound(const contact::NitscheForm<dim>& form, const Method& method,
                                                std::span<const double> u,
                                                const std::vector<problem::Quantity<dim>>& quantities = {});

/// The interval of that name; null where there is none.
[[nodiscard]] const certify::QuantityInterval* find_interval(const certify::EnergyBound& bound,
                                                             const std::string& name);

/// Squares per own cell by which they are marked: what the goal, else the bound in the energy norm consists
/// of. Empty where neither is known.
[[nodiscard]] std::span<const double> shares_of_cells(const ErrorBars& bars,
                                                      const std::optional<certify::EnergyBound>& bound);

/// What of the demands is not met, in words; empty: nothing. `energy_norm`: ||u_h||_en.
[[nodiscard]] std::string unmet(const ErrorBars& bars, const certify::EnergyBound& bound, double energy_norm);

}  // namespace tribound::adapt
