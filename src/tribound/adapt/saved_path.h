#pragma once

/// @file saved_path.h
/// What is left of a load path for a run that goes on with it later.

#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/bordered.h"
#include "tribound/adapt/gathered_history.h"

namespace tribound::adapt
{

/// A committed load step, as far as the steps after it need it.
template <int dim>
struct SavedStep
{
  int number = 0;
  double t = 0;
  std::string control{};              ///< LoadStep::control
  double reference_force = 0;         ///< as those of LoadPath::Position after the step
  double largest_sigma = 0;           ///<
  std::vector<double> tips{};         ///<
  std::vector<double> u{};            ///< of the space
  GatheredHistory<dim> history = {};  ///< that the step began with
};

/// Steps one after the other, the newest first; not empty.
template <int dim>
struct SavedPath
{
  std::vector<SavedStep<dim>> steps{};
  PathPoint before{};  ///< the step before the oldest of them; u is empty where there is none
};

}  // namespace tribound::adapt
