#pragma once

/// @file rigid_modes.h
/// The rigid motions of a body, as vectors of coefficients and in words.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::contact
{

/// The rigid motions z(x) = t + w x (x - centre) / size of a body (2D: w turns in the plane), so that all
/// coefficients (t, w) of size 1 move the body by about the same distance.
template <int dim>
struct RigidModes
{
  static constexpr int n_modes = dim * (dim + 1) / 2;
  using Coefficients = Eigen::Matrix<double, n_modes, 1>;
  using ModeMatrix = Eigen::Matrix<double, dim, n_modes>;

  Point<dim> centre = Point<dim>::Zero();
  double size = 1;

  /// The matrix M(x) with z(x) = M(x) (t, w).
  [[nodiscard]] ModeMatrix at(const Point<dim>& x) const;

  /// "translation along x", or along (0.6, 0.8); "rotation about (0.5, 0)", in 3D "rotation about the axis
  /// through (0, 0, 1) along (1, 0, 0)"; "screw motion about the axis ...".
  [[nodiscard]] std::string describe(const Coefficients& motion) const;
};

/// Motions as columns of a matrix with RigidModes::n_modes rows for each body.
using MotionBasis = Eigen::MatrixXd;

/// An orthonormal basis of the null space of a Gram matrix: eigenvalues up to 1e-14 of `scale` count as 0.
[[nodiscard]] MotionBasis null_space(const Eigen::MatrixXd& gram, double scale);

/// A basis of the same space for users to read. First come motions of the first body: translations, then
/// rotations, each along the coordinate axes where possible. Then come those that move the second body and
/// not the first, and so on, if such motions span the rest.
template <int dim>
[[nodiscard]] std::vector<Eigen::VectorXd> readable_basis(const MotionBasis& motions);

}  // namespace tribound::contact
