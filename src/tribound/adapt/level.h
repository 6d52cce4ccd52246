#pragma once

/// @file level.h
/// One mesh of the adaptive algorithm: the discrete problem, Newton's method with the bound of every iterate,
/// and the identities of the iterate that is kept.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/method.h"
#include "tribound/certify/bound/certificate.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/pairing/partners.h"
#include "tribound/solve/newton.h"

namespace tribound::adapt
{

/// A mesh with a space on it. Not movable: the space refers to the mesh.
template <int dim>
struct Grid
{
  Grid(mesh::Mesh<dim> m, int degree) : mesh(std::move(m)), space(mesh, degree) {}
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;

  mesh::Mesh<dim> mesh;
  fem::LagrangeSpace<dim> space;
};

/// A mesh with everything up to the discrete problem on it. Not movable: its parts refer to each other.
template <int dim>
struct Discretisation
{
  Discretisation(mesh::Mesh<dim> m, const problem::Problem<dim>& problem, const Method& method,
                 const contact::DataAccuracy& accuracy = {})
      : Discretisation(std::make_shared<const Grid<dim>>(
                           contact::with_partners<dim>(std::move(m), problem.pairs()), method.degree),
                       problem, method, accuracy)
  {
  }
  /// Another problem with the same pairs, on the mesh of an existing discretisation.
  Discretisation(std::shared_ptr<const Grid<dim>> of, const problem::Problem<dim>& problem,
                 const Method& method, const contact::DataAccuracy& accuracy = {})
      : grid(std::move(of)),
        mesh(grid->mesh),
        space(grid->space),
        form(problem, space, method.gamma_0(), accuracy)
  {
  }
  Discretisation(const Discretisation&) = delete;
  Discretisation& operator=(const Discretisation&) = delete;

  /// The matching facets of bodies in contact.
  [[nodiscard]] std::vector<mesh::TwinFacets<dim>> twins() const
  {
    return contact::twin_facets<dim>(mesh, form.segments());
  }

  std::shared_ptr<const Grid<dim>> grid;
  const mesh::Mesh<dim>& mesh;
  const fem::LagrangeSpace<dim>& space;
  contact::NitscheForm<dim> form;  ///< a(u,v) - (T(u),v)_C - L(v)
};

/// A Newton step with the bound of its iterate.
struct CertifiedStep
{
  solve::NewtonStep step;
  /// Absent where the iterate is not finite, or ruled out by its linearisation error (solve_and_certify).
  std::optional<certify::Bound> bound = {};
  bool accepted = false;                ///< whether the iterate was accepted as the solution on the mesh
  std::optional<double> relative = {};  ///< bound / ||sigma(u^k)||
  /// lin1, lin2n and lin2t, the others 0; absent where the iterate is not finite.
  std::optional<certify::BoundComponents> linearisation = {};
};

/// Wall time spent on making a mesh; 0 for the given one.
struct RefinementSeconds
{
  double bisect = 0;      ///< marking and bisection, with the topology of the new mesh
  double discretise = 0;  ///< space, load and contact points
  double transfer = 0;    ///< the solution carried over
};

/// The solution on one mesh and what is known of its error.
template <int dim>
struct CertifiedLevel
{
  std::string failure;  ///< why there is no solution; empty when there is
  std::vector<double> u;
  std::vector<Point<dim>> traction;  ///< t^k at the contact points, in equilibrium with the loads
  std::vector<CertifiedStep> steps;
  int finishing_steps = 0;           ///< those at the end that the criterion did not require
  bool converged = false;            ///< to newton.tolerance, not only as far as the bound needs
  bool tightened = false;            ///< whether its systems were solved again, see solve_and_certify()
  double delta = 0;                  ///< of the regularised variant, for the next mesh
  std::optional<int> delta_updates;  ///< how often delta was shrunk; absent in the plain method
  certify::Stress<dim> stress;
  certify::Estimate estimate;
  contact::StressNorms norms{};  ///< of u
  certify::IdentityDefects identities;
  std::optional<certify::EnergyBound> energy{};  ///< of u; absent: not asked for
  std::optional<certify::FriedrichsConstant>
      friedrichs;              ///< of this mesh or a previous one; absent: no bound yet
  double solve_seconds = 0;    ///< wall time
  double certify_seconds = 0;  ///< of all iterates
  double solve_cpu = 0;        ///< CPU time, all threads
  double certify_cpu = 0;
  RefinementSeconds refinement;
  std::shared_ptr<solve::Equilibrium<dim>> equilibrium;  ///< with factors, for converge()

