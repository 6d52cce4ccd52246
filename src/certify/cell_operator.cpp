#include "certify/cell_operator.h"

#include "contact/elasticity.h"

namespace tribound
{

template <int dim, int p>
void CellOperator<dim, p>::build(const Frame<dim>& frame)
{
  factor(frame);
  couple(frame);
}

template <int dim, int p>
void CellOperator<dim, p>::factor(const Frame<dim>& frame)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  for (int c = 0; c < dim; ++c)
  {
    derivative_[c].setZero();
    for (int k = 0; k < dim; ++k)
      derivative_[c] += frame.inverse(k, c) * ref.derivative[k].template leftCols<m>();
  }

  // B_U B_U^T is the same block for every row of sigma.
  const Tensor<dim> metric = frame.inverse * frame.inverse.transpose();
  Truncated full = Truncated::Zero();
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) full += metric(k, l) * ref.derivative_derivative[k][l];

  // B_U B_L^T B_L B_U^T: row r sees entry (r, c) of a skew tensor through d_c and row c through -d_r.
  UMatrix a;
  for (int r = 0; r < dim; ++r)
    for (int s = 0; s < dim; ++s)
    {
      Truncated block = Truncated::Zero();
      if (r == s)
      {
        block = full;
        for (int c = 0; c < dim; ++c)
          if (c != r) block -= 0.5 * derivative_[c] * derivative_[c].transpose();
      }
      else
        block = 0.5 * derivative_[s] * derivative_[r].transpose();
      a.template block<m, m>(r * m, s * m) = block;
    }
  factor_.compute(a);
}

template <int dim, int p>
void CellOperator<dim, p>::couple(const Frame<dim>& frame)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  for (int f = 0; f <= dim; ++f)
  {
    const double scale = -1 / std::sqrt(frame.grad_norm[f]);
    const Point<dim> direction = scale * (frame.inverse * frame.grad[f]);
    Block<m, n> divergence = Block<m, n>::Zero();
    for (int k = 0; k < dim; ++k) divergence += direction[k] * ref.derivative_trace[k][f];
    const Block<m, n> truncated = ref.trace[f].template leftCols<m>().transpose();

    auto& rotation = rotation_coupling_[f];
    rotation.setZero();
    auto& coupling = half_coupling_[f];
    coupling.setZero();
    for (int r = 0; r < dim; ++r) coupling.template block<m, n>(r * m, r * n) = divergence;
    for (int i = 0; i < S::pairs; ++i)
    {
      const auto [r, c] = skew_pairs<dim>[i];
      rotation.template block<m, n>(i * m, r * n) = scale * frame.grad[f][c] * truncated;
      rotation.template block<m, n>(i * m, c * n) = -scale * frame.grad[f][r] * truncated;
      // C_U - B_U B_L^T C_L / 2, pair by pair
      for (const int s : {r, c})
      {
        const auto block = rotation.template block<m, n>(i * m, s * n);
        coupling.template block<m, n>(r * m, s * n).noalias() -= 0.5 * derivative_[c] * block;
        coupling.template block<m, n>(c * m, s * n).noalias() += 0.5 * derivative_[r] * block;
      }
    }
    factor_.matrixL().solveInPlace(coupling);
  }
}

template <int dim, int p>
void CellOperator<dim, p>::condense(const Frame<dim>& frame)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int n = S::facet;
  for (int f = 0; f <= dim; ++f)
    for (int g = f; g <= dim; ++g)
    {
      BlockMatrix& s = schur_[f][g];
      s.noalias() = -0.5 * rotation_coupling_[f].transpose() * rotation_coupling_[g];
      s.noalias() -= half_coupling_[f].transpose() * half_coupling_[g];
      const double scale =
          frame.grad[f].dot(frame.grad[g]) / std::sqrt(frame.grad_norm[f] * frame.grad_norm[g]);
      for (int r = 0; r < dim; ++r) s.template block<n, n>(r * n, r * n) += scale * ref.trace_trace[f][g];
    }
}

template <int dim, int p>
auto CellOperator<dim, p>::u_from_rotation(const RotationVector& x) const -> UVector
{
  constexpr int m = S::multiplier;
  UVector result = UVector::Zero();
  for (int i = 0; i < S::pairs; ++i)
  {
    const auto [r, c] = skew_pairs<dim>[i];
    result.template segment<m>(r * m) += derivative_[c] * x.template segment<m>(i * m);
    result.template segment<m>(c * m) -= derivative_[r] * x.template segment<m>(i * m);
  }
  return result;
}

template <int dim, int p>
auto CellOperator<dim, p>::rotation_from_u(const UVector& x) const -> RotationVector
{
  constexpr int m = S::multiplier;
  RotationVector result;
  for (int i = 0; i < S::pairs; ++i)
  {
    const auto [r, c] = skew_pairs<dim>[i];
    result.template segment<m>(i * m) = derivative_[c].transpose() * x.template segment<m>(r * m) -
                                        derivative_[r].transpose() * x.template segment<m>(c * m);
  }
  return result;
}

