#include "tribound/solve/newton_iteration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/base/error.h"

namespace tribound::solve
{

namespace
{

/// y += a x
void axpy(double a, std::span<const double> x, std::span<double> y)
{
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += a * x[i];
}

/// What residuals are relative to: NewtonOptions::reference_force.
double force_scale(double of_problem, double reference)
{
  return reference > 0 ? std::clamp(of_problem, reference, 10 * reference) : of_problem;
}

}  // namespace

template <int dim>
NewtonIteration<dim>::NewtonIteration(const contact::NitscheForm<dim>& form, const NewtonOptions& newton,
                                      double linear_tolerance, double delta,
                                      std::shared_ptr<Equilibrium<dim>> equilibrium)
    : form_(form),
      config_(newton),
      delta_(delta),
      linear_tolerance_(linear_tolerance),
      equilibrium_(std::move(equilibrium)),
      scale_(force_scale(equilibrium_->force_scale(), newton.reference_force))
{
}

template <int dim>
void NewtonIteration<dim>::initialise(std::span<const double> start)
{
  u_.assign(form_.space().n_dofs(), 0.0);
  std::ranges::copy(start, u_.begin());
  form_.prescribe(u_);
  x_ = equilibrium_->unknowns(u_);
  internal_ = equilibrium_->internal_forces(x_);
  traction_ = form_.traction(u_, delta_);
  set_residual(equilibrium_->residual(internal_, traction_));
}

template <int dim>
void NewtonIteration<dim>::set_residual(std::vector<double> r)
{
  residual_ = std::move(r);
  residual_norm_ = equilibrium_->norm(residual_);
}

template <int dim>
void NewtonIteration<dim>::regularise(double delta)
{
  delta_ = delta;
  set_residual(equilibrium_->residual(internal_, form_.traction(u_, delta_)));
}

/// Relative residual to which the linear system of step k is solved, adapted to the convergence of Newton's
/// method [EisenstatWalker96, choice 2]. Only multigrid gains by it.
template <int dim>
double NewtonIteration<dim>::forcing_term() const
{
  constexpr double largest = 0.1;
  constexpr double smallest = 1e-4;
  if (equilibrium_->method() != algebra::LinearMethod::iterative) return 0;
  if (norm_before_ == 0) return largest;
  return std::clamp(0.9 * std::pow(residual_norm_ / norm_before_, 2), smallest, largest);
}

/// Residual at which a linear system counts as solved exactly.
template <int dim>
double NewtonIteration<dim>::tight_target(std::span<const double> rhs) const
{
  return std::max({std::min(linear_tolerance_, 0.1 * config_.tolerance) * scale_, equilibrium_->round_off(x_),
                   1e-14 * equilibrium_->norm(rhs)});
}

/// Brings t^k into equilibrium with u^k after a loose solve. Corrects both by the tangent of step k, so that
/// K u^k - (t^k, v)_C changes by the defect.
template <int dim>
void NewtonIteration<dim>::balance_traction()
{
  if (!loose_) return;
  const std::vector<double> defect = equilibrium_->residual(internal_, traction_);
  if (config_.small_enough && config_.small_enough(defect)) return;
  displacement_.reset();
  std::vector<double> delta(x_.size(), 0.0);
  const double target = tight_target(defect);
  report_.linear_iterations += solve_tangent(defect, target, delta, config_.small_enough).iterations;
  const std::vector<Point<dim>> before = linearised_.traction(form_, u_);
  axpy(1, delta, x_);
  axpy(1, equilibrium_->internal_forces(delta), internal_);
  equilibrium_->displace_contact(x_, u_);
  const std::vector<Point<dim>> after = linearised_.traction(form_, u_);
  for (std::size_t i = 0; i < after.size(); ++i) traction_[i] += after[i] - before[i];
  set_residual(equilibrium_->residual(internal_, form_.traction(u_, delta_)));
  loose_ = config_.small_enough && equilibrium_->norm(equilibrium_->residual(internal_, traction_)) > target;
}

template <int dim>
std::vector<double>& NewtonIteration<dim>::displacement()
{
  balance_traction();
  if (!displacement_) displacement_ = equilibrium_->displacement(x_);
  return *displacement_;
}

template <int dim>
bool NewtonIteration<dim>::traction_settled() const
{
  constexpr double margin = 100;
  const std::vector<Point<dim>> t = form_.traction(u_, delta_);
  double sum = 0;
  for (std::size_t i = 0; i < form_.n_owned_contact_points(); ++i)
    sum += (form_.contact_points()[i].weight * (t[i] - traction_[i])).squaredNorm();
  return std::sqrt(form_.space().mesh().ranks().sum(sum)) <= margin * smallest_residual();
}

template <int dim>
std::string NewtonIteration<dim>::describe_residual() const
{
  return fmt::format("the relative residual is {:.3g}, above newton.tolerance = {:g}", relative_residual(),
                     config_.tolerance);
}

/// Moves u by alpha times the direction, with the largest alpha = 1, 1/2, 1/4, ... that lowers the residual,
/// or the best of them if none does. Returns alpha.
template <int dim>
double NewtonIteration<dim>::search(std::span<const double> direction, bool full_step)
{
  constexpr int max_halvings = 10;
  const std::vector<double> of_direction = equilibrium_->internal_forces(direction);
  struct Trial
  {
    double alpha = 0;
    double norm = 0;
    std::vector<double> x, internal, residual;
  } best;
  const double good_enough = smallest_residual();
  double alpha = 1;
  for (int halvings = 0; halvings <= max_halvings; ++halvings, alpha /= 2)
  {
    Trial trial{alpha, 0, x_, internal_, {}};
    axpy(alpha, direction, trial.x);
    axpy(alpha, of_direction, trial.internal);
    equilibrium_->displace_contact(trial.x, u_);
    trial.residual = equilibrium_->residual(trial.internal, form_.traction(u_, delta_));
    trial.norm = equilibrium_->norm(trial.residual);
    if (halvings == 0 || trial.norm < best.norm) best = std::move(trial);
    if (full_step || best.norm < std::max(residual_norm_, good_enough)) break;
  }
  x_ = std::move(best.x);
  displacement_.reset();
  equilibrium_->displace_contact(x_, u_);
  internal_ = std::move(best.internal);
  residual_ = std::move(best.residual);
  residual_norm_ = best.norm;
  return best.alpha;
}

/// Solves with the tangent of the step; a failure names the step.
template <int dim>
algebra::LinearSolve NewtonIteration<dim>::solve_tangent(std::span<const double> rhs, double target,
                                                         std::span<double> delta,
                                                         const algebra::ResidualTest& small_enough)
{
  try
  {
    return equilibrium_->solve(form_, linearised_, rhs, target, delta, small_enough);
  }
  catch (const SolveError& error)
  {
    throw SolveError("Newton step " + std::to_string(report_.step) + ": " + error.what());
  }
}

template <int dim>
void NewtonIteration<dim>::step(contact::Linearisation kind)
{
  const bool first = report_.step == 1;
  linearised_ = {kind, u_, delta_};
  std::vector<double> target_u = u_;
  std::vector<double> rhs = residual_;  // T_lin = T at the point of linearisation
  if (first)
  {
    equilibrium_->displace_contact(x_, target_u);
    rhs = equilibrium_->residual(internal_, linearised_.traction(form_, target_u));
  }
  const double tight = tight_target(rhs);
  const double target = std::max(tight, forcing_term() * equilibrium_->norm(rhs));
  norm_before_ = residual_norm_;
  loose_ = target > tight;
  std::vector<double> delta(x_.size(), 0.0);
  const algebra::LinearSolve linear = solve_tangent(rhs, target, delta);

  std::vector<double> target_x = x_;
  axpy(1, delta, target_x);
  equilibrium_->displace_contact(target_x, target_u);
  const std::vector<Point<dim>> t_lin = linearised_.traction(form_, target_u);
  const double alpha = search(delta, first || !config_.damping);
  for (std::size_t i = 0; i < t_lin.size(); ++i)
    traction_[i] = first ? t_lin[i] : (1 - alpha) * traction_[i] + alpha * t_lin[i];

  report_.residual = relative_residual();
  report_.damping = alpha;
  report_.linear_iterations = linear.iterations;
  report_.factorised = linear.factorised;
  report_.method = equilibrium_->method();
  report_.fell_back = linear.fell_back;
}

template <int dim>
void NewtonIteration<dim>::begin(int k)
{
  report_ = {.step = k,
             .delta = delta_,
             .method = equilibrium_->method(),
             .degree = form_.space().degree(),
             .gamma0 = form_.gamma0()};
}

template <int dim>
std::vector<double> NewtonIteration<dim>::take_displacement()
{
  loose_ = loose_ && config_.balanced;
  return displacement_ ? std::move(*displacement_) : std::move(displacement());
}

template class NewtonIteration<2>;
template class NewtonIteration<3>;

}  // namespace tribound::solve
