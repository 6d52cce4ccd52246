#pragma once

/// @file path_checkpoint.h
/// What a run over load steps needs to go on after one of them, as a checkpoint has it.

#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/replay.h"
#include "tribound/io/state/checkpoint.h"

namespace tribound::io
{

/// Of `facts` it sets what belongs to the path. The result refers to the state.
template <int dim>
[[nodiscard]] CheckpointFields to_checkpoint(const adapt::ReplayState<dim>& state, CheckpointFacts& facts);

/// The state again on a space on its mesh; `cells`: own ones in the order of their values. All ranks call it
/// together. Throws InputError where the checkpoint is none of load steps, or damaged.
template <int dim>
[[nodiscard]] adapt::ReplayState<dim> from_checkpoint(const CheckpointFacts& facts,
                                                      const fem::LagrangeSpace<dim>& space,
                                                      std::span<const Index> cells,
                                                      std::span<const double> values,
                                                      std::span<const double> points);

}  // namespace tribound::io
