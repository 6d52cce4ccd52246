#pragma once

/// @file assembly_check.h
/// Whether the bodies of an assembly are held, and whether contact can balance their loads.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/support/assembly.h"
#include "tribound/contact/support/support.h"
#include "tribound/fem/quadrature.h"

namespace tribound::contact
{

/// An assembly with its supports and loads.
template <int dim>
class AssemblyCheck
{
 public:
  /// `name` is for messages. Keeps references.
  AssemblyCheck(const NitscheForm<dim>& form, const Assembly<dim>& assembly, std::string name)
      : form_(form),
        problem_(form.problem()),
        mesh_(form.space().mesh()),
        assembly_(assembly),
        support_(problem_, mesh_, form.segments(), assembly),
        name_(std::move(name))
  {
  }

  /// Throws InputError for a motion that nothing stops.
  void check_held() const;
  /// Throws InputError for loads that contact cannot balance; work(z) = L(z) up to `round_off`.
  void check_balanced(const Eigen::VectorXd& work, double round_off) const;

 private:
  /// The most that the strength of friction can do against a motion z.
  struct FrictionWork
  {
    Eigen::VectorXd in_motions;  ///< integral of s [z]^t/|[z]^t| . [y]^t for each motion y of a basis
    double most = 0;             ///< integral of s |[z]^t|
    double missed = 0;           ///< what the rule may miss of `most` because of s
  };

  [[nodiscard]] FrictionWork strength_work(const MotionBasis& motions, const Eigen::VectorXd& z,
                                           const fem::Quadrature<dim - 1>& rule) const;
  /// The possible error of the work of the loads in a motion.
  [[nodiscard]] double missed_work(const Eigen::VectorXd& motion) const;
  /// A motion in which the loads do more work than Tresca friction can take up, while contact and Coulomb
  /// friction do none; nothing if there is none, or if it is too close to tell. See check_rigid_motions().
  [[nodiscard]] std::optional<Eigen::VectorXd> beyond_tresca(const MotionBasis& motions,
                                                             const Eigen::VectorXd& loads,
                                                             double tolerance) const;
  /// Advice against motions that nothing stops, with a component to fix for each of them.
  [[nodiscard]] std::string hint(std::span<const Eigen::VectorXd> free) const;
  [[noreturn]] void fail(const Eigen::VectorXd& motion, const std::string& reason) const;

  const NitscheForm<dim>& form_;
  const problem::Problem<dim>& problem_;
  const mesh::Mesh<dim>& mesh_;
  const Assembly<dim>& assembly_;
  Support<dim> support_;
  std::string name_;
};

}  // namespace tribound::contact
