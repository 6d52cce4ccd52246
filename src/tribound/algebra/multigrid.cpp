#include "tribound/algebra/multigrid.h"

#include <algorithm>

#include "tribound/algebra/galerkin_change.h"
#include "tribound/algebra/petsc_detail.h"
#include "tribound/algebra/single_product.h"

namespace tribound::algebra
{

using detail::check;
using detail::VecHandle;

namespace
{

constexpr const char* making = "making multigrid levels";

/// Degrees of freedom of the coarsest space up to which it is solved by a factorisation: that costs little
/// beside the finer levels, and aggregation of a few cells with very different materials trebles the
/// iterations.
constexpr std::size_t factorised = 5000;

/// The degrees of freedom that nothing couples: whose row has one entry.
std::vector<char> decoupled(Mat a)
{
  PetscInt n = 0;
  check(MatGetSize(a, &n, nullptr), making);
  std::vector<char> result(n);
  for (PetscInt i = 0; i < n; ++i)
  {
    PetscInt n_entries = 0;
    check(MatGetRow(a, i, &n_entries, nullptr, nullptr), making);
    result[i] = n_entries == 1 ? 1 : 0;
    check(MatRestoreRow(a, i, &n_entries, nullptr, nullptr), making);
  }
  return result;
}

/// The interpolation of the nodes for every component, between the functions that vanish at the fixed degrees
/// of freedom. Fixed ones of the coarse space, those with weight at fixed ones of the fine space, keep their
/// largest weight alone: it belongs to no other, and P^T A P gets a diagonal there.
Triplets free_weights(const NodeInterpolation& nodes, int dim, const std::vector<char>& fixed)
{
  constexpr int none = -1;
  const Triplets& all = nodes.weights;
  std::vector<int> anchor(dim * nodes.n_coarse, none);  // entry of `all` that a fixed coarse dof keeps
  for (std::size_t k = 0; k < all.values.size(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      int& kept = anchor[dim * all.cols[k] + a];
      if (fixed[dim * all.rows[k] + a] != 0 && (kept == none || all.values[k] > all.values[kept]))
        kept = static_cast<int>(k);
    }

  Triplets result;
  for (std::size_t k = 0; k < all.values.size(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      const int row = dim * all.rows[k] + a;
      const int col = dim * all.cols[k] + a;
      if (anchor[col] == none || anchor[col] == static_cast<int>(k)) result.add(row, col, all.values[k]);
    }
  return result;
}

MatHandle interpolation_matrix(const NodeInterpolation& nodes, int dim, const std::vector<char>& fixed)
{
  Triplets weights = free_weights(nodes, dim, fixed);
  Mat mat = nullptr;
  check(MatCreate(detail::communicator(), &mat), making);
  MatHandle result(mat);
  const PetscInt n_rows = dim * nodes.n_fine;
  const PetscInt n_cols = dim * nodes.n_coarse;
  check(MatSetSizes(mat, n_rows, n_cols, n_rows, n_cols), making);
  check(MatSetType(mat, MATSEQAIJ), making);
  check(MatSetBlockSize(mat, dim), making);
  check(MatSetPreallocationCOO(mat, static_cast<PetscCount>(weights.rows.size()), weights.rows.data(),
                               weights.cols.data()),
        making);
  check(MatSetValuesCOO(mat, weights.values.data(), INSERT_VALUES), making);
  return result;
}

bool is(PC pc, PCType type)
{
  PetscBool result = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), type, &result), making);
  return result == PETSC_TRUE;
}

/// The levels of smoothed aggregation below the finest: see Multigrid::settle().
void settle_aggregation(PC pc, Mat changing)
{
  KSP solver = nullptr;
  PetscInt n_levels = 0;
  check(PCMGGetLevels(pc, &n_levels), making);
  for (PetscInt level = n_levels - 2; level >= 0; --level)
  {
    Mat matrix = nullptr;
    Mat interpolation = nullptr;
    check(PCMGGetSmoother(pc, level, &solver), making);
    check(KSPGetOperators(solver, nullptr, &matrix), making);
    check(PCMGGetInterpolation(pc, level + 1, &interpolation), making);
    if (changing) changing = detail::renew_by_change(matrix, interpolation, changing);
    detail::multiply_in_single(matrix);
  }
}

}  // namespace

