#pragma once

/// @file equilibrium.h
/// The discrete problem as Newton's method sees it: internal forces K x, loads and contact tractions.

#include <memory>
#include <span>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/solve/linearised.h"

namespace tribound::solve
{

/// The forces due to loads and prescribed displacements.
struct ExternalForces
{
  /// L(phi_i) - a(lifting of u_D, phi_i) for free i, else 0; on rigid parts as NitscheForm::keep_free().
  std::vector<double> load;
  double scale = 0;  ///< size of the forces in balance: residuals are measured against it
};
template <int dim>
[[nodiscard]] ExternalForces external_forces(const contact::NitscheForm<dim>& form);

/// Find unknowns x with K x = load + contact forces of the tractions at the displacement of x. The unknowns
/// depend on the implementation: all of u, or those on the contact boundary. Keeps factors of its matrices
/// for the next solve, and a reference to the form, which is no longer used once it follows another.
template <int dim>
class Equilibrium
{
 public:
  virtual ~Equilibrium() = default;

  /// From now on uses this form. It has the same space, stiffness, fixed degrees of freedom and contact
  /// pattern; loads, prescribed values and the state that contact remembers may differ. Factors are kept. All
  /// ranks call it together.
  virtual void follow(const contact::NitscheForm<dim>& form) = 0;

  /// The unknowns of a displacement that has the prescribed values at the fixed degrees of freedom.
  [[nodiscard]] virtual std::vector<double> unknowns(std::span<const double> u) const = 0;
  /// Sets u on the cells at the contact boundary, where tractions need it; other entries may stay as they
  /// are.
  virtual void displace_contact(std::span<const double> x, std::span<double> u) const = 0;
  /// u everywhere.
  [[nodiscard]] virtual std::vector<double> displacement(std::span<const double> x) const = 0;

  /// K x; its entries at fixed degrees of freedom are not used.
  [[nodiscard]] virtual std::vector<double> internal_forces(std::span<const double> x) const = 0;
  /// load - K x + (t, [phi_i])_C for t at the contact points of the form, 0 at fixed degrees of freedom.
  [[nodiscard]] virtual std::vector<double> residual(std::span<const double> internal_forces,
                                                     std::span<const Point<dim>> traction) const = 0;
  /// Euclidean length of a vector of unknowns, such as a residual. All ranks call it together, as solve().
  [[nodiscard]] virtual double norm(std::span<const double> x) const = 0;
  /// The round-off in K x, which a residual cannot resolve, estimated by the diagonal of the stiffness.
  [[nodiscard]] virtual double round_off(std::span<const double> x) const = 0;

  /// Solves K d - (DT_lin[d], [phi_i])_C = r with T of `form`, which may differ from the one it follows in
  /// gamma_0 and data of contact, to |residual| <= tolerance up to round-off; an iteration may end when its
  /// residual is `small_enough`. Throws SolveError when the matrix is singular.
  virtual algebra::LinearSolve solve(const contact::NitscheForm<dim>& form, const Linearised<dim>& contact,
                                     std::span<const double> r, double tolerance, std::span<double> d,
                                     const algebra::ResidualTest& small_enough) = 0;
  [[nodiscard]] virtual algebra::LinearMethod method() const = 0;
  /// ExternalForces::scale.
  [[nodiscard]] virtual double force_scale() const = 0;
};

/// The diagonal of a matrix with the rows of own unknowns; 0 at ghosts.
template <int dim>
[[nodiscard]] std::vector<double> diagonal(const algebra::SparseRows& matrix,
                                           const fem::LagrangeSpace<dim>& space);
/// 10 eps D u: round-off in K u, with the diagonal D of K; entries of the same unknowns.
[[nodiscard]] std::vector<double> round_off(std::span<const double> diagonal, std::span<const double> u);

/// All of u, with sparse matrices. Rigid parts are at rest.
template <int dim>
[[nodiscard]] std::unique_ptr<Equilibrium<dim>> sparse_equilibrium(const contact::NitscheForm<dim>& form,
                                                                   ExternalForces forces,
                                                                   const algebra::SolverOptions& options);

/// The same; with rigid parts their motions are unknowns, too: residuals on the parts are nodal forces that
/// do the work which is missing in each motion. One system with the parts held is solved for each motion
/// besides.
template <int dim>
[[nodiscard]] std::unique_ptr<Equilibrium<dim>> whole_equilibrium(const contact::NitscheForm<dim>& form,
                                                                  const algebra::SolverOptions& options);

/// The degrees of freedom of own nodes that condensation keeps: the free ones of nodes on the contact
/// boundary (trace) and of the other nodes of cells there (layer).
struct CondensedDofs
{
  std::vector<Index> layer;
  std::vector<Index> trace;
};
template <int dim>
[[nodiscard]] CondensedDofs condensed_dofs(const contact::NitscheForm<dim>& form);

/// The displacement on the contact boundary, with everything else condensed out. Throws SolveError when the
/// stiffness is not positive definite with the contact boundary held.
template <int dim>
[[nodiscard]] std::unique_ptr<Equilibrium<dim>> condensed_equilibrium(const contact::NitscheForm<dim>& form,
                                                                      const ExternalForces& forces,
                                                                      CondensedDofs dofs);

/// One of the two, by options.method. If that is automatic, condensation is used in 2D as long as it keeps at
/// most 12 n^{1/2} of n unknowns, or 6 n^{1/2} if few steps are to come (not `from_scratch`). Otherwise as
/// algebra::choose_method. Never with rigid parts.
template <int dim>
[[nodiscard]] algebra::LinearMethod choose_method(const contact::NitscheForm<dim>& form,
                                                  const algebra::SolverOptions& options, bool from_scratch);

/// By the chosen method, or by sparse matrices where the stiffness cannot be condensed.
template <int dim>
[[nodiscard]] std::unique_ptr<Equilibrium<dim>> make_equilibrium(const contact::NitscheForm<dim>& form,
                                                                 const algebra::SolverOptions& options,
                                                                 bool from_scratch);

}  // namespace tribound::solve