template <int dim, int p>
auto CellOperator<dim, p>::reduce(const UVector& r_u, const RotationVector& r_rotation) const -> UVector
{
  UVector reduced = r_u;
  if (p == 1) reduced -= 0.5 * u_from_rotation(r_rotation);  // r_rotation = 0 for p >= 2
  factor_.matrixL().solveInPlace(reduced);
  return reduced;
}

template <int dim, int p>
auto CellOperator<dim, p>::divergence(const DiscreteStress<dim, p>& sigma) const -> UVector
{
  constexpr int m = S::multiplier;
  UVector result = UVector::Zero();
  for (int r = 0; r < dim; ++r)
    for (int c = 0; c < dim; ++c)
      result.template segment<m>(r * m) += derivative_[c] * sigma.col(dim * r + c);
  return result;
}

template <int dim, int p>
StressCoefficients<dim, p> CellOperator<dim, p>::correction(const Frame<dim>& frame, const UVector& r_u,
                                                            const RotationVector& r_rotation,
                                                            const FacetVectors& mu) const
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  UVector eta_u = reduce(r_u, r_rotation);
  for (int f = 0; f <= dim; ++f) eta_u -= half_coupling_[f] * mu[f];
  factor_.matrixU().solveInPlace(eta_u);
  RotationVector eta_rotation = r_rotation - rotation_from_u(eta_u);
  for (int f = 0; f <= dim; ++f) eta_rotation -= rotation_coupling_[f] * mu[f];
  eta_rotation *= 0.5;

  StressCoefficients<dim, p> result = StressCoefficients<dim, p>::Zero();
  for (int r = 0; r < dim; ++r)
    for (int k = 0; k < dim; ++k)
    {
      // B_U^T: entry (r, c) gets D_c^T eta_r with D_c = sum_k J^{-1}(k, c) Dhat_k
      const Eigen::Matrix<double, S::stress, 1> column =
          ref.derivative[k].transpose() * eta_u.template segment<m>(r * m);
      for (int c = 0; c < dim; ++c) result.col(dim * r + c) -= frame.inverse(k, c) * column;
    }
  for (int i = 0; i < S::pairs; ++i)
  {
    const auto [r, c] = skew_pairs<dim>[i];
    result.col(dim * r + c).template head<m>() -= eta_rotation.template segment<m>(i * m);
    result.col(dim * c + r).template head<m>() += eta_rotation.template segment<m>(i * m);
  }
  for (int f = 0; f <= dim; ++f)
    for (int r = 0; r < dim; ++r)
    {
      // N^T: entry (r, c) gets n_c |grad lambda|^{1/2} E^T mu_r
      const Eigen::Matrix<double, S::stress, 1> column =
          ref.trace[f].transpose() * mu[f].template segment<n>(r * n) / std::sqrt(frame.grad_norm[f]);
      for (int c = 0; c < dim; ++c) result.col(dim * r + c) += frame.grad[f][c] * column;
    }
  return result;
}

template <int dim, int p>
DiscreteStress<dim, p> discrete_stress(const Frame<dim>& frame, const Material& material,
                                       std::span<const Index> nodes, std::span<const double> u)
{
  using S = Sizes<dim, p>;
  constexpr int n_nodes = S::stress;
  const Reference<dim, p>& ref = reference<dim, p>();
  const auto& nodal = ref.nodal_derivative[permutation_number(frame.local)];
  Eigen::Matrix<double, n_nodes, dim> values;
  for (int i = 0; i < n_nodes; ++i)
    for (int a = 0; a < dim; ++a) values(i, a) = u[static_cast<std::size_t>(dim) * nodes[i] + a];

  std::array<Eigen::Matrix<double, S::multiplier, dim>, dim> reference_gradient;  // [k](., a): d_k u_a
  for (int k = 0; k < dim; ++k) reference_gradient[k] = nodal[k].lazyProduct(values);
  DiscreteStress<dim, p> result;
  const double scale = std::sqrt(frame.det);  // basis functions on the cell are chi / sqrt(det)
  for (int j = 0; j < S::multiplier; ++j)
  {
    Tensor<dim> hat;
    for (int k = 0; k < dim; ++k) hat.col(k) = scale * reference_gradient[k].row(j).transpose();
    const Tensor<dim> stress = sigma<dim>(material, hat * frame.inverse);
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c) result(j, dim * r + c) = stress(r, c);
  }
  return result;
}

#define TRIBOUND_INSTANTIATE(dim, p)                                                          \
  template class CellOperator<dim, p>;                                                        \
  template DiscreteStress<dim, p> discrete_stress<dim, p>(const Frame<dim>&, const Material&, \
                                                          std::span<const Index>, std::span<const double>);

TRIBOUND_INSTANTIATE(2, 1)
TRIBOUND_INSTANTIATE(2, 2)
TRIBOUND_INSTANTIATE(2, 3)
TRIBOUND_INSTANTIATE(2, 4)
TRIBOUND_INSTANTIATE(3, 1)
TRIBOUND_INSTANTIATE(3, 2)
TRIBOUND_INSTANTIATE(3, 3)
TRIBOUND_INSTANTIATE(3, 4)

}  // namespace tribound
