#include "tribound/algebra/linear_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tribound/algebra/petsc_detail.h"
#include "tribound/algebra/single_product.h"
#include "tribound/base/rank_failure.h"

namespace tribound::algebra
{

using detail::check;

namespace
{

/// GMRES stops at the target, when `small_enough` (if there is one) accepts its residual, after `budget`
/// iterations, or, if `forecast` is set, as soon as the rate of convergence shows that the budget will not
/// suffice.
struct StopRule
{
  double target;
  int budget;
  bool forecast;
  std::function<bool(Vec)> small_enough;
  std::vector<double> history{};
  double asked_at = HUGE_VAL;  ///< the norm of the residual when small_enough was last asked
};

/// Asks only when the residual has halved since the last time: the residual itself costs a product with the
/// matrix, and the test about as much.
bool is_small_enough(KSP ksp, double residual, StopRule& rule)
{
  constexpr double often_enough = 0.5;
  if (!rule.small_enough || residual > often_enough * rule.asked_at) return false;
  rule.asked_at = residual;
  Vec r = nullptr;
  check(KSPBuildResidual(ksp, nullptr, nullptr, &r), "looking at a residual");
  const bool yes = rule.small_enough(r);
  check(VecDestroy(&r), "looking at a residual");
  return yes;
}

PetscErrorCode stop(KSP ksp, PetscInt iteration, PetscReal residual, KSPConvergedReason* reason,
                    void* context)
{
  constexpr int window = 4;
  // After a tenth of the budget, factors of another contact state had left 0.9 of the residual and more,
  // those worth keeping at most 0.6 (T2D and its 3D sibling, 5k to 100k degrees of freedom).
  constexpr double hopeless = 0.8;
  auto& rule = *static_cast<StopRule*>(context);
  rule.history.push_back(residual);
  *reason = KSP_CONVERGED_ITERATING;
  if (!std::isfinite(residual))
    *reason = KSP_DIVERGED_NANORINF;
  else if (residual <= rule.target || (iteration > 0 && is_small_enough(ksp, residual, rule)))
    *reason = KSP_CONVERGED_ATOL;
  else if (iteration >= rule.budget || (rule.forecast && iteration == std::max(1, rule.budget / 10) &&
                                        residual > hopeless * rule.history.front()))
    *reason = KSP_DIVERGED_ITS;
  else if (rule.forecast && iteration >= window)
  {
    const double earlier = rule.history[rule.history.size() - 1 - window];
    const double gain = std::log(earlier / residual) / window;
    const double needed = gain > 0 ? std::log(residual / rule.target) / gain : HUGE_VAL;
    if (iteration + needed > rule.budget) *reason = KSP_DIVERGED_ITS;
  }
  return 0;
}

enum class From
{
  zero,
  x
};

/// Runs FGMRES under the rule; returns whether the target was met.
bool iterate(KSP ksp, Vec b, StopRule& rule, Vec x, From from)
{
  check(KSPSetInitialGuessNonzero(ksp, from == From::x ? PETSC_TRUE : PETSC_FALSE), "setting up a solver");
  check(KSPSetConvergenceTest(ksp, stop, &rule, nullptr), "setting up a solver");
  check(KSPSolve(ksp, b, x), "solving a linear system");
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp, &reason), "solving a linear system");
  return reason > 0;
}

/// GMRES iterations that cost about as much as the factorisation in `ksp`. The model counts operations and
/// measures no time, so that a run can be repeated to the last bit.
int iterations_worth_a_factorisation(KSP ksp)
{
  PC pc = nullptr;
  Mat factors = nullptr;
  MatSolverType package = nullptr;
  check(KSPGetPC(ksp, &pc), "querying a factorisation");
  check(PCFactorGetMatrix(pc, &factors), "querying a factorisation");
  check(MatFactorGetSolverType(factors, &package), "querying a factorisation");
  if (std::strcmp(package, MATSOLVERMUMPS) != 0) return 12;

  PetscReal factor_flops = 0;
  PetscInt entries = 0;
  check(MatMumpsGetRinfog(factors, 3, &factor_flops), "querying a factorisation");
  check(MatMumpsGetInfog(factors, 29, &entries), "querying a factorisation");
  const double n_entries = entries < 0 ? -1e6 * entries : entries;
  PetscInt n = 0;
  check(MatGetSize(factors, &n, nullptr), "querying a factorisation");
  // Fitted to MUMPS 5.5 with OpenBLAS on one core with AVX-512, within 15 % of the measurements: 2D from 100k
  // to 500k degrees of freedom (10 and 12 iterations), 3D from 20k to 60k (35 and 55 iterations).
  constexpr double per_flop = 1.8e-11;         // seconds, in the factorisation
  constexpr double per_entry = 1.7e-8;         // of the factors, in the factorisation
  constexpr double per_entry_solve = 5.5e-10;  // of the factors, in a forward and backward solve
  constexpr double per_row_solve = 2.9e-7;
  const double factorisation = per_flop * factor_flops + per_entry * n_entries;
  const double solve = per_entry_solve * n_entries + per_row_solve * n;
  return std::clamp(static_cast<int>(factorisation / solve), 3, 60);
}

