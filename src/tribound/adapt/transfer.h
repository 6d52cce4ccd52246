#pragma once

/// @file transfer.h
/// A load path followed once, on a mesh that becomes finer along it. A step whose bound is too large is
/// solved again on a finer mesh, with the history of the previous step transferred there (method section
/// 12.4).

#include "tribound/adapt/replay.h"
#include "tribound/base/error.h"

namespace tribound::adapt
{

/// Throws InputError where there are pairs in 3D, whose history cannot be transferred. `where`: for messages.
template <int dim>
void check_transfer(const problem::Problem<dim>& problem, const Where& where = {});

/// Follows the program. A step whose bound holds but exceeds the tolerance of the path is solved again at its
/// t, on the mesh with the cells bisected that strategy.mark selects for it. This is repeated within
/// strategy.stop and strategy.limit, which count the meshes of the whole path; the rest of `strategy` is not
/// used. The next step begins on that mesh; no mesh becomes coarser. Where there is no solution or no bound
/// on the finer mesh, the step stays as it is, a note of the path says so, and the path continues. The
/// observer sees the steps that stay, the first mesh by `begins`, every other by `finer`, and the last by
/// `complete`.
///
/// Displacements are transferred to a finer mesh exactly. So are, in 2D, the contact history
/// (carried_history()) and the tractions of the previous step, which the work is computed from: the step is
/// the same problem on the finer mesh. In 3D polynomials replace them, and need not interpolate the values at
/// the points. Bonds that are broken from the beginning are found anew on each mesh. The history left by
/// earlier steps depends on the meshes they were solved on; no bound covers this. With `from` it continues
/// after the load step of another run, as replay(). Throws as LoadPath does, and as check_transfer().
template <int dim>
[[nodiscard]] certify::Verdict transfer(LoadPath<dim>& path, const PathProgram& program,
                                        const Strategy<dim>& strategy, const ReplayObserver<dim>& observer,
                                        const ReplayState<dim>* from = nullptr);

}  // namespace tribound::adapt
