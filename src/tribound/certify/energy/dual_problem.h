#pragma once

/// @file dual_problem.h
/// Problems of linear elasticity whose solutions give the effect of the error on a number.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/certify/energy/contact_resultant.h"
#include "tribound/certify/energy/dual_products.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/springs.h"

namespace tribound::certify
{

/// The bodies of a problem with u_D = 0 and other loads, also on contact boundaries; the contact tractions
/// are given. Its form has the space and the segments of the given one, keeps references to them, and is only
/// for given tractions. All ranks construct and call it together.
template <int dim>
class DualProblem
{
 public:
  DualProblem(const contact::NitscheForm<dim>& form, problem::Problem<dim> problem);
  DualProblem(const DualProblem&) = delete;
  DualProblem& operator=(const DualProblem&) = delete;

  [[nodiscard]] const contact::NitscheForm<dim>& form() const { return form_; }
  /// (load, phi_i) + (t, [phi_i])_C with t at the contact points.
  [[nodiscard]] std::vector<double> load(std::span<const Point<dim>> t) const;
  /// The stress of z, which is in equilibrium with these loads; `reason` says what is wrong with it, if
  /// anything.
  [[nodiscard]] Stress<dim> balanced(std::span<const double> z, std::span<const Point<dim>> t,
                                     std::string& reason) const;
  /// ||O|| of what this stress lacks of loads and springs that are no polynomials of low degree.
  [[nodiscard]] double oscillation(std::span<const double> z) const;

 private:
  problem::Problem<dim> problem_;
  contact::NitscheForm<dim> form_;
  std::unique_ptr<Equilibrator<dim>> equilibrator_;
};

/// Without loads, with those of the problem, with the traction q on one boundary, also a rigid part, or with
/// -(K e, w) on the spring of one; always without contact, and otherwise springs that rest at 0.
template <int dim>
[[nodiscard]] problem::Problem<dim> without_loads(const problem::Problem<dim>& problem,
                                                  const mesh::Mesh<dim>& mesh);
template <int dim>
[[nodiscard]] problem::Problem<dim> with_loads(const problem::Problem<dim>& problem,
                                               const mesh::Mesh<dim>& mesh);
template <int dim>
[[nodiscard]] problem::Problem<dim> with_load_on(const problem::Problem<dim>& problem,
                                                 const mesh::Mesh<dim>& mesh, int tag, const Point<dim>& q);
template <int dim>
[[nodiscard]] problem::Problem<dim> with_spring_moved(const problem::Problem<dim>& problem,
                                                      const mesh::Mesh<dim>& mesh, int tag,
                                                      const Point<dim>& e);

}  // namespace tribound::certify
