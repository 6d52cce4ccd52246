#pragma once

/// @file contact_cone.h
/// The work that contact can do in rigid motions.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/support/assembly.h"

namespace tribound::contact
{

/// Which friction counts among the forces that grow with the pressure without limit.
enum class ConeFriction
{
  unlimited,    ///< all friction holds wherever there is pressure
  strong,       ///< friction with strength holds, the rest obeys its coefficient
  no_strength,  ///< only friction that obeys a coefficient
};

/// The cone K of the work (t, [z_i])_C that contact tractions t can do in motions z_i: pushes along N at the
/// corners of the segments; with friction also forces n + mu_F t, |t| = 1, and any t where friction holds. In
/// 3D the round friction cones are first approximated by polyhedra inside them, which get more generators
/// where they matter.
template <int dim>
class ContactCone
{
 public:
  ContactCone(const NitscheForm<dim>& form, const Assembly<dim>& assembly, const MotionBasis& motions,
              ConeFriction friction);

  /// Generators of a cone inside K, one per column; in 2D of K itself.
  [[nodiscard]] const Eigen::MatrixXd& generators() const { return generators_; }
  /// The force of K outside the cone of the generators that does the most work in r, if there is one; without
  /// one, the generators tell whether K can do any.
  [[nodiscard]] std::optional<Eigen::VectorXd> steepest(const Eigen::VectorXd& r) const;
  /// The projection of b on the polar of K (project_on_polar_cone()); 0 if it is not found.
  [[nodiscard]] Eigen::VectorXd project_on_polar(const Eigen::VectorXd& b);

 private:
  /// A corner where friction obeys a coefficient, in 3D: [z] = jumps times the coefficients of z.
  struct RoundCorner
  {
    Eigen::Matrix<double, dim, Eigen::Dynamic> jumps;
    Point<dim> normal;
    double coefficient;
  };

  Eigen::MatrixXd generators_;
  std::vector<RoundCorner> round_;
};

}  // namespace tribound::contact