  [[nodiscard]] bool solved() const { return failure.empty(); }
};

/// Whether further iteration is pointless, method section 6:
/// eta_lin1 + eta_lin2n + eta_lin2t <= gamma_lin (eta_osc + eta_quad + eta_str + eta_Neu + eta_cnt +
/// eta_frc), where T is regularised with eta_reg1 + eta_reg2n + eta_reg2t among the others.
[[nodiscard]] bool linearisation_is_negligible(const certify::BoundComponents& eta, double gamma_lin);

/// The same for the whole bound (Stopping::adaptive), or on every cell of all ranks (adaptive_local);
/// otherwise false.
[[nodiscard]] bool linearisation_is_negligible(const certify::Estimate& estimate,
                                               const StoppingOptions& stopping, const Ranks& ranks = {});

/// Called after every Newton step; may throw to leave the level.
using StepObserver = std::function<void(const CertifiedStep&)>;

/// Newton's method from `start` (empty: from scratch) with the bound of its iterates. With an adaptive
/// stopping criterion it ends at the first iterate whose linearisation error is negligible. The regularised
/// variant (method.regularisation) starts with `delta` (0: chosen after the first step) and reduces it until
/// the regularisation is negligible too.
///
/// The accepted iterate always has the complete bound of its own stress. So do all other iterates with
/// Stopping::tolerance and in the regularised variant, and none with Stopping::last_bounded; finishing_steps
/// then counts the steps that Stopping::adaptive did not need. Otherwise sigma_lin is computed first, which
/// needs only the patches around Gamma_C. Its linearisation error is compared with osc + str + neu + cnt +
/// frc + quad of the last complete bound, before that with the `expected` value of this sum, or, if nothing
/// is known of it, with ||sigma(u^1)||. If it is not negligible, the iterate gets no complete bound, and
/// Newton's method goes on.
///
/// `friedrichs`: of a mesh of which this is a refinement, if it is known; `equilibrium`: of the form, if one
/// already exists.
///
/// Where Newton's method fails, it is restarted (solve_persistently); `steps` has the steps of all attempts.
///
/// Linear systems are solved until alg is solver.gamma_alg of the bound. If alg is still larger, or the
/// accepted iterate violates an identity, Newton's method goes on with new factors and solves as accurately
/// as rounding allows.
///
/// Throws SolveError when a matrix is singular or a patch has no equilibrated stress.
template <int dim>
[[nodiscard]] CertifiedLevel<dim> solve_and_certify(
    const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const StepObserver& observer = {}, double delta = 0, const std::optional<double>& expected = {},
    const std::optional<certify::FriedrichsConstant>& friedrichs = {},
    std::shared_ptr<solve::Equilibrium<dim>> equilibrium = {});

/// The same level with Newton's method continued to newton.tolerance, whatever the stopping criterion, with
/// delta unchanged, and with the bound of its last iterate. Nothing where this fails, for instance because an
/// identity is violated; throws as solve_and_certify() does. Neither stress nor estimate of `level` is used.
template <int dim>
[[nodiscard]] std::optional<CertifiedLevel<dim>> converge(const contact::NitscheForm<dim>& form,
                                                          const CertifiedLevel<dim>& level,
                                                          const Method& method,
                                                          const StepObserver& observer = {});

/// Recomputes stress, estimate and norms of the level's solution where they were released.
template <int dim>
void certify_again(const contact::NitscheForm<dim>& form, const Method& method, CertifiedLevel<dim>& level);

/// A solution without a bound: Newton's method from `start` to newton.tolerance, whatever the stopping
/// criterion, with T itself. The level has no stress, estimate, identities or friedrichs. Otherwise as
/// solve_and_certify().
template <int dim>
[[nodiscard]] CertifiedLevel<dim> solve_without_bound(
    const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const StepObserver& observer = {}, std::shared_ptr<solve::Equilibrium<dim>> equilibrium = {});

/// Whether there is a solution and judge() accepts its bound.
template <int dim>
[[nodiscard]] bool bound_holds(const CertifiedLevel<dim>& level);

}  // namespace tribound::adapt
