#include "tribound/certify/equilibrate/rigid.h"

#include <Eigen/Eigenvalues>

namespace tribound::certify
{

namespace
{

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

/// An orthonormal basis of the null space of a symmetric positive semidefinite matrix of entries of size 1:
/// the first `nullity` columns.
template <int n>
struct NullSpace
{
  explicit NullSpace(const Eigen::Matrix<double, n, n>& gram)
  {
    constexpr double threshold = 1e-10;  // the rows are of size 1 on the patch: this is an angle of 1e-5
    if (gram.isZero(0))                  // inside Omega: spares the eigenvalues
    {
      nullity = n;
      return;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> eigen(gram);
    while (nullity < n && eigen.eigenvalues()[nullity] < threshold) ++nullity;  // they ascend
    basis = eigen.eigenvectors();
  }

  Eigen::Matrix<double, n, n> basis = Eigen::Matrix<double, n, n>::Identity();
  int nullity = 0;
};

}  // namespace

template <int dim>
RigidMotions<dim>::RigidMotions(const Point<dim>& centre, double size,
                                std::span<const FixedFacet<dim>> facets)
    : centre_(centre)
{
  constexpr int n_spins = dim * (dim - 1) / 2;
  Tensor<dim> translations = Tensor<dim>::Zero();  // Gram matrices of the conditions
  Eigen::Matrix<double, n_spins, n_spins> rotations = Eigen::Matrix<double, n_spins, n_spins>::Zero();
  for (const FixedFacet<dim>& facet : facets)
    for (int a = 0; a < dim; ++a)
    {
      if (!facet.fixed[a]) continue;
      translations(a, a) += 1;
      for (const Point<dim>& x : facet.vertices)
      {
        Eigen::Matrix<double, n_spins, 1> row;
        for (int i = 0; i < n_spins; ++i) row[i] = (unit_spin<dim>(i) * (x - centre) / size)[a];
        rotations += row * row.transpose();
      }
    }

  const NullSpace<dim> t(translations);
  const NullSpace<n_spins> r(rotations);
  n_translations_ = t.nullity;
  n_rotations_ = r.nullity;
  for (RigidField<dim>& motion : motions_) motion = {Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (int i = 0; i < n_translations_; ++i) motions_[i].translation = t.basis.col(i);
  for (int i = 0; i < n_rotations_; ++i)
    for (int k = 0; k < n_spins; ++k)
      motions_[n_translations_ + i].gradient += r.basis(k, i) / size * unit_spin<dim>(k);
}

template class RigidMotions<2>;
template class RigidMotions<3>;

}  // namespace tribound::certify
