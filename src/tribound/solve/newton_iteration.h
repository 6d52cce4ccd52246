#pragma once

/// @file newton_iteration.h
/// The iterates of the generalised Newton method, method section 2.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/solve/equilibrium.h"
#include "tribound/solve/linearised.h"
#include "tribound/solve/newton.h"

namespace tribound::solve
{

/// u^k and t^k on one mesh, and the steps between them. Keeps references to form and options.
template <int dim>
class NewtonIteration
{
 public:
  /// `linear_tolerance`: of SolverOptions; `delta`: of T_delta, a stress.
  NewtonIteration(const contact::NitscheForm<dim>& form, const NewtonOptions& newton, double linear_tolerance,
                  double delta, std::shared_ptr<Equilibrium<dim>> equilibrium);

  /// Sets u^0: `start` with the prescribed values; if it is empty, 0 elsewhere.
  void initialise(std::span<const double> start);
  /// Begins step k.
  void begin(int k);
  /// Solves a(u + delta, v) - (T_lin(u + delta), v)_C = L(v), moves along delta and updates t^k. Throws
  /// SolveError, which names the step.
  void step(contact::Linearisation kind);
  /// From now on uses T_delta with this delta, which changes the residual of u^k.
  void regularise(double delta);
  /// u^k everywhere, computed when it is first asked for, with t^k in equilibrium.
  [[nodiscard]] std::vector<double>& displacement();
  /// The same as the result of the iteration: balanced only if NewtonOptions::balanced asks for it. An
  /// observer that has asked for u has a bound for it, so that it is solved no further.
  [[nodiscard]] std::vector<double> take_displacement();

  /// Whether nothing is loaded and nothing moves.
  [[nodiscard]] bool at_rest() const { return scale_ == 0 && residual_norm_ == 0; }
  [[nodiscard]] bool in_balance() const { return residual_norm_ <= smallest_residual(); }
  /// Whether t^k = T(u^k) as far as it matters, by forces at the contact points. A margin allows for their
  /// number, so that the residual decides wherever all of them act on degrees of freedom.
  [[nodiscard]] bool traction_settled() const;
  [[nodiscard]] double residual_norm() const { return residual_norm_; }
  [[nodiscard]] std::string describe_residual() const;
  /// The report of step k.
  [[nodiscard]] NewtonStep& report() { return report_; }
  [[nodiscard]] std::span<const double> contact_displacement() const { return u_; }
  [[nodiscard]] std::vector<Point<dim>>& traction() { return traction_; }
  [[nodiscard]] std::shared_ptr<Equilibrium<dim>>& equilibrium() { return equilibrium_; }

 private:
  void set_residual(std::vector<double> r);
  [[nodiscard]] double forcing_term() const;
  [[nodiscard]] double tight_target(std::span<const double> rhs) const;
  void balance_traction();
  [[nodiscard]] double smallest_residual() const
  {
    return std::max(config_.tolerance * scale_, equilibrium_->round_off(x_));
  }
  [[nodiscard]] double relative_residual() const
  {
    return scale_ > 0 ? residual_norm_ / scale_ : residual_norm_;
  }
  [[nodiscard]] algebra::LinearSolve solve_tangent(std::span<const double> rhs, double target,
                                                   std::span<double> delta,
                                                   const algebra::ResidualTest& small_enough = {});
  [[nodiscard]] double search(std::span<const double> direction, bool full_step);

  const contact::NitscheForm<dim>& form_;
  const NewtonOptions& config_;
  double delta_;  ///< of T_delta
  double linear_tolerance_;
  std::shared_ptr<Equilibrium<dim>> equilibrium_;
  double scale_;  ///< of the forces that balance

  std::vector<double> x_;             ///< u^k as unknowns of the equilibrium
  std::vector<double> internal_;      ///< their internal forces
  std::vector<double> u_;             ///< what is linearised at: u^k on cells at the contact boundary
  std::vector<double> residual_;      ///< <R(u^k), phi_i>
  std::vector<Point<dim>> traction_;  ///< t^k
  double residual_norm_ = 0;
  double norm_before_ = 0;                           ///< of the residual of u^{k-1}
  NewtonStep report_;                                ///< of step k
  Linearised<dim> linearised_;                       ///< in step k
  bool loose_ = false;                               ///< t^k is not in equilibrium with u^k
  std::optional<std::vector<double>> displacement_;  ///< u^k everywhere, where it has been asked for
};

}  // namespace tribound::solve
