#pragma once

/// @file newton.h
/// The generalised Newton method of method section 2 with damping and running traction.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::solve
{

struct NewtonOptions
{
  double tolerance = 1e-10;  ///< relative residual
  int max_steps = 50;
  bool damping = true;  ///< false: always full steps (for comparisons; may cycle)
  /// The largest force of earlier load steps, if > 0. Residuals are relative to the force of the problem, but
  /// to no less than this, as a state without load has no scale of its own, and to at most ten times this, as
  /// one far off would set its own scale.
  double reference_force = 0;
  /// Whether t^k of the result must be in equilibrium; a start for another solve does not need it.
  bool balanced = true;
  /// Whether <R_lin, phi_i>, by which u^k and t^k are out of equilibrium, is small enough to be solved no
  /// further; absent: when it meets solver.tolerance.
  algebra::ResidualTest small_enough{};
};

struct NewtonStep
{
  int step = 0;               ///< 1-based
  double residual = 0.0;      ///< relative, after the step
  double damping = 1.0;       ///< alpha
  int linear_iterations = 0;  ///< GMRES iterations; 0 for a direct solve
  bool factorised = false;    ///< whether a new factorisation (or preconditioner) was made
  double seconds = 0.0;
  double delta = 0.0;  ///< of T_delta, method section 7; 0 is the plain T
  algebra::LinearMethod method = algebra::LinearMethod::direct;  ///< of the linear solver
  bool fell_back = false;  ///< whether multigrid failed and the direct solver took its place
  int degree = 0;          ///< of the space
  double gamma0 = 0;       ///< of the form
};

enum class NewtonStatus
{
  converged,
  accepted,  ///< by the observer
  diverged,
  too_many_steps
};

template <int dim>
struct NewtonResult
{
  NewtonStatus status = NewtonStatus::too_many_steps;
  std::string message;               ///< what happened, at which step; empty when converged or accepted
  std::vector<double> u;             ///< u^k, dofs of the space
  std::vector<Point<dim>> traction;  ///< t^k at the contact points of the form
  std::vector<NewtonStep> steps;
  std::shared_ptr<Equilibrium<dim>> equilibrium;  ///< the solver used, to solve more of the same form
};

/// What an observer of the iteration sees after each step.
template <int dim>
struct NewtonIterate
{
  const NewtonStep& step;
  std::span<const double> contact_u;     ///< u^k on the cells at the contact boundary, elsewhere anything
  std::span<const Point<dim>> traction;  ///< t^k
  bool converged;                        ///< the residual is below the tolerance, and t^k is T(u^k)
  /// u^k everywhere. If the linear system was solved loosely, this solves it further first, up to
  /// NewtonOptions::small_enough, which changes u^k, t^k and the iterations of the step. From then on t^k is
  /// in equilibrium. It may be called again when small_enough asks for more.
  std::function<std::span<const double>()> u;

  /// u^k everywhere as a loose solve has left it.
  [[nodiscard]] std::span<const double> rough_u() const
  {
    return step.method == algebra::LinearMethod::condensed ? u() : contact_u;
  }
};

/// What an observer says about an iterate.
struct NewtonAdvice
{
  /// Implicit: an observer that never changes delta just says yes or no.
  NewtonAdvice(bool iterate_is_good_enough) : good_enough(iterate_is_good_enough) {}

  bool good_enough;             ///< the iterate is the result
  std::optional<double> delta;  ///< instead: go on from it, converged or not, with T_delta for this delta
};

template <int dim>
using NewtonObserver = std::function<NewtonAdvice(const NewtonIterate<dim>&)>;

/// Solves the discrete problem, with T_delta in the place of T for delta > 0. `start` is a solution carried
/// from a coarser mesh (then the first step linearises there), or empty (then the first step takes contact as
/// closed and sticking). `observer` is called after each step and says what to do with its iterate. t^k is in
/// equilibrium with u^k for any delta, and is kept when delta changes. `equilibrium` of the same form, or of
/// one with another gamma_0, may be given to reuse its factors. Throws SolveError when a matrix is singular.
template <int dim>
[[nodiscard]] NewtonResult<dim> solve(const contact::NitscheForm<dim>& form, std::span<const double> start,
                                      const NewtonOptions& newton, const algebra::SolverOptions& solver,
                                      const NewtonObserver<dim>& observer = {}, double delta = 0,
                                      std::shared_ptr<Equilibrium<dim>> equilibrium = {});

}  // namespace tribound::solve
