#pragma once

/// @file history_check.h
/// A load path followed once more, with half the steps on a finer mesh, to see how far its figures depend on
/// both (method section 12.8). No bound: the differences are what they are.

#include <atomic>

#include "tribound/adapt/replay.h"

namespace tribound::adapt
{

/// The program with half the steps: the mean of any two values of t that follow each other stands between
/// them, the steps of damage and displacement are half as large, and there may be twice as many.
[[nodiscard]] PathProgram with_half_the_steps(PathProgram program);

/// Follows the program with half the steps on the mesh of `grid` with all cells bisected, which halves all
/// edges, without any bound (PathOptions::certifies), each step to newton.tolerance. Of the observer it calls
/// `begins`, `step` and `newton`. Whatever ends it is its PathEnd::failure, memory and bad data included.
/// `problem` has been followed on `grid`, so that it is known to be well posed. All ranks together.
template <int dim>
[[nodiscard]] PathEnd follow_finely(const Grid<dim>& grid, const problem::Problem<dim>& problem,
                                    Method method, const PathProgram& program,
                                    const ReplayObserver<dim>& observer = {},
                                    const std::atomic<bool>* stop = nullptr);

}  // namespace tribound::adapt
