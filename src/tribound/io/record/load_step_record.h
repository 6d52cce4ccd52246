#pragma once

/// @file load_step_record.h
/// The recorded data of a load step in addition to those of a level.

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tribound/adapt/load_path.h"
#include "tribound/io/record/hydraulic_figures.h"

namespace tribound::io
{

/// The state of an interface after a step; lengths per unit depth in 2D, else areas; energies. Bonds are
/// included where the law has them.
struct InterfaceFigures
{
  std::string boundary{};  ///< the slave, or the boundary on an obstacle
  double measure = 0;      ///< of the whole interface
  double opened = 0;       ///< where delta^n > 0
  double slipping = 0;     ///< where it has slipped in this step
  double broken = 0;       ///< where D = 1
  double process = 0;      ///< where 0 < D < 1
  double damage = 0;       ///< integral of D
  double dissipated = 0;   ///< by this step
  double rubbed = 0;       ///< the part of it dissipated by friction
  double stored = 0;
  std::optional<HydraulicFigures> hydraulic{};  ///< with Contact::base only
};

/// Data of a load step and sums over the steps so far.
struct LoadStepRecord
{
  double t = 0;
  std::string control{"load"};  ///< adapt::LoadStep::control
  int cuts = 0;                 ///< how often the step size was halved
  int passes = 1;               ///< adapt::LoadStep::passes
  double largest_sigma = 0;     ///< largest ||sigma(u_h)|| over the path so far
  std::vector<InterfaceFigures> interfaces{};
  /// Sum over the interfaces. For several hydraulic ones only forces are added.
  InterfaceFigures all{};
  double effective_normal = 0;  ///< integral of T^n + p_w over all contact; force
  double tangential = 0;        ///< as in Resultants::tangential
  // Sums from the first step on:
  double dissipated = 0;
  double rubbed = 0;
  double work = 0;  ///< of loads, reactions and springs, by the trapezoidal rule
  std::vector<std::pair<std::string, double>>
      watched{};       ///< watched quantities of the case; a length times its factors
  double balance = 0;  ///< work - a(u, u) / 2 - stored - dissipated: 0 up to that rule and the discretisation
};

/// `before`: the record of the previous step; null for the first. All ranks call it together.
template <int dim>
[[nodiscard]] LoadStepRecord load_step_record(const adapt::LoadStep<dim>& step, const LoadStepRecord* before,
                                              std::span<const adapt::Watch> watch = {});

}  // namespace tribound::io
