#pragma once

/// @file types.h
/// Index and small-vector types shared by every folder.

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace tribound
{

/// Local numbers of vertices, cells, facets and degrees of freedom.
using Index = std::int32_t;

/// A point or a vector of R^dim.
template <int dim>
using Point = Eigen::Matrix<double, dim, 1>;

/// A second-order tensor on R^dim; for a gradient, entry (i, j) is d u_i / d x_j.
template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

}  // namespace tribound
