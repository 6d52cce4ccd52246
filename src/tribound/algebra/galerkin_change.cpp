#include "tribound/algebra/galerkin_change.h"

#include <cassert>
#include <memory>

namespace tribound::algebra::detail
{

namespace
{

constexpr const char* making_levels = "making multigrid levels";
constexpr const char* galerkin_key = "tribound_galerkin_change";

MatHandle share(Mat a)
{
  check(PetscObjectReference(reinterpret_cast<PetscObject>(a)), making_levels);
  return MatHandle(a);
}

/// The parts of P^T A P.
struct Change
{
  MatHandle interpolation;
  MatHandle changing;  ///< part of A
  MatHandle coarse;    ///< P^T changing P
  MatHandle rest;      ///< P^T (A - changing) P
};

std::unique_ptr<Change> split(Mat coarse, Mat interpolation, Mat changing)
{
  auto change =
      std::make_unique<Change>(Change{share(interpolation), share(changing), MatHandle(), MatHandle()});
  Mat mat = nullptr;
  check(MatPtAP(changing, interpolation, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &mat), making_levels);
  change->coarse.reset(mat);
  check(MatDuplicate(coarse, MAT_COPY_VALUES, &mat), making_levels);
  change->rest.reset(mat);
  check(MatAXPY(mat, -1.0, change->coarse.get(), SUBSET_NONZERO_PATTERN), making_levels);
  return change;
}

/// Replaces the numeric phase of the product.
PetscErrorCode add_change(Mat coarse)
{
  PetscFunctionBegin;
  const Change* change = find_attached<Change>(coarse, galerkin_key);
  Mat of_change = change->coarse.get();
  PetscCall(MatPtAP(change->changing.get(), change->interpolation.get(), MAT_REUSE_MATRIX, PETSC_DEFAULT,
                    &of_change));
  PetscCall(MatCopy(change->rest.get(), coarse, SAME_NONZERO_PATTERN));
  PetscCall(MatAXPY(coarse, 1.0, of_change, SUBSET_NONZERO_PATTERN));
  PetscFunctionReturn(0);
}

}  // namespace

Mat renew_by_change(Mat coarse, Mat interpolation, Mat changing)
{
  if (const Change* change = find_attached<Change>(coarse, galerkin_key))
  {
    assert(change->interpolation.get() == interpolation && change->changing.get() == changing);
    return change->coarse.get();
  }
  const Change& change = attach(coarse, galerkin_key, split(coarse, interpolation, changing));
  check(MatSetOperation(coarse, MATOP_PRODUCTNUMERIC, reinterpret_cast<void (*)()>(add_change)),
        making_levels);
  return change.coarse.get();
}

}  // namespace tribound::algebra::detail
