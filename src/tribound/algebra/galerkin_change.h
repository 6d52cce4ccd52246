#pragma once

/// @file galerkin_change.h
/// Recomputes P^T A P when only a part of A has changed.

#include "tribound/algebra/petsc_detail.h"

namespace tribound::algebra::detail
{

/// `coarse` is P^T A P by MatPtAP(). From now on only the contribution of `changing` to A will change; its
/// entries are among those of A. MatPtAP() with MAT_REUSE_MATRIX then adds the product of that part to the
/// rest, which is kept. Returns P^T `changing` P for the next coarser level, valid as long as `coarse` is.
[[nodiscard]] Mat renew_by_change(Mat coarse, Mat interpolation, Mat changing);

}  // namespace tribound::algebra::detail
