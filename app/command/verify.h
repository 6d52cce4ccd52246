#pragma once

/// @file verify.h
/// The command `tribound verify`: the bound against what it bounds.

#include "app/command/run.h"
#include "app/console/console.h"
#include "tribound/case/config.h"
#include "tribound/mesh/mesh.h"

namespace tribound::app
{

/// Solves the case on its mesh without adaptation, and computes for every Newton iterate the bound and the
/// dual norm of the residual from below, for the last one also the errors against a solution of higher degree
/// on the mesh refined `refinements` times; over load steps the iterates of each. The intervals of the
/// quantities at every iterate are compared with those of that solution. Prints a table and writes
/// verify.json. Throws InputError, also when the spaces would be too large, and SolveError, also when the
/// bound is below the dual norm of any iterate, when intervals have no common point or when Newton's method
/// does not converge; verify.json is written before.
template <int dim>
[[nodiscard]] ExitCode verify(const case_file::Config& config, mesh::Mesh<dim> mesh, int refinements,
                              const Progress& progress);

}  // namespace tribound::app
