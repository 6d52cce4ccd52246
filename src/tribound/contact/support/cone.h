#pragma once

/// @file cone.h
/// The distance of a vector to a finitely generated convex cone.

#include <Eigen/Core>

namespace tribound::contact
{

/// b - C x for the x >= 0 that minimises |b - C x|: what is left of b after its projection on the cone of the
/// columns of C. The remainder r has r.C_j <= 0 for every column and r.b = |r|^2, and is 0 (up to 1e-10 |b|)
/// exactly when b lies in the cone. Meant for few rows and any number of columns: active sets after Lawson
/// and Hanson, Solving Least Squares Problems (1974), chapter 23.
[[nodiscard]] Eigen::VectorXd remainder_outside_cone(const Eigen::MatrixXd& columns,
                                                     const Eigen::VectorXd& b);

}  // namespace tribound::contact
