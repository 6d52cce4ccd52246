#include "tribound/certify/equilibrate/rigid.h"

#include <algorithm>

#include "tribound/base/dense_factors.h"

namespace tribound::certify
{

namespace
{

constexpr double admissible_share = 1e-8;
constexpr double almost_admissible_share = 0.35;

/// The skew tensor of pair i.
template <int dim>
Tensor<dim> unit_spin(int i)
{
  Tensor<dim> spin = Tensor<dim>::Zero();
  const auto [r, c] = skew_pairs<dim>[i];
  spin(r, c) = -1;
  spin(c, r) = 1;
  return spin;
}

/// Rotations about the centre that are orthogonal in their values at the vertices of the fixed facets and in
/// the fixed components of these, the least fixed first.
template <int dim>
struct SortedSpins
{
  using Gram = Eigen::Matrix<double, n_spins<dim>, n_spins<dim>>;

  SortedSpins(const Point<dim>& centre, double size, std::span<const FixedFacet<dim>> facets);

  Gram spins = Gram::Identity();  ///< columns: coefficients of the unit spins
  Eigen::Matrix<double, n_spins<dim>, 1> shares =
      Eigen::Matrix<double, n_spins<dim>, 1>::Zero();  ///< |z_fixed| / |z|
};

template <int dim>
SortedSpins<dim>::SortedSpins(const Point<dim>& centre, double size, std::span<const FixedFacet<dim>> facets)
{
  constexpr int n = n_spins<dim>;
  if (facets.empty()) return;
  Eigen::Matrix<double, Eigen::Dynamic, n> fixed(static_cast<Eigen::Index>(dim * dim * facets.size()), n);
  Eigen::Index n_fixed = 0;
  Gram all = Gram::Zero();
  for (const FixedFacet<dim>& facet : facets)
    for (const Point<dim>& x : facet.vertices)
    {
      Eigen::Matrix<double, dim, n> values;
      for (int i = 0; i < n; ++i) values.col(i) = unit_spin<dim>(i) * (x - centre) / size;
      all += values.transpose() * values;
      for (int a = 0; a < dim; ++a)
        if (facet.fixed[a]) fixed.row(n_fixed++) = values.row(a);
    }
  // In coordinates y with |z| = |y|. Singular values, not eigenvalues of the Gram matrix, which would square
  // the shares and lose those below 1e-8.
  const Eigen::MatrixXd lower = CholeskyFactors(all).lower();
  const RightSingular svd =
      right_singular(solve_lower(lower, fixed.topRows(n_fixed).transpose()).transpose());
  for (int i = 0; i < svd.values.size(); ++i) shares[n - 1 - i] = svd.values[i];
  spins = solve_lower_transposed(lower, svd.vectors).rowwise().reverse();
}

}  // namespace

template <int dim>
RigidMotions<dim>::RigidMotions(const Point<dim>& centre, double size,
                                std::span<const FixedFacet<dim>> facets)
    : centre_(centre)
{
  for (RigidField<dim>& motion : motions_) motion = {Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (int a = 0; a < dim; ++a)
    if (std::ranges::none_of(facets, [&](const FixedFacet<dim>& facet) { return facet.fixed[a]; }))
      motions_[n_translations_++].translation[a] = 1;

  const SortedSpins<dim> rotations(centre, size, facets);
  for (int i = 0; i < n_spins<dim> && rotations.shares[i] < almost_admissible_share; ++i)
  {
    ++(rotations.shares[i] <= admissible_share ? n_rotations_ : n_almost_);
    for (int k = 0; k < n_spins<dim>; ++k)
      motions_[n_translations_ + i].gradient += rotations.spins(k, i) / size * unit_spin<dim>(k);
  }
}

template class RigidMotions<2>;
template class RigidMotions<3>;

}  // namespace tribound::certify