void Multigrid::configure(PC pc) const
{
  if (hierarchy_.steps.empty())
  {
    check(PCSetType(pc, PCGAMG), making);
    check(PCSetUseAmat(pc, PETSC_FALSE), making);  // the finest level, too, is smoothed in single precision
    return;
  }
  const auto n_steps = static_cast<PetscInt>(hierarchy_.steps.size());
  check(PCSetType(pc, PCMG), making);
  check(PCSetUseAmat(pc, PETSC_FALSE), making);
  check(PCMGSetLevels(pc, n_steps + 1, nullptr), making);
  KSP solver = nullptr;
  PC inner = nullptr;
  for (PetscInt level = 1; level <= n_steps; ++level)  // PETSc counts from the coarsest
  {
    check(PCMGGetSmoother(pc, level, &solver), making);
    check(KSPSetType(solver, KSPCHEBYSHEV), making);
    check(KSPGetPC(solver, &inner), making);
    check(PCSetType(inner, PCJACOBI), making);
  }
  check(PCMGGetCoarseSolve(pc, &solver), making);
  check(KSPGetPC(solver, &inner), making);
  if (hierarchy_.coarsest_coordinates.size() <= factorised)
  {
    check(KSPSetType(solver, KSPPREONLY), making);
    check(PCSetType(inner, PCLU), making);
    check(PCFactorSetMatSolverType(inner, MATSOLVERMUMPS), making);
    return;
  }
  // Two cycles: as few iterations as with a factorisation on P^1.
  check(KSPSetType(solver, KSPRICHARDSON), making);
  check(KSPSetNormType(solver, KSP_NORM_NONE), making);
  check(KSPSetTolerances(solver, 0, 0, PETSC_DEFAULT, 2), making);
  check(PCSetType(inner, PCGAMG), making);
}

void Multigrid::renew(PC pc, const SparseMatrix& a)
{
  if (!hierarchy_.steps.empty() && !is(pc, PCMG)) return;  // options have made it something else
  if (!made_) return make_levels(pc, a.handle());
  Mat fine = a.handle();
  for (const Level& level : levels_)
  {
    Mat coarse = level.matrix.get();
    check(MatPtAP(fine, level.interpolation.get(), MAT_REUSE_MATRIX, PETSC_DEFAULT, &coarse), making);
    detail::multiply_in_single(coarse);
    fine = coarse;
  }
}

void Multigrid::settle(PC pc, Mat changing) const
{
  if (changing && is(pc, hierarchy_.steps.empty() ? PCGAMG : PCMG))
    for (const Level& level : levels_)
      changing = detail::renew_by_change(level.matrix.get(), level.interpolation.get(), changing);
  KSP solver = nullptr;
  if (is(pc, PCMG))
  {
    check(PCMGGetCoarseSolve(pc, &solver), making);
    check(KSPGetPC(solver, &pc), making);
  }
  if (is(pc, PCGAMG)) settle_aggregation(pc, changing);
}

void Multigrid::make_levels(PC pc, Mat finest)
{
  Mat fine = finest;
  for (const NodeInterpolation& step : hierarchy_.steps)
  {
    Level level{interpolation_matrix(step, hierarchy_.dim, decoupled(fine)), nullptr};
    Mat coarse = nullptr;
    check(MatPtAP(fine, level.interpolation.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT, &coarse), making);
    level.matrix.reset(coarse);
    detail::multiply_in_single(coarse);
    const auto number = static_cast<PetscInt>(hierarchy_.steps.size() - levels_.size());
    check(PCMGSetInterpolation(pc, number, level.interpolation.get()), making);
    KSP solver = nullptr;
    check(PCMGGetSmoother(pc, number - 1, &solver), making);
    check(KSPSetOperators(solver, coarse, coarse), making);
    levels_.push_back(std::move(level));
    fine = coarse;
  }
  set_rigid_body_modes(fine);
  made_ = true;
}

void Multigrid::set_rigid_body_modes(Mat coarsest)
{
  std::vector<double>& x = hierarchy_.coarsest_coordinates;
  Vec coordinates = nullptr;
  check(VecCreateSeqWithArray(detail::communicator(), hierarchy_.dim, static_cast<PetscInt>(x.size()),
                              x.data(), &coordinates),
        making);
  const VecHandle owner(coordinates);
  MatNullSpace modes = nullptr;
  check(MatNullSpaceCreateRigidBody(coordinates, &modes), making);
  check(MatSetNearNullSpace(coarsest, modes), making);
  check(MatNullSpaceDestroy(&modes), making);
}

}  // namespace tribound::algebra
