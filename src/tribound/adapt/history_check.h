#pragma once

/// @file history_check.h
/// A load path followed once more, with half the steps on a finer mesh, to see how far its results depend on
/// both (method section 12.8). The differences are no bound.

#include <atomic>

#include "tribound/adapt/replay.h"

namespace tribound::adapt
{

/// The program with steps of half the size. The mean of two consecutive values of t is inserted between them,
/// damage and displacement steps are halved, and twice as many steps are allowed.
[[nodiscard]] PathProgram with_half_the_steps(PathProgram program);

/// Follows the program with steps of half the size on the mesh of `grid` with all cells bisected, which
/// halves all edges. No bound is computed (PathOptions::certifies), and each step is solved to
/// newton.tolerance. Of the observer only `begins`, `step` and `newton` are called. Any failure, including
/// lack of memory and invalid data, is returned as PathEnd::failure. `problem` has been followed on `grid`,
/// so it is known to be well posed. All ranks call it together.
template <int dim>
[[nodiscard]] PathEnd follow_finely(const Grid<dim>& grid, const problem::Problem<dim>& problem,
                                    Method method, const PathProgram& program,
                                    const ReplayObserver<dim>& observer = {},
                                    const std::atomic<bool>* stop = nullptr);

}  // namespace tribound::adapt
