#pragma once

/// @file cell_operator.h
/// The Arnold-Falk-Winther minimisation on one cell with its facet multipliers left over, method section 4.
///
/// On a cell with outward normal traces N, weak divergence B_U and weak skew part B_L, minimising |sigma -
/// G|^2 / 2 under B sigma = beta with multipliers mu for the normal traces gives
///
///     sigma = G - B^T eta - N^T mu,      B B^T eta = r - C mu,      r = B G - beta,  C = B N^T,
///     N sigma = g - S mu,                S = N N^T - C^T (B B^T)^{-1} C,   g = N G - C^T (B B^T)^{-1} r.
///
/// B_L B_L^T = 2 I, so the rotations go first; then B_U B_U^T becomes A = B_U B_U^T - B_U B_L^T B_L B_U^T / 2
/// and C becomes C_U - B_U B_L^T C_L / 2, both of size dim * dim P^{p-1}.

#include <Eigen/Cholesky>
#include <array>
#include <span>

#include "case/problem.h"
#include "certify/frame.h"
#include "certify/reference.h"

namespace tribound
{

/// The rotation pairs (r, c), r < c, in the order of Lambda.
template <int dim>
inline constexpr auto skew_pairs = []
{
  std::array<std::array<int, 2>, dim*(dim - 1) / 2> pairs{};
  int n = 0;
  for (int r = 0; r < dim; ++r)
    for (int c = r + 1; c < dim; ++c) pairs[n++] = {r, c};
  return pairs;
}();

/// A stress on a cell: column dim * r + c holds the coefficients of entry (r, c).
template <int dim, int p>
using StressCoefficients = Eigen::Matrix<double, Sizes<dim, p>::stress, dim * dim>;

/// sigma(u) on a cell: the same with polynomials of degree p-1.
template <int dim, int p>
using DiscreteStress = Eigen::Matrix<double, Sizes<dim, p>::multiplier, dim * dim>;

/// What an elimination leaves that does not depend on the data.
template <int dim, int p>
class CellOperator
{
 public:
  using S = Sizes<dim, p>;
  using BlockMatrix = Block<S::block, S::block>;
  using UMatrix = Block<S::u, S::u>;
  using UVector = Eigen::Matrix<double, S::u, 1>;
  using RotationVector = Eigen::Matrix<double, S::rotation, 1>;
  using FacetVector = Eigen::Matrix<double, S::block, 1>;
  using FacetVectors = std::array<FacetVector, dim + 1>;

  /// Factors A and forms the couplings C of all facets.
  void build(const Frame<dim>& frame);
  /// Forms S; build() has been called.
  void condense(const Frame<dim>& frame);

  /// Block S(f, g) of facets f <= g; S(g, f) is its transpose.
  [[nodiscard]] const BlockMatrix& schur(int f, int g) const { return schur_[f][g]; }

  /// C^T (B B^T)^{-1} r for the facet f, r = (r_u, r_rotation); the argument is reduce(r_u, r_rotation).
  [[nodiscard]] FacetVector facet_part(int f, const UVector& reduced) const
  {
    return half_coupling_[f].transpose() * reduced;
  }
  /// L^{-1} (r_u - B_U B_L^T r_rotation / 2) with A = L L^T.
  [[nodiscard]] UVector reduce(const UVector& r_u, const RotationVector& r_rotation) const;
  /// The share of r_rotation itself: C_L^T r_rotation / 2 on facet f.
  [[nodiscard]] FacetVector rotation_part(int f, const RotationVector& r_rotation) const
  {
    return 0.5 * rotation_coupling_[f].transpose() * r_rotation;
  }

  /// The moments of the divergence of a discrete stress on U.
  [[nodiscard]] UVector divergence(const DiscreteStress<dim, p>& sigma) const;

  /// sigma - G = -B^T eta - N^T mu for the data r and the multipliers mu.
  [[nodiscard]] StressCoefficients<dim, p> correction(const Frame<dim>& frame, const UVector& r_u,
                                                      const RotationVector& r_rotation,
                                                      const FacetVectors& mu) const;

 private:
  using Truncated = Block<S::multiplier, S::multiplier>;

  void factor(const Frame<dim>& frame);
  void couple(const Frame<dim>& frame);
  /// B_U B_L^T x.
  [[nodiscard]] UVector u_from_rotation(const RotationVector& x) const;
  /// B_L B_U^T x.
  [[nodiscard]] RotationVector rotation_from_u(const UVector& x) const;

  Eigen::LLT<UMatrix> factor_;                                           ///< of A
  std::array<Truncated, dim> derivative_;                                ///< (d_c chi_j, chi_i) on the cell
  std::array<Block<S::u, S::block>, dim + 1> half_coupling_;             ///< L^{-1} C
  std::array<Block<S::rotation, S::block>, dim + 1> rotation_coupling_;  ///< C_L
  std::array<std::array<BlockMatrix, dim + 1>, dim + 1> schur_;
};

/// sigma(u) in a cell in the orthonormal basis of P^{p-1}; nodes in the order of the space's basis.
template <int dim, int p>
[[nodiscard]] DiscreteStress<dim, p> discrete_stress(const Frame<dim>& frame, const Material& material,
                                                     std::span<const Index> nodes, std::span<const double> u);

}  // namespace tribound
