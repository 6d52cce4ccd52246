#pragma once

/// @file patch_almost_rigid.templates.h
/// Patches with a rotation z that Gamma_D hardly stops, method section 4.5. Their matrix A has an eigenvalue
/// of the size of s^2, s = |z_fixed| / |z|, where an admissible rotation would have 0. The trace of z on all
/// facets, with its fixed components, changes nothing. So the multipliers m, which are 0 in the fixed
/// components, may be replaced by m + alpha z / |z_fixed|, and alpha chosen so that the free components have
/// no part along z on one facet: what the term that makes A definite does not feel, whatever s is.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tribound/certify/equilibrate/patch.h"

namespace tribound::certify
{

/// Coefficients of motion i in P^p(F)^d: of its fixed or its free components.
template <int dim, int p>
auto Patch<dim, p>::trace(int facet, int motion, bool fixed) const -> FacetVector
{
  FacetVector result = moments_on_facet(facet, motion);
  const Index number = facets_[facet].number;
  for (int c = 0; c < dim; ++c)
    if ((data_.is_boundary(number) && data_.fixes(number, c)) != fixed)
      std::fill_n(result.data() + c * S::facet, S::facet, 0.0);
  return result;
}

/// The last facet where at least half of an almost admissible motion is free; there is one, for less than an
/// eighth of the squares of its values at all fixed facets is fixed.
template <int dim, int p>
int Patch<dim, p>::holding_facet(int motion) const
{
  int facet = static_cast<int>(facets_.size()) - 1;
  for (; facet > 0; --facet)
  {
    const FacetVector fixed = trace(facet, motion, true);
    const FacetVector free = trace(facet, motion, false);
    if (dot(fixed, fixed) <= dot(free, free)) break;
  }
  return facet;
}

/// For each almost admissible rotation its unit trace v in the fixed components, and the load -A v.
template <int dim, int p>
void Patch<dim, p>::load_almost_rigid()
{
  for (int i = 0; i < motions_.n_almost(); ++i)
  {
    std::vector<FacetVector>& v = fixed_trace_[i];
    v.resize(facets_.size());
    double square = 0;
    for (std::size_t f = 0; f < facets_.size(); ++f)
    {
      v[f] = trace(static_cast<int>(f), motions_.size() + i, true);
      square += dot(v[f], v[f]);
    }
    for (FacetVector& part : v)
      for (int k = 0; k < S::block; ++k) part[k] /= std::sqrt(square);
    almost_rigid_[i].assign(facets_.size(), {});
    matrix_.subtract_product(v, almost_rigid_[i]);
  }
}

/// Adds the multiples of v, and what they cause in the free components, that leave no part along the
/// rotations on their facets.
template <int dim, int p>
void Patch<dim, p>::balance_almost_rigid()
{
  using Matrix = Eigen::Matrix<double, S::pairs, S::pairs>;
  using Vector = Eigen::Matrix<double, S::pairs, 1>;
  const int n = motions_.n_almost();
  Matrix parts = Matrix::Identity();
  std::array<Vector, max_problems> rhs;
  rhs.fill(Vector::Zero());
  for (int i = 0; i < n; ++i) matrix_.solve(std::span(almost_rigid_[i]));
  for (int k = 0; k < n; ++k)
  {
    const int facet = holding_facet(motions_.size() + k);
    const FacetVector free = trace(facet, motions_.size() + k, false);
    for (int i = 0; i < n; ++i) parts(k, i) = dot(free, almost_rigid_[i][facet]);
    for (int problem = 0; problem < n_problems_; ++problem) rhs[problem][k] = -dot(free, x_[problem][facet]);
  }
  const Eigen::PartialPivLU<Matrix> factor(parts);
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    const Vector alpha = factor.solve(rhs[problem]);
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (int i = 0; i < n; ++i)
      {
        add_multiple(x_[problem][f], alpha[i], almost_rigid_[i][f]);
        add_multiple(x_[problem][f], alpha[i], fixed_trace_[i][f]);
      }
  }
}

}  // namespace tribound::certify
