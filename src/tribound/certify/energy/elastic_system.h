#pragma once

/// @file elastic_system.h
/// Linear elasticity on a space, solved for many loads.

#include <memory>
#include <span>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/algebra/triplets.h"
#include "tribound/contact/nitsche/part_motions.h"
#include "tribound/contact/nitsche/rigid_parts.h"
#include "tribound/contact/nitsche/springs.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// a(u, w) + (K u, w)_S + s(u, w) = b(w) for all w of the space that vanish at fixed degrees of freedom but
/// may move rigid parts; s are further springs on the boundary. Keeps references and factors. All ranks
/// construct and call it together.
template <int dim>
class ElasticSystem
{
 public:
  /// `springs`: entries of s between free degrees of freedom. `supports`: degrees of freedom of own nodes,
  /// each with a spring as stiff as the body. Together with the fixed ones they must hold every body. The
  /// degrees of freedom of rigid parts are fixed.
  ElasticSystem(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                std::vector<char> fixed, const algebra::SolverOptions& solver, algebra::Triplets springs = {},
                std::span<const Index> supports = {});
  ~ElasticSystem();
  ElasticSystem(const ElasticSystem&) = delete;
  ElasticSystem& operator=(const ElasticSystem&) = delete;

  /// u, with the values of `start` at fixed degrees of freedom but those of rigid parts; `b` at all degrees
  /// of freedom of own nodes, without springs. The residual is `tolerance` of the forces, up to rounding.
  /// Throws SolveError.
  [[nodiscard]] std::vector<double> solve(std::span<const double> b, std::span<const double> start,
                                          double tolerance) const;

 private:
  struct Factors;

  [[nodiscard]] std::vector<double> internal_forces(std::span<const double> u) const;
  /// Sets 0 at fixed degrees of freedom.
  void release(std::span<double> vector) const;
  void move_parts(std::span<const double> b, std::span<double> u) const;

  const problem::Problem<dim>& problem_;
  const fem::LagrangeSpace<dim>& space_;
  contact::Springs<dim> elastic_;  ///< K
  contact::RigidParts<dim> parts_;
  std::vector<char> fixed_;
  std::unique_ptr<Factors> factors_;
  mutable contact::PartMotions motions_;  ///< once they are needed
};

}  // namespace tribound::certify
