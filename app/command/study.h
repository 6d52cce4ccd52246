#pragma once

/// @file study.h
/// The command `tribound study`: what adaptation and the stopping criterion of Newton's method bring.

#include "app/command/run.h"
#include "app/console/console.h"
#include "tribound/case/config.h"
#include "tribound/mesh/mesh.h"

namespace tribound::app
{

/// Solves the case adaptively and with uniform refinement, each with Newton's method stopped by the bound and
/// run to its tolerance; computes a reference solution of higher degree on a mesh adapted to it; measures the
/// errors of all levels against it, and the bounds against the dual norm of the residual. Writes study.csv,
/// study.json and a directory per variant into output.directory, see docs/output.md, and draws the figures.
///
/// Returns success when the adaptive variants reach adapt.tolerance, else budget_used_up, also after an
/// interruption; failed when an effectivity is below 1 or a variant has no solution. Throws InputError and
/// SolveError.
template <int dim>
[[nodiscard]] ExitCode study(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress);

}  // namespace tribound::app
