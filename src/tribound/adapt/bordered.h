#pragma once

/// @file bordered.h
/// Newton's method for u and the load factor t together (method section 12.7).

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tribound/adapt/path_measure.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/solve/newton.h"

namespace tribound::adapt
{

/// A point of a load path.
struct PathPoint
{
  double t = 0;
  std::vector<double> u{};
};

struct BorderedOptions
{
  int max_steps = 20;
  double tolerance = 1e-10;      ///< of the residual, over `force`
  double measure_tolerance = 0;  ///< of C(u)
  double force = 1;              ///< the largest force of the path so far
  double t_before = 0;           ///< t at which the load step begins
  double largest_change = 0;     ///< of t, from t_before
  double difference = 1e-6;      ///< of t, for derivatives with respect to t
};

/// Finds u and t with a(u, v) - (T(u; t), v)_C = L(t; v) for all v and C(u) = target. Takes full Newton
/// steps: J d = r and J d' = dr/dt are solved with the same factors of J, and dt follows from the linearised
/// C. The derivative of r with respect to t, including prescribed displacements and all other data, is a
/// difference quotient over BorderedOptions::difference. Its error slows the method down but does not enter
/// the result.
///
/// The solution found here is not certified: the iterates of Newton's method at the t found are.
template <int dim>
class Bordered
{
 public:
  using Form = std::shared_ptr<const contact::NitscheForm<dim>>;
  /// The discrete problem at t. All of them have the same space, fixed degrees of freedom and history.
  using FormAt = std::function<Form(double)>;

  /// `form` may be any form on the mesh: what all steps share does not depend on it.
  Bordered(Form form, const algebra::SolverOptions& solver);
  ~Bordered();

  /// From `point` to the solution; `observer` sees each step. Returns why there is no solution, empty on
  /// success; on failure `point` is undefined. Throws SolveError where J is singular. On several ranks all
  /// call it together.
  [[nodiscard]] std::string operator()(const FormAt& form_at, const PathMeasure<dim>& measure, double target,
                                       const BorderedOptions& options, PathPoint& point,
                                       const std::function<void(const solve::NewtonStep&)>& observer);

 private:
  struct State;
  void move(const State& now, const State& then, const PathMeasure<dim>& measure, double target,
            const BorderedOptions& options, PathPoint& point, solve::NewtonStep& step);

  Form form_;  ///< the form of the equilibrium
  std::unique_ptr<solve::Equilibrium<dim>> equilibrium_;
};

}  // namespace tribound::adapt
