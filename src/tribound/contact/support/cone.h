#pragma once

/// @file cone.h
/// Projection on the polar of a finitely generated convex cone.

#include <Eigen/Core>

namespace tribound::contact
{

/// The projection of b on the polar of the cone of the columns of C: r = b - C x for the x >= 0 that
/// minimises |b - C x|. It has r.C_j <= 0 for every column and r.b = |r|^2, and is 0 (up to 1e-10 |b|)
/// exactly when b lies in the cone of the columns. Meant for few rows and any number of columns: active sets
/// after Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23.
[[nodiscard]] Eigen::VectorXd project_on_polar_cone(const Eigen::MatrixXd& columns, const Eigen::VectorXd& b);

}  // namespace tribound::contact
