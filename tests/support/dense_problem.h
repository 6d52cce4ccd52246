#pragma once

/// @file dense_problem.h
/// The minimum norm problem on one patch for the dense kernel (dense_patch.h): what the patch consists of,
/// what makes its data compatible, and these data.

#include <array>
#include <vector>

#include "support/dense_data.h"

namespace tribound::test
{

/// A rigid motion translation + spin (x - a).
template <int dim>
struct Motion
{
  Point<dim> translation;
  Tensor<dim> spin;
  Point<dim> centre;

  [[nodiscard]] Point<dim> operator()(const Point<dim>& x) const { return translation + spin * (x - centre); }
};

/// The patch of a vertex.
template <int dim>
struct DensePatch
{
  Index vertex;
  std::vector<Index> cells;
  std::vector<int> facets;       ///< those that contain the vertex
  std::vector<int> outer;        ///< the others
  std::array<Motion<dim>, 2> y;  ///< y_a of dis and lin
  std::array<Tensor<dim>, 2> w;  ///< w_a
};

template <int dim>
[[nodiscard]] DensePatch<dim> make_patch(const DenseData<dim>& given, Index vertex);

/// -psi_a f + sigma(u) grad psi_a - y_a for dis, y_a for lin.
template <int dim>
[[nodiscard]] Point<dim> patch_b(const DenseData<dim>& given, const DensePatch<dim>& patch, Index c, int q,
                                 int column);

/// psi_a g_N or psi_a T(u) for dis, psi_a (t^k - T(u)) for lin.
template <int dim>
[[nodiscard]] Point<dim> patch_traction(const DenseData<dim>& given, const DensePatch<dim>& patch,
                                        const DenseFacet<dim>& facet, const DataPoint<dim>& point,
                                        int column);

}  // namespace tribound::test
