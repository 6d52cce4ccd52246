#pragma once

/// @file body_check.h
/// Whether one body is held, and contact can balance its loads.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/support/body.h"
#include "tribound/contact/support/body_support.h"
#include "tribound/fem/quadrature.h"

namespace tribound::contact
{

/// One body with what holds and drives it.
template <int dim>
class BodyCheck
{
 public:
  using Coefficients = typename RigidModes<dim>::Coefficients;

  BodyCheck(const NitscheForm<dim>& form, const Body<dim>& body, std::string name)
      : form_(form),
        problem_(form.problem()),
        mesh_(form.space().mesh()),
        body_(body),
        support_(problem_, mesh_, body),
        name_(std::move(name))
  {
  }

  /// Throws InputError for a motion that nothing stops.
  void check_held() const;
  /// Throws InputError for loads that contact cannot balance; work(z) = L(z) up to `round_off`.
  void check_balanced(const Coefficients& work, double round_off) const;

 private:
  /// Which friction counts among the forces that grow with the pressure without a limit.
  enum class ConeFriction
  {
    unlimited,    ///< all friction holds whatever is pressed
    strong,       ///< where there is strength it holds, the rest obeys its coefficient
    no_strength,  ///< what obeys a coefficient, nothing else
  };

  /// What the strength of friction can do against a motion z at most.
  struct FrictionWork
  {
    Eigen::VectorXd in_motions;  ///< integral of s z^t/|z^t| . y^t for each motion y of a basis
    double most = 0;             ///< integral of s |z^t|
    double missed = 0;           ///< what the rule may miss of it because of s
  };

  /// The work in each motion of the contact forces, one column for each generator of their cone.
  [[nodiscard]] Eigen::MatrixXd contact_cone(const MotionBasis& motions, ConeFriction friction) const;
  [[nodiscard]] FrictionWork strength_work(const MotionBasis& motions, const Eigen::VectorXd& z,
                                           const fem::Quadrature<dim - 1>& rule) const;
  /// What the work of the loads in a motion may miss.
  [[nodiscard]] double missed_work(const Coefficients& motion) const;
  /// A motion in which the loads do more work than Tresca friction can take up, and contact and Coulomb
  /// friction none; nothing where there is none, or it is too close to tell. See check_rigid_motions().
  [[nodiscard]] std::optional<Eigen::VectorXd> beyond_tresca(const MotionBasis& motions,
                                                             const Eigen::VectorXd& loads,
                                                             double tolerance) const;
  /// What to do against motions that nothing stops, with a component for each of them.
  [[nodiscard]] std::string hint(std::span<const Coefficients> free) const;
  [[noreturn]] void fail(const Coefficients& motion, const std::string& reason) const;

  const NitscheForm<dim>& form_;
  const problem::Problem<dim>& problem_;
  const mesh::Mesh<dim>& mesh_;
  const Body<dim>& body_;
  BodySupport<dim> support_;
  std::string name_;
};

}  // namespace tribound::contact
