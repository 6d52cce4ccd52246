#pragma once

/// @file support.h
/// What stops the rigid motions of an assembly: displacement conditions, ties, contact that pushes, friction.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "tribound/contact/nitsche/rigid_modes.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/contact/support/assembly.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A displacement component of a boundary that a motion changes, and that may be fixed to stop it.
struct Remedy
{
  std::string boundary;
  int component = 0;

  friend bool operator==(const Remedy&, const Remedy&) = default;
};

/// `x on boundary "left"`.
[[nodiscard]] std::string describe(const Remedy& remedy);

/// An assembly with the conditions on its boundaries. Keeps references.
template <int dim>
class Support
{
 public:
  /// The numbers in the assembly refer to `segments`.
  Support(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
          std::span<const ContactSegment<dim>> segments, const Assembly<dim>& assembly)
      : problem_(problem), mesh_(mesh), segments_(segments), assembly_(assembly)
  {
  }

  /// Sum of r r^T over the rows r of what stops a motion z in both directions: its fixed components and [z]
  /// on ties; the mean for each boundary and pair.
  [[nodiscard]] Eigen::MatrixXd fixed_gram() const;
  /// The same for closed contact: [z]^n, and all of [z] if there is friction and it counts.
  [[nodiscard]] Eigen::MatrixXd contact_gram(bool with_friction) const;

  /// The motions that displacement conditions and ties leave.
  [[nodiscard]] MotionBasis left_by_fixing() const;
  /// The motions that would be left even if contact could pull as well. Without friction: only friction stops
  /// them; with friction: nothing does.
  [[nodiscard]] MotionBasis left_by_contact(bool with_friction) const;

  /// The boundary component to fix against the motion z: the one with the largest mean of (z_c n_c)^2, the
  /// motion into a wall or a plane of symmetry; if there is a choice, one that carries no load. Nothing if
  /// every boundary that z changes is in contact or in no group.
  [[nodiscard]] std::optional<Remedy> remedy(const Eigen::VectorXd& motion) const;

 private:
  const problem::Problem<dim>& problem_;
  const mesh::Mesh<dim>& mesh_;
  std::span<const ContactSegment<dim>> segments_;
  const Assembly<dim>& assembly_;
};

}  // namespace tribound::contact
