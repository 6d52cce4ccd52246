#pragma once

/// @file galerkin_change.h
/// P^T A P again for a matrix of which only a part has changed.

#include "tribound/algebra/petsc_detail.h"

namespace tribound::algebra::detail
{

/// `coarse` is the product P^T A P by MatPtAP(), and of A nothing will change but what `changing`, whose
/// entries are among those of A, contributes. From now on MatPtAP() with MAT_REUSE_MATRIX adds the product of
/// that part to the rest, which is kept. The result is P^T `changing` P, valid as long as `coarse` is, for
/// the next coarser level.
[[nodiscard]] Mat renew_by_change(Mat coarse, Mat interpolation, Mat changing);

}  // namespace tribound::algebra::detail