/// Multigrid crashes on a matrix that underflow has made 0 or overflow infinite or NaN.
void check_magnitude(const SparseMatrix& a)
{
  double largest = 0;
  bool finite = true;
  for (const double entry : a.diagonal())
  {
    largest = std::max(largest, std::abs(entry));
    finite = finite && std::isfinite(entry);
  }
  if (a.sharing())
  {
    largest = a.sharing()->ranks.max(largest);
    finite = !a.sharing()->ranks.any(!finite);
  }
  if (!finite || largest < std::numeric_limits<double>::min())
    throw SolveError(
        "the matrix leaves the range of numbers: look at the magnitude of material.E, of the mesh and of "
        "nitsche.gamma0");
}

}  // namespace

void KspDeleter::operator()(_p_KSP* ksp) const
{
  if (!detail::waits_for_others(reinterpret_cast<PetscObject>(ksp))) KSPDestroy(&ksp);
}

const char* to_string(LinearMethod method)
{
  switch (method)
  {
    case LinearMethod::automatic:
      return "auto";
    case LinearMethod::direct:
      return "direct";
    case LinearMethod::condensed:
      return "condensed";
    case LinearMethod::iterative:
      return "iterative";
  }
  return "";
}

LinearMethod choose_method(const SolverOptions& config, int dim, std::int64_t n_dofs, Index direct_limit)
{
  if (config.method == LinearMethod::direct || config.method == LinearMethod::iterative) return config.method;
  return dim == 2 || n_dofs <= direct_limit ? LinearMethod::direct : LinearMethod::iterative;
}

template <int dim>
LinearSolver::LinearSolver(const SolverOptions& config, const fem::LagrangeSpace<dim>& space, MatrixKind kind,
                           Index direct_limit)
    : config_(config),
      method_(choose_method(config, dim, space.n_global_dofs(), direct_limit)),
      kind_(kind),
      dim_(dim)
{
  if (method_ == LinearMethod::iterative) multigrid_.emplace(node_hierarchy(space));
}

template <int dim>
LinearSolver::LinearSolver(const SolverOptions& config, std::span<const Point<dim>> nodes, MatrixKind kind,
                           Index direct_limit)
    : config_(config),
      method_(choose_method(config, dim, static_cast<std::int64_t>(dim * nodes.size()), direct_limit)),
      kind_(kind),
      dim_(dim)
{
  if (method_ == LinearMethod::iterative) multigrid_.emplace(node_hierarchy(nodes));
}

template LinearSolver::LinearSolver(const SolverOptions&, const fem::LagrangeSpace<2>&, MatrixKind, Index);
template LinearSolver::LinearSolver(const SolverOptions&, const fem::LagrangeSpace<3>&, MatrixKind, Index);
template LinearSolver::LinearSolver(const SolverOptions&, std::span<const Point<2>>, MatrixKind, Index);
template LinearSolver::LinearSolver(const SolverOptions&, std::span<const Point<3>>, MatrixKind, Index);

void LinearSolver::configure(const SparseMatrix& a)
{
  const detail::Options options(method_ == LinearMethod::iterative, a.sharing());
  KSP ksp = nullptr;
  check(KSPCreate(detail::communicator(a.sharing()), &ksp), "creating a solver");
  ksp_.reset(ksp);
  check(KSPSetType(ksp, KSPFGMRES), "creating a solver");
  check(KSPGMRESSetRestart(ksp, 60), "creating a solver");
  check(KSPSetOptionsPrefix(ksp, "tribound_"), "creating a solver");
  check(KSPSetOperators(ksp, a.handle(), a.handle()), "creating a solver");
  if (multigrid_)
    multigrid_->configure(preconditioner());
  else
    configure_direct(a);
  check(KSPSetFromOptions(ksp), "reading solver options");
}

_p_PC* LinearSolver::preconditioner() const
{
  PC pc = nullptr;
  check(KSPGetPC(ksp_.get(), &pc), "creating a solver");
  return pc;
}

void LinearSolver::configure_direct(const SparseMatrix& a)
{
  const PC pc = preconditioner();
  const bool symmetric = kind_ == MatrixKind::positive_definite;
  if (symmetric) check(MatSetOption(a.handle(), MAT_SPD, PETSC_TRUE), "creating a solver");
  check(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU), "creating a solver");
  // UMFPACK saves milliseconds below 10k degrees of freedom in 2D and costs 20 % more in 3D, so it is used
  // only on request. It has no symmetric factorisation, and none on several ranks.
  const bool umfpack = config_.package == DirectPackage::umfpack && !symmetric && !a.sharing();
  check(PCFactorSetMatSolverType(pc, umfpack ? MATSOLVERUMFPACK : MATSOLVERMUMPS), "creating a solver");
  if (umfpack) return;
  check(PCFactorSetUpMatSolverType(pc), "creating a solver");
  Mat factors = nullptr;
  check(PCFactorGetMatrix(pc, &factors), "creating a solver");
  detail::configure_mumps(factors, dim_);
}

