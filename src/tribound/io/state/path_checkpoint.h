#pragma once

/// @file path_checkpoint.h
/// The data that a run needs to continue after a load step, for a checkpoint.

#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/replay.h"
#include "tribound/io/state/checkpoint.h"

namespace tribound::io
{

/// Sets the members of `facts` that belong to the path. The result refers to the state.
template <int dim>
[[nodiscard]] CheckpointFields to_checkpoint(const adapt::ReplayState<dim>& state, CheckpointFacts& facts);

/// Restores the state on a space on its mesh; `cells`: own ones in the order of their values. All ranks call
/// it together. Throws InputError where the checkpoint is not one of load steps, or is damaged.
template <int dim>
[[nodiscard]] adapt::ReplayState<dim> from_checkpoint(const CheckpointFacts& facts,
                                                      const fem::LagrangeSpace<dim>& space,
                                                      std::span<const Index> cells,
                                                      std::span<const double> values,
                                                      std::span<const double> points);

}  // namespace tribound::io
