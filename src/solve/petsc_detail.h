#pragma once

/// @file petsc_detail.h
/// What petsc.cpp and linear_solver.cpp share; includes PETSc's own headers.

#include <petscksp.h>

#include <memory>
#include <span>

#include "base/error.h"

namespace tribound::detail
{

/// Turns a PETSc error code into a SolveError.
void check(PetscErrorCode error, const char* doing);

struct VecDeleter
{
  void operator()(_p_Vec* vec) const { VecDestroy(&vec); }
};
using VecHandle = std::unique_ptr<_p_Vec, VecDeleter>;

/// A PETSc vector on the caller's memory.
[[nodiscard]] VecHandle wrap(std::span<double> values);
/// The same for reading: PETSc has no vectors of const.
[[nodiscard]] VecHandle wrap(std::span<const double> values);

}  // namespace tribound::detail
