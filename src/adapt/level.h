#pragma once

/// @file level.h
/// One mesh of the adaptive algorithm: the discrete problem, Newton's method with the bound of every iterate,
/// and the identities of the iterate that is kept.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "case/config.h"
#include "certify/checks.h"
#include "certify/estimate.h"
#include "certify/stress.h"
#include "contact/nitsche.h"
#include "solve/newton.h"

namespace tribound
{

/// A mesh with everything up to the discrete problem on it. Its parts refer to each other: it stays where it
/// is made.
template <int dim>
struct Discretisation
{
  Discretisation(Mesh<dim> m, const Problem<dim>& problem, const Config& config)
      : mesh(std::move(m)), space(mesh, config.degree), form(problem, space, config.gamma0())
  {
  }
  Discretisation(const Discretisation&) = delete;
  Discretisation& operator=(const Discretisation&) = delete;

  Mesh<dim> mesh;
  LagrangeSpace<dim> space;
  NitscheForm<dim> form;  ///< a(u,v) - (T(u),v)_C - L(v)
};

/// A Newton step with the bound of its iterate.
struct CertifiedStep
{
  NewtonStep step;
  std::optional<Bound> bound;           ///< absent where the iterate is not finite
  bool accepted = false;                ///< whether its iterate was taken as the solution on the mesh
  std::optional<double> relative = {};  ///< bound / ||sigma(u^k)||
};

/// The solution on one mesh and what is known of its error.
template <int dim>
struct CertifiedLevel
{
  std::string failure;  ///< why there is no solution; empty when there is
  std::vector<double> u;
  std::vector<CertifiedStep> steps;
  Stress<dim> stress;
  Estimate estimate;
  double sigma_norm = 0;  ///< ||sigma(u)||
  IdentityDefects identities;
  double solve_seconds = 0;    ///< wall time
  double certify_seconds = 0;  ///< of all iterates

  [[nodiscard]] bool solved() const { return failure.empty(); }
};

/// Whether iterating further is pointless, method section 6:
/// eta_lin1 + eta_lin2n + eta_lin2t <= gamma_lin (eta_osc + eta_str + eta_Neu + eta_cnt + eta_frc).
[[nodiscard]] bool linearisation_is_negligible(const BoundComponents& eta, double gamma_lin);

/// Called after every Newton step; may throw to leave the level.
using StepObserver = std::function<void(const CertifiedStep&)>;

/// Newton's method from `start` (empty: from scratch) with the bound of every iterate. With
/// Stopping::adaptive it ends at the first iterate whose linearisation error is negligible. Throws SolveError
/// when a matrix is singular or a patch has no equilibrated stress.
template <int dim>
[[nodiscard]] CertifiedLevel<dim> solve_and_certify(const NitscheForm<dim>& form,
                                                    std::span<const double> start, const Config& config,
                                                    const StepObserver& observer = {});

}  // namespace tribound