/// Makes a new preconditioner. Setting the operators again tells the KSP that its set-up is out of date.
void LinearSolver::prepare(const SparseMatrix& a, Mat product)
{
  check_magnitude(a);
  const detail::Options options(method_ == LinearMethod::iterative, a.sharing());
  check(KSPSetOperators(ksp_.get(), product, a.handle()), "factorising");
  check(KSPSetReusePreconditioner(ksp_.get(), PETSC_FALSE), "factorising");
  if (multigrid_) multigrid_->renew(preconditioner(), a);
  if (method_ == LinearMethod::direct) detail::count_factorisation();
  check(KSPSetUp(ksp_.get()), "factorising");
  if (multigrid_) multigrid_->settle(preconditioner(), changing_);
  check(KSPSetReusePreconditioner(ksp_.get(), PETSC_TRUE), "factorising");
}

/// Iterations after which a factorisation, where there is one, is the better choice: as many as cost three
/// factorisations in 3D (measured with p = 2: 90 take as long as one at 13k degrees of freedom, 130 at 28k).
int LinearSolver::patience(std::int64_t n) const
{
  return config_.method == LinearMethod::iterative
             ? config_.max_iterations
             : static_cast<int>(std::min<std::int64_t>(config_.max_iterations, 200 + n / 150));
}

LinearSolve LinearSolver::solve(const SparseMatrix& a, std::span<const double> b, double tolerance,
                                std::span<double> x, const ResidualTest& small_enough)
{
  LinearSolve result;
  detail::on_owned_entries(a.sharing(), a.block_size(), b, x,
                           [&](Vec own_b, Vec own_x)
                           { result = solve_owned(a, own_b, tolerance, own_x, small_enough); });
  if (a.sharing()) a.sharing()->update(x, a.block_size());
  return result;
}

LinearSolve LinearSolver::solve_owned(const SparseMatrix& a, Vec b, double tolerance, Vec x,
                                      const ResidualTest& small_enough)
{
  if (method_ == LinearMethod::direct || config_.method == LinearMethod::iterative)
    return attempt(a, b, tolerance, x, small_enough);
  try
  {
    return attempt(a, b, tolerance, x, small_enough);
  }
  catch (const SolveError& error)  // nobody insisted on multigrid
  {
    if (a.sharing()) require_all_failed(a.sharing()->ranks, error.what());
    method_ = LinearMethod::direct;
    ksp_.reset();  // its memory is needed
    multigrid_.reset();
    reuse_budget_ = 0;
  }
  LinearSolve result = attempt(a, b, tolerance, x, small_enough);
  result.fell_back = true;
  return result;
}

LinearSolve LinearSolver::attempt(const SparseMatrix& a, Vec b, double tolerance, Vec x,
                                  const ResidualTest& small_enough)
{
  std::function<bool(Vec)> test;
  if (small_enough && method_ == LinearMethod::iterative)
    test = [&](Vec r) { return small_enough(detail::from_owned_entries(a.sharing(), a.block_size(), r)); };
  if (!ksp_) configure(a);
  std::optional<detail::SingleProduct> single;  // GMRES itself works in double precision
  if (multigrid_) single.emplace(a.handle());
  const Mat product = single ? single->exact() : a.handle();
  check(KSPSetOperators(ksp_.get(), product, a.handle()), "setting up a solver");
  LinearSolve result;
  From from = From::zero;
  if (reuse_budget_ > 0)
  {
    StopRule rule{tolerance, reuse_budget_, true, test};
    const bool converged = iterate(ksp_.get(), b, rule, x, from);
    result.iterations = static_cast<int>(rule.history.size()) - 1;
    if (converged) return result;
    if (rule.history.back() < rule.history.front()) from = From::x;
  }

  prepare(a, product);
  const bool direct = method_ == LinearMethod::direct;
  StopRule rule{tolerance, direct ? 4 : patience(a.global_size()), false, test};
  const bool converged = iterate(ksp_.get(), b, rule, x, from);
  const int iterations = std::max(0, static_cast<int>(rule.history.size()) - 1);
  constexpr double useless = 1e-6;
  PetscReal norm_b = 0;
  check(VecNorm(b, NORM_2, &norm_b), "solving a linear system");
  if (!converged && !(!rule.history.empty() && rule.history.back() <= useless * norm_b))
    throw SolveError(direct
                         ? detail::singular_tangent
                         : "GMRES with multigrid did not converge in " + std::to_string(iterations) +
                               " iterations (try [solver] method = \"direct\" or a larger max_iterations)");
  // With the interpolation kept, a new multigrid hierarchy costs 10 to 15 of its iterations (3D, 40k to
  // 300k), or 4 to 6 if only a part changes.
  const int of_hierarchy = changing_ ? 5 : 12;
  reuse_budget_ = direct ? iterations_worth_a_factorisation(ksp_.get()) : iterations + of_hierarchy;
  result.iterations += iterations;
  result.factorised = true;
  return result;
}

}  // namespace tribound::algebra
