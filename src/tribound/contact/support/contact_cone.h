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

/// Which friction counts among the forces that grow with the pressure without a limit.
enum class ConeFriction
{
  unlimited,    ///< all friction holds whatever is pressed
  strong,       ///< where there is strength it holds, the rest obeys its coefficient
  no_strength,  ///< what obeys a coefficient, nothing else
};

/// The cone K of the work (t, [z_i])_C that contact tractions t can do in motions z_i: pushes along N at the
/// corners of the segments, and with friction forces n + mu_F t, |t| = 1, any t where friction holds. In 3D
/// the round cones of friction begin as polyhedra inside and get generators where they matter.
template <int dim>
class ContactCone
{
 public:
  ContactCone(const NitscheForm<dim>& form, const Assembly<dim>& assembly, const MotionBasis& motions,
              ConeFriction friction);

  /// Generators of a cone inside K, one per column; in 2D of K.
  [[nodiscard]] const Eigen::MatrixXd& generators() const { return generators_; }
  /// The force of K outside the cone of the generators, if there is one, that does most work in r; the
  /// generators without one tell whether K can do any.
  [[nodiscard]] std::optional<Eigen::VectorXd> steepest(const Eigen::VectorXd& r) const;
  /// The projection of b on the polar of K (project_on_polar_cone()); 0 where it is not found.
  [[nodiscard]] Eigen::VectorXd project_on_polar(const Eigen::VectorXd& b);

 private:
  /// Where friction obeys a coefficient, in 3D: [z] = jumps times the coefficients of z.
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
