#pragma once

/// @file contact_systems.h
/// Linear elasticity with different conditions on the contact boundary.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tribound/algebra/condensation.h"
#include "tribound/certify/energy/elastic_system.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// What is required of the solution on Gamma_C, on both sides of pairs.
enum class OnContact
{
  free,
  held,    ///< its values are given, like those on Gamma_D
  springs  ///< free, with springs
};

/// a(u, w) + s(u, w) = b(w) as in ElasticSystem, in the space of a form, for each OnContact; displacement
/// conditions must hold every body where Gamma_C does not. In 2D one factorisation serves all: Gamma_C is
/// condensed out. Otherwise there is a system for each, made when it is first needed.
template <int dim>
class ContactSystems
{
 public:
  /// The form must outlive the object. `many`: more than one of them will be needed.
  ContactSystems(const contact::NitscheForm<dim>& form, const algebra::SolverOptions& solver, bool many);

  /// s, entries between free degrees of freedom of Gamma_C; for OnContact::springs alone.
  void set_springs(algebra::Triplets springs);
  /// As ElasticSystem::solve(), for each b and its start.
  [[nodiscard]] std::vector<std::vector<double>> solve(OnContact how, std::span<const std::vector<double>> b,
                                                       std::span<const std::vector<double>> starts,
                                                       double tolerance);
  /// Whether several at once take less time than one after another. Several processes solve one by one.
  [[nodiscard]] bool shares_passes() const
  {
    return condensed_ != nullptr && form_.space().mesh().ranks().size() == 1;
  }

 private:
  void condense();
  [[nodiscard]] std::vector<char> fixed(OnContact how) const;
  [[nodiscard]] const ElasticSystem<dim>& system(OnContact how);
  /// By the condensed factors, without refinement.
  [[nodiscard]] std::vector<std::vector<double>> corrections(OnContact how,
                                                             std::span<const std::vector<double>> r);
  /// Up to rounding; nothing if a residual does not fall that far.
  [[nodiscard]] std::optional<std::vector<std::vector<double>>> solve_condensed(
      OnContact how, std::span<const std::vector<double>> b, std::vector<std::vector<double>> u,
      double tolerance);

  const contact::NitscheForm<dim>& form_;
  algebra::SolverOptions solver_;
  bool may_condense_;
  algebra::Triplets springs_;
  std::unique_ptr<algebra::Condensation> condensed_;
  std::vector<double> diagonal_;  ///< of the stiffness, if condensed
  std::array<std::unique_ptr<ElasticSystem<dim>>, 3> systems_;
};

}  // namespace tribound::certify
