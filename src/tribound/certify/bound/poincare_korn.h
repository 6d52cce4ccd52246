#pragma once

/// @file poincare_korn.h
/// Poincare's and Korn's inequalities on any simplex, method section 13.4.

#include <array>

#include "tribound/base/types.h"

namespace tribound::certify
{

/// ||w - r||_T <= cell ||eps(w)||_T and ||w - r||_F <= facets[i] ||eps(w)||_T for all w in H^1(T)^d, r the
/// nearest rigid motion each time and F the facet opposite to vertex i. Length and length^{1/2}.
template <int dim>
struct PoincareKorn
{
  double cell;
  std::array<double, dim + 1> facets;
  std::array<double, dim + 1> traces;  ///< instead of facets, if r is the rigid motion nearest on T
};

/// The smallest that follow from those of Hill's simplices (constants.h) mapped onto T in any order of its
/// vertices, and in 2D from Poincare's inequality and Korn's on triangles [HP83, CD15].
template <int dim>
[[nodiscard]] PoincareKorn<dim> poincare_korn(const std::array<Point<dim>, dim + 1>& vertices);

}  // namespace tribound::certify
