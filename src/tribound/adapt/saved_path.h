#pragma once

/// @file saved_path.h
/// The saved part of a load path, for a run that continues it later.

#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/bordered.h"
#include "tribound/adapt/gathered_history.h"

namespace tribound::adapt
{

/// A committed load step, as far as later steps need it.
template <int dim>
struct SavedStep
{
  int number = 0;
  double t = 0;
  std::string control{};              ///< LoadStep::control
  double reference_force = 0;         ///< this and the next two as in LoadPath::Position after the step
  double largest_sigma = 0;           ///<
  std::vector<double> tips{};         ///<
  std::vector<double> u{};            ///< of the space
  GatheredHistory<dim> history = {};  ///< at the beginning of the step
};

/// Successive steps, the newest first; not empty.
template <int dim>
struct SavedPath
{
  std::vector<SavedStep<dim>> steps{};
  PathPoint before{};  ///< the step before the oldest of them; u is empty if there is none
};

}  // namespace tribound::adapt
