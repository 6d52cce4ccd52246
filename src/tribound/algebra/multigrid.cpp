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

/// The coarsest space is solved by a factorisation up to this many degrees of freedom: that costs little
/// beside the finer levels, while aggregation of a few cells with very different materials trebles the
/// iterations.
constexpr std::int64_t factorised = 5000;

/// Marks the decoupled degrees of freedom, whose row is 0 off the diagonal. Ghosts are marked, too.
std::vector<char> decoupled(Mat a, int dim, const Sharing& sharing)
{
  PetscInt begin = 0;
  PetscInt end = 0;
  check(MatGetOwnershipRange(a, &begin, &end), making);
  std::vector<char> own(end - begin);
  for (PetscInt i = begin; i < end; ++i)
  {
    PetscInt n_entries = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* entries = nullptr;
    check(MatGetRow(a, i, &n_entries, &columns, &entries), making);
    own[i - begin] = 1;
    for (PetscInt k = 0; k < n_entries; ++k)
      if (columns[k] != i && entries[k] != 0) own[i - begin] = 0;
    check(MatRestoreRow(a, i, &n_entries, &columns, &entries), making);
  }
  if (!sharing) return own;
  std::vector<char> result(dim * sharing->global.size());
  detail::put_owned_entries<char>(*sharing, dim, own, result);
  sharing->update(std::span(result), dim);
  return result;
}

/// The interpolation of the nodes for every component, between the functions that vanish at the fixed degrees
/// of freedom. A coarse degree of freedom with weight at a fixed fine one is fixed. It keeps its largest
/// weight only, which belongs to it alone, so that P^T A P gets a diagonal entry there.
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
  std::vector<char> is_anchored(anchor.size());
  std::ranges::transform(anchor, is_anchored.begin(), [](int kept) { return kept == none ? 0 : 1; });
  if (nodes.coarse) nodes.coarse->update(std::span(is_anchored), dim);  // a ghost's cells are not all here

  Triplets result;
  for (std::size_t k = 0; k < all.values.size(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      const int row = dim * all.rows[k] + a;
      const int col = dim * all.cols[k] + a;
      if (is_anchored[col] == 0 || anchor[col] == static_cast<int>(k)) result.add(row, col, all.values[k]);
    }
  return result;
}

MatHandle interpolation_matrix(const NodeInterpolation& nodes, int dim, const std::vector<char>& fixed)
{
  Triplets weights = free_weights(nodes, dim, fixed);
  if (nodes.fine)
    for (std::size_t k = 0; k < weights.rows.size(); ++k)
    {
      int& row = weights.rows[k];
      row = detail::is_owned(*nodes.fine, dim, row) ? detail::global_unknown(*nodes.fine, dim, row) : -1;
      weights.cols[k] = detail::global_unknown(*nodes.coarse, dim, weights.cols[k]);
    }
  const auto n_own = [dim](const Sharing& sharing, Index n) -> PetscInt
  { return dim * (sharing ? static_cast<Index>(sharing->owned.size()) : n); };
  Mat mat = nullptr;
  check(MatCreate(detail::communicator(nodes.fine), &mat), making);
  MatHandle result(mat);
  check(MatSetSizes(mat, n_own(nodes.fine, nodes.n_fine), n_own(nodes.coarse, nodes.n_coarse),
                    PETSC_DETERMINE, PETSC_DETERMINE),
        making);
  check(MatSetType(mat, nodes.fine ? MATMPIAIJ : MATSEQAIJ), making);
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

/// From now on products with an interpolation by aggregation and with its transpose are in single precision.
void transfer_in_single(PC pc, PetscInt level, Mat interpolation)
{
  Mat restriction = nullptr;
  check(PCMGGetRestriction(pc, level, &restriction), making);
  if (restriction != interpolation) return;  // done before
  check(MatTranspose(interpolation, MAT_INITIAL_MATRIX, &restriction), making);
  const MatHandle owned(restriction);
  check(PCMGSetRestriction(pc, level, restriction), making);
  detail::multiply_in_single(restriction);
  detail::interpolate_in_single(interpolation);
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
    transfer_in_single(pc, level + 1, interpolation);
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
  if (hierarchy_.n_coarsest <= factorised)
  {
    check(KSPSetType(solver, KSPPREONLY), making);
    check(PCSetType(inner, PCLU), making);
    check(PCFactorSetMatSolverType(inner, MATSOLVERMUMPS), making);
    return;
  }
  // Two cycles need as few iterations as a factorisation on P^1.
  check(KSPSetType(solver, KSPRICHARDSON), making);
  check(KSPSetNormType(solver, KSP_NORM_NONE), making);
  check(KSPSetTolerances(solver, 0, 0, PETSC_DEFAULT, 2), making);
  check(PCSetType(inner, PCGAMG), making);
}

void Multigrid::renew(PC pc, const SparseMatrix& a)
{
  sharing_ = a.sharing();
  if (!hierarchy_.steps.empty() && !is(pc, PCMG)) return;  // options have chosen another preconditioner
  if (!made_) return make_levels(pc, a);
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

void Multigrid::make_levels(PC pc, const SparseMatrix& finest)
{
  Mat fine = finest.handle();
  for (const NodeInterpolation& step : hierarchy_.steps)
  {
    const std::vector<char> fixed = decoupled(fine, hierarchy_.dim, step.fine);
    Level level{interpolation_matrix(step, hierarchy_.dim, fixed), nullptr};
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
  const VecHandle coordinates = detail::wrap(std::span(x), detail::communicator(sharing_));
  check(VecSetBlockSize(coordinates.get(), hierarchy_.dim), making);
  MatNullSpace modes = nullptr;
  check(MatNullSpaceCreateRigidBody(coordinates.get(), &modes), making);
  check(MatSetNearNullSpace(coarsest, modes), making);
  check(MatNullSpaceDestroy(&modes), making);
}

}  // namespace tribound::algebra
