#pragma once

/// @file equilibrate.h
/// The equilibrated stress of a Newton iterate, method section 4.

#include <memory>
#include <span>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Rebuilds the stress of the iterates on one mesh. What they share is made once: the order in which the
/// patches are solved, the moments of f, the operators of repeated shapes.
///
/// Arguments of its members are the iterate u^k and its running traction t^k (at the contact points of the
/// form). All run on `n_threads` threads (0: as many as OpenMP offers); the result does not depend on their
/// number. All throw SolveError where a patch has no equilibrated stress. On several ranks, which call them
/// together, each gets the stress of its own cells and tells the others nothing: it solves the patches of all
/// their vertices.
template <int dim>
class Equilibrator
{
 public:
  /// `kind`: of the patches. The form must outlive the object.
  Equilibrator(const contact::NitscheForm<dim>& form, PatchStress kind, int n_threads = 0);
  ~Equilibrator();
  Equilibrator(const Equilibrator&) = delete;
  Equilibrator& operator=(const Equilibrator&) = delete;

  /// sigma_dis and sigma_lin on vertex patches of the degree of the space (method section 4). For delta > 0
  /// Newton's method linearises T_delta: then sigma_lin has the traction psi_a (t^k - T_delta(u^k)) on
  /// Gamma_C, and a third part sigma_reg, method section 7, has psi_a (T_delta(u^k) - T(u^k)).
  [[nodiscard]] Stress<dim> operator()(std::span<const double> u, std::span<const Point<dim>> t,
                                       double delta = 0);
  /// The same sigma_lin for delta = 0 without sigma_dis (`dis` is empty): only patches around vertices on
  /// Gamma_C.
  [[nodiscard]] Stress<dim> linearisation(std::span<const double> u, std::span<const Point<dim>> t);
  /// sigma_dis with the traction t in place of T(u), of a u that is in equilibrium with t. `turning` is
  /// K_{T,a}, d + 1 skew tensors per cell by its vertices in ascending order, adding up to 0 on every cell,
  /// or empty (row by row it must be): b + K_{T,a} (x - x_T) in place of b (certify/energy/edge_moments.h).
  [[nodiscard]] Stress<dim> balanced(std::span<const double> u, std::span<const Point<dim>> t,
                                     std::span<const Tensor<dim>> turning);

  /// What the object is for one degree.
  class Implementation;

 private:
  const contact::NitscheForm<dim>& form_;
  std::unique_ptr<Implementation> implementation_;
};

/// The stress of one iterate.
template <int dim>
[[nodiscard]] Stress<dim> equilibrate(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                      std::span<const Point<dim>> t, int n_threads = 0, double delta = 0,
                                      PatchStress kind = PatchStress::rows)
{
  return Equilibrator<dim>(form, kind, n_threads)(u, t, delta);
}

}  // namespace tribound::certify
