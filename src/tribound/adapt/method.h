#pragma once

/// @file method.h
/// The method with all its options: what solve_and_certify() does on one mesh.

#include <optional>

#include "tribound/adapt/regularisation.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/solve/newton.h"

namespace tribound::adapt
{

enum class Stopping
{
  adaptive,        ///< eta_lin is a fraction of the rest, summed over the mesh
  adaptive_local,  ///< the same on every cell
  tolerance,       ///< NewtonOptions::tolerance, and every iterate has its bound
  last_bounded     ///< NewtonOptions::tolerance, and the last iterate alone has its bound
};

/// When Newton's method ends on a mesh.
struct StoppingOptions
{
  Stopping criterion = Stopping::adaptive;
  double gamma_lin = 0.1;  ///< adaptive: eta_lin <= gamma_lin * (the other components)
  bool finish = true;      ///< converge to NewtonOptions::tolerance on the last level, whatever the criterion
};

struct Method
{
  int degree = 2;                  ///< p = 1, ..., fem::max_degree
  std::optional<double> gamma0{};  ///< > 0; contact::default_gamma0(degree) where absent
  solve::NewtonOptions newton{};
  StoppingOptions stopping{};
  std::optional<RegularisationOptions> regularisation{};  ///< the plain method where absent
  algebra::SolverOptions solver{};
  certify::ContactRule contact_rule = certify::ContactRule::resolved;
  certify::PatchStress stress = certify::PatchStress::rows;  ///< of the bound of the residual

  /// With newton.damping: the number of full steps tried before Newton's method restarts with damped ones.
  /// Where a front moves, full steps need half as many; where bodies are pressed shut or slide back, they may
  /// cycle.
  int full_steps = 0;
  /// Whether Newton's method may restart from other starts; not along a path, since it could leave the
  /// branch.
  bool other_starts = true;

  /// gamma_0 of method section 2.
  [[nodiscard]] double gamma_0() const { return gamma0.value_or(contact::default_gamma0(degree)); }
};

}  // namespace tribound::adapt
