#pragma once

/// @file algebraic.h
/// What the linear solver has left of the equilibrium, method section 8: the remainder on each cell, and its
/// share of the bound.

#include <array>
#include <span>
#include <vector>

#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/equilibrate/rigid.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// An affine field on each own cell, given by its values at the vertices of the cell.
template <int dim>
using AffineFields = std::vector<std::array<Point<dim>, dim + 1>>;

/// The residual of the linear systems on a mesh as a body force. All ranks use it together.
template <int dim>
class AlgebraicResidual
{
 public:
  /// The form must outlive the object.
  explicit AlgebraicResidual(const contact::NitscheForm<dim>& form);

  /// <R_lin, phi_i> = L(phi_i) - a(u, phi_i) + (t, [phi_i])_C for every degree of freedom; 0 at fixed ones,
  /// incomplete at ghosts. t is the running traction at the contact points of the form.
  [[nodiscard]] std::vector<double> residual(std::span<const double> u, std::span<const Point<dim>> t) const;

  /// rho = sum_a rho_a on the own cells, rho_a in Z_a (its constants for p = 1 and row by row) with
  ///     (rho_a, z)_{omega_a} = <R_lin, psi_a z> for all z in Z_a:
  /// With the stress of u and t from these patches, div sigma_h + Pi^{p-1} f = rho. `residual`: <R_lin,
  /// phi_i>; psi_a z is in V_h (p = 1: for constant z). Its entries at fixed degrees of freedom and at ghosts
  /// are not used. Of an axisymmetric problem Z_a are the multiples of e_z, if no facet at a fixes u_z, and
  /// the products have the weight r.
  [[nodiscard]] AffineFields<dim> body_force(std::span<const double> residual, PatchStress patches) const;

 private:
  /// sum_i psi_a(x_i) r_i, and its moment with x_i - a.
  struct Forces
  {
    Point<dim> sum = Point<dim>::Zero();
    Tensor<dim> moment = Tensor<dim>::Zero();
  };
  [[nodiscard]] std::vector<Forces> forces_at_vertices(std::span<const double> residual) const;
  [[nodiscard]] RigidField<dim> rigid_force(Index vertex, const Forces& forces, bool constant) const;
  /// The same of an axisymmetric problem.
  [[nodiscard]] RigidField<dim> axial_force(Index vertex, const Forces& forces) const;

  const contact::NitscheForm<dim>& form_;
  std::vector<Index> fixed_begin_;      ///< per vertex, into `fixed_`; one more at the end
  std::vector<FixedFacet<dim>> fixed_;  ///< the Dirichlet facets around the vertices
};

/// ||rho||, over all ranks, with the weight of the problem.
template <int dim>
[[nodiscard]] double field_norm(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                const AffineFields<dim>& rho);

/// eta_alg with (rho, v) <= eta_alg ||v||_{C,h}: the smaller of C_F ||rho|| and
///     C_F ||Pi_0 rho|| + sum_{j=1}^J (sum_{K in T_{j-1}} (h_K/pi)^2 ||(Pi_j - Pi_{j-1}) rho||_K^2)^{1/2}
///     + (sum_T (h_T/pi)^2 ||rho - Pi_J rho||_T^2)^{1/2},
/// Pi_j is the mean on the simplices of T_j. T_J is the mesh; T_{j-1} is T_j with bisections undone. Over all
/// ranks, each of which undoes bisections among its own cells. Of an axisymmetric problem C_F ||rho||.
template <int dim>
[[nodiscard]] double algebraic_error(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                     const AffineFields<dim>& rho, double friedrichs);

}  // namespace tribound::certify
