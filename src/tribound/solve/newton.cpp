#include "tribound/solve/newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tribound/algebra/linear_solver.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/clock.h"
#include "tribound/base/norm.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::solve
{

namespace
{

/// y += a x
void axpy(double a, std::span<const double> x, std::span<double> y)
{
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += a * x[i];
}

/// The state of the iteration on one mesh.
template <int dim>
class Newton
{
 public:
  Newton(const contact::NitscheForm<dim>& form, const NewtonOptions& newton,
         const algebra::SolverOptions& solver, double delta)
      : form_(form),
        config_(newton),
        delta_(delta),
        linear_tolerance_(solver.tolerance),
        stiffness_(form.space().n_dofs(), dim,
                   contact::stiffness(form.problem(), form.space(), form.constraints())),
        contact_(form.space().n_dofs(), dim,
                 form.contact_tangent(contact::Linearisation::closed_sticking, zero())),
        tangent_(algebra::SparseMatrix::sum(stiffness_, contact_)),
        diagonal_(stiffness_.diagonal()),
        linear_solver_(solver, std::span<const Point<dim>>(form.space().node_points()))
  {
  }

  NewtonResult<dim> run(std::span<const double> start, const NewtonObserver<dim>& observer);

 private:
  [[nodiscard]] std::vector<double> zero() const { return std::vector<double>(form_.space().n_dofs(), 0.0); }
  void initialise(std::span<const double> start);
  void set_residual(std::vector<double> r);
  void regularise(double delta);
  [[nodiscard]] std::vector<double> residual(std::span<const Point<dim>> traction,
                                             std::span<const double> ku) const;
  [[nodiscard]] double round_off() const;
  [[nodiscard]] bool in_balance() const { return residual_norm_ <= smallest_residual(); }
  [[nodiscard]] double smallest_residual() const { return std::max(config_.tolerance * scale_, round_off()); }
  [[nodiscard]] bool traction_settled() const;
  [[nodiscard]] double relative_residual() const
  {
    return scale_ > 0 ? residual_norm_ / scale_ : residual_norm_;
  }
  [[nodiscard]] std::string describe_residual() const;
  [[nodiscard]] NewtonStep step(int k, contact::Linearisation kind);
  [[nodiscard]] algebra::LinearSolve solve_tangent(int k, std::span<const double> rhs, double target,
                                                   std::span<double> delta);
  [[nodiscard]] double search(std::span<const double> direction, bool full_step);

  const contact::NitscheForm<dim>& form_;
  const NewtonOptions& config_;
  double delta_;  ///< of T_delta
  double linear_tolerance_;
  algebra::SparseMatrix stiffness_;  ///< a(phi_j, phi_i)
  algebra::SparseMatrix contact_;    ///< -(DT(u)[phi_j], phi_i)_C
  algebra::SparseMatrix tangent_;    ///< their sum
  std::vector<double> diagonal_;     ///< of the stiffness
  algebra::LinearSolver linear_solver_;

  std::vector<double> u_;             ///< u^k
  std::vector<double> ku_;            ///< a(u^k - lifting of u_D, phi_i)
  std::vector<double> load_;          ///< L(phi_i) - a(lifting of u_D, phi_i) for free i, else 0
  std::vector<double> residual_;      ///< <R(u^k), phi_i> for free i, else 0
  std::vector<Point<dim>> traction_;  ///< t^k
  double residual_norm_ = 0;
  double scale_ = 0;  ///< size of the forces that balance: the residual is measured against it
};

/// Sets entries of fixed degrees of freedom to 0.
void restrict_to_free(const fem::Constraints& constraints, std::span<double> v)
{
  for (std::size_t i = 0; i < v.size(); ++i)
    if (constraints.fixed[i]) v[i] = 0;
}

template <int dim>
void Newton<dim>::initialise(std::span<const double> start)
{
  const fem::Constraints& constraints = form_.constraints();
  u_ = start.empty() ? zero() : std::vector<double>(start.begin(), start.end());
  std::vector<double> free_part = u_;
  restrict_to_free(constraints, free_part);
  for (std::size_t i = 0; i < u_.size(); ++i)
    if (constraints.fixed[i]) u_[i] = constraints.values[i];

  ku_ = stiffness_.multiply(free_part);
  load_.assign(form_.load().begin(), form_.load().end());
  std::vector<double> lifting = contact::apply_stiffness(form_.problem(), form_.space(), constraints.values);
  restrict_to_free(constraints, lifting);
  restrict_to_free(constraints, load_);
  scale_ = norm(load_) + norm(lifting);
  axpy(-1, lifting, load_);
  traction_ = form_.traction(u_, delta_);
  set_residual(residual(traction_, ku_));
}

template <int dim>
void Newton<dim>::set_residual(std::vector<double> r)
{
  residual_ = std::move(r);
  residual_norm_ = norm(residual_);
}

/// From here on T_delta with this delta: the residual of u^k becomes another.
template <int dim>
void Newton<dim>::regularise(double delta)
{
  delta_ = delta;
  set_residual(residual(form_.traction(u_, delta_), ku_));
}

/// <R, phi_i> = L(phi_i) - a(u, phi_i) + (t, phi_i)_C for free i.
template <int dim>
std::vector<double> Newton<dim>::residual(std::span<const Point<dim>> traction,
                                          std::span<const double> ku) const
{
  std::vector<double> r = load_;
  axpy(-1, ku, r);
  form_.add_contact_load(traction, r);
  restrict_to_free(form_.constraints(), r);
  return r;
}

/// What the residual cannot resolve: round-off in K u, estimated through the diagonal of K.
template <int dim>
double Newton<dim>::round_off() const
{
  double sum = 0;
  for (std::size_t i = 0; i < u_.size(); ++i) sum += std::pow(diagonal_[i] * u_[i], 2);
  return 10 * std::numeric_limits<double>::epsilon() * std::sqrt(sum);
}

/// Whether t^k = T(u^k) as far as it matters: forces at the contact points, with a margin for their number,
/// so that where degrees of freedom feel them all the residual decides.
template <int dim>
bool Newton<dim>::traction_settled() const
{
  constexpr double margin = 100;
  const std::vector<Point<dim>> t = form_.traction(u_, delta_);
  double sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
    sum += (form_.contact_points()[i].weight * (t[i] - traction_[i])).squaredNorm();
  return std::sqrt(sum) <= margin * smallest_residual();
}

template <int dim>
std::string Newton<dim>::describe_residual() const
{
  return fmt::format("the relative residual is {:.3g}, above newton.tolerance = {:g}", relative_residual(),
                     config_.tolerance);
}

/// Moves u by alpha times the direction with the largest alpha = 1, 1/2, 1/4, ... that lowers the residual,
/// or, when none does, with the best of them. Returns alpha.
template <int dim>
double Newton<dim>::search(std::span<const double> direction, bool full_step)
{
  constexpr int max_halvings = 10;
  const std::vector<double> k_direction = stiffness_.multiply(direction);
  struct Trial
  {
    double alpha = 0;
    double norm = std::numeric_limits<double>::infinity();
    std::vector<double> u, ku, residual;
  } best;
  const double good_enough = smallest_residual();
  double alpha = 1;
  for (int halvings = 0; halvings <= max_halvings; ++halvings, alpha /= 2)
  {
    Trial trial{alpha, 0, u_, ku_, {}};
    axpy(alpha, direction, trial.u);
    axpy(alpha, k_direction, trial.ku);
    trial.residual = residual(form_.traction(trial.u, delta_), trial.ku);
    trial.norm = norm(trial.residual);
    if (full_step || trial.norm < best.norm) best = std::move(trial);
    if (full_step || best.norm < std::max(residual_norm_, good_enough)) break;
  }
  u_ = std::move(best.u);
  ku_ = std::move(best.ku);
  residual_ = std::move(best.residual);
  residual_norm_ = best.norm;
  return best.alpha;
}

/// Solves with the tangent; says at which step it failed.
template <int dim>
algebra::LinearSolve Newton<dim>::solve_tangent(int k, std::span<const double> rhs, double target,
                                                std::span<double> delta)
{
  try
  {
    return linear_solver_.solve(tangent_, rhs, target, delta);
  }
  catch (const SolveError& error)
  {
    throw SolveError("Newton step " + std::to_string(k) + ": " + error.what());
  }
}

/// Solves a(u + delta, v) - (T_lin(u + delta), v)_C = L(v), moves along delta and updates t^k.
template <int dim>
NewtonStep Newton<dim>::step(int k, contact::Linearisation kind)
{
  const bool first = k == 1;
  contact_.set_values(form_.contact_tangent(kind, u_, delta_).values);
  tangent_.assign_sum(stiffness_, contact_);
  const std::vector<double> rhs = residual(form_.linearised_traction(kind, u_, u_, delta_), ku_);
  const double target = std::max(
      {std::min(linear_tolerance_, 0.1 * config_.tolerance) * scale_, round_off(), 1e-14 * norm(rhs)});
  std::vector<double> delta = zero();
  const algebra::LinearSolve linear = solve_tangent(k, rhs, target, delta);

  std::vector<double> target_u = u_;
  axpy(1, delta, target_u);
  const std::vector<Point<dim>> t_lin = form_.linearised_traction(kind, u_, target_u, delta_);
  const double alpha = search(delta, first || !config_.damping);
  for (std::size_t i = 0; i < t_lin.size(); ++i)
    traction_[i] = first ? t_lin[i] : (1 - alpha) * traction_[i] + alpha * t_lin[i];

  NewtonStep report;
  report.step = k;
  report.residual = relative_residual();
  report.damping = alpha;
  report.delta = delta_;
  report.linear_iterations = linear.iterations;
  report.factorised = linear.factorised;
  report.method = linear_solver_.method();
  report.fell_back = linear.fell_back;
  return report;
}

template <int dim>
NewtonResult<dim> Newton<dim>::run(std::span<const double> start, const NewtonObserver<dim>& observer)
{
  NewtonResult<dim> result;
  initialise(start);
  const bool nothing_moves = start.empty() && residual_norm_ == 0;
  int without_progress = 0;
  for (int k = 1; k <= config_.max_steps && result.status == NewtonStatus::too_many_steps; ++k)
  {
    const Clock::time_point begin = Clock::now();
    const bool from_scratch = k == 1 && start.empty();
    const double before = residual_norm_;
    NewtonStep report{.step = k, .delta = delta_, .method = linear_solver_.method()};
    if (!nothing_moves)
      report =
          step(k, from_scratch ? contact::Linearisation::closed_sticking : contact::Linearisation::newton);
    report.seconds = seconds_since(begin);
    result.steps.push_back(report);
    without_progress = k > 1 && residual_norm_ >= before ? without_progress + 1 : 0;
    const bool converged =
        in_balance() && (k == config_.max_steps || without_progress > 0 || traction_settled());
    const NewtonAdvice advice = observer ? observer({report, u_, traction_, converged}) : false;
    if (advice.delta)
    {
      regularise(*advice.delta);
      without_progress = 0;
      continue;
    }

    if (converged)
      result.status = NewtonStatus::converged;
    else if (advice.good_enough)
      result.status = NewtonStatus::accepted;
    else if ((config_.damping && without_progress == 3) || !std::isfinite(residual_norm_))
    {
      result.status = NewtonStatus::diverged;
      result.message =
          fmt::format("at step {} no step length lowers the residual any more; {}", k, describe_residual());
      break;
    }
  }
  if (result.status == NewtonStatus::too_many_steps)
    result.message =
        fmt::format("step {} was the last of newton.max_steps; {}", config_.max_steps, describe_residual());
  result.u = std::move(u_);
  result.traction = std::move(traction_);
  return result;
}

}  // namespace

template <int dim>
NewtonResult<dim> solve(const contact::NitscheForm<dim>& form, std::span<const double> start,
                        const NewtonOptions& newton, const algebra::SolverOptions& solver,
                        const NewtonObserver<dim>& observer, double delta)
{
  return Newton<dim>(form, newton, solver, delta).run(start, observer);
}

template NewtonResult<2> solve(const contact::NitscheForm<2>&, std::span<const double>, const NewtonOptions&,
                               const algebra::SolverOptions&, const NewtonObserver<2>&, double);
template NewtonResult<3> solve(const contact::NitscheForm<3>&, std::span<const double>, const NewtonOptions&,
                               const algebra::SolverOptions&, const NewtonObserver<3>&, double);

}  // namespace tribound::solve
