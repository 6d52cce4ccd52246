#pragma once

/// @file transfer.h
/// A load path followed once, on a mesh that becomes finer along it: a step whose bound is too large is
/// solved again on a finer mesh, with the history of the step before carried there (method section 12.4).

#include "tribound/adapt/replay.h"
#include "tribound/base/error.h"

namespace tribound::adapt
{

/// Throws InputError where there are pairs in 3D: what they remember cannot be carried. `where`: for
/// messages.
template <int dim>
void check_transfer(const problem::Problem<dim>& problem, const Where& where = {});

/// Follows the program. A step whose bound holds, but is above the tolerance of the path, is solved again at
/// its t on the mesh with the cells bisected that strategy.mark names for it, and so on, within strategy.stop
/// and strategy.limit, which count the meshes of the whole path; the rest of `strategy` is not used. The next
/// step begins on that mesh; none becomes coarser. Where there is no solution or no bound on the finer mesh
/// the step stays as it is, a note of the path says so, and the path goes on. Observed are the steps that
/// stay, the first mesh by `begins`, every other by `finer`, and the last by `complete`.
///
/// What is carried to a finer mesh: displacements, exactly; what contact remembers (carried_history()), and
/// the tractions of the step before, which work is made from, in 2D as the same functions, so that the step
/// is the same problem on the finer mesh; in 3D by polynomials that need not go through the values at the
/// points. Bonds that are broken from the beginning are found on each mesh anew. What the steps before have
/// left in the history is of the mesh that they were solved on; no bound covers it. With `from` it goes on
/// after the load step where another run was, as replay(). Throws as LoadPath does, and as check_transfer().
template <int dim>
[[nodiscard]] certify::Verdict transfer(LoadPath<dim>& path, const PathProgram& program,
                                        const Strategy<dim>& strategy, const ReplayObserver<dim>& observer,
                                        const ReplayState<dim>* from = nullptr);

}  // namespace tribound::adapt
