#pragma once

/// @file cell_operator.templates.h
/// The definitions of cell_operator.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include "tribound/certify/equilibrate/cell_operator.h"

#include "tribound/certify/equilibrate/too_flat.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

template <int dim, int p>
void CellOperator<dim, p>::build(const SortedCell<dim>& cell, const StressMetric& metric)
{
  metric_ = metric;
  factor(cell);
  couple(cell);
}

/// A(r, s) = delta_rs (B_U B_U^T - D_c D_c^T / 2) + D_s D_r^T / 2 with D_c = sum_k J^{-1}(k, c) D_k: row r of
/// a stress sees entry (r, c) of a skew tensor through d_c and row c through -d_r. The metric multiplies by
/// its scale and adds trace D_r D_s^T, full products being the sums of what the reference has.
template <int dim, int p>
void CellOperator<dim, p>::factor(const SortedCell<dim>& cell)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  const Tensor<dim> metric = cell.inverse * cell.inverse.transpose();
  const auto& [scale, trace] = metric_;
  Dense<m, m> diagonal;
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) add_multiple(diagonal, scale * metric(k, l), ref.divergence[k][l]);
  for (int r = 0; r < dim; ++r)
    for (int s = r; s < dim; ++s)
    {
      Dense<m, m> block;
      if (r == s) block = diagonal;
      if constexpr (p > 1)
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l)
            add_multiple(block, scale * cell.inverse(k, s) * cell.inverse(l, r),
                         ref.truncated_divergence[k][l]);
      for (int k = 0; k < dim && trace != 0; ++k)
        for (int l = 0; l < dim; ++l)
        {
          const double factor = trace * cell.inverse(k, r) * cell.inverse(l, s);
          add_multiple(block, factor, ref.divergence[k][l]);
          add_multiple(block, factor, ref.truncated_divergence[k][l]);
        }
      for (int i = 0; i < m; ++i) std::copy_n(block.row(i), m, factor_.row(r * m + i) + s * m);
    }
  if (!cholesky<S::u>(factor_.data(), factor_.stride, reciprocal_.data()))
    throw no_equilibrated_stress<dim>(cell.origin, slenderness(cell));
}

/// C(a, b) = delta_ab (B_U N^T - ...) + grad_a lambda D_b E'^T / 2, times -|grad lambda|^{-1/2}. The metric
/// multiplies by its scale and adds trace D_a grad_b lambda E^T.
template <int dim, int p>
void CellOperator<dim, p>::couple(const SortedCell<dim>& cell)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  for (int f = 0; f <= dim; ++f)
  {
    const double unit = -1 / std::sqrt(cell.grad_norm[f]);
    const double scale = metric_.scale * unit;
    const Point<dim> direction = scale * (cell.inverse * cell.grad[f]);
    Dense<m, n> diagonal;
    std::array<Dense<m, n>, dim> skew;
    std::array<Dense<m, n>, dim> traces;
    for (int k = 0; k < dim; ++k)
    {
      add_multiple(diagonal, direction[k], ref.coupling[k][f]);
      for (int b = 0; b < dim; ++b)
      {
        if constexpr (p > 1) add_multiple(skew[b], scale * cell.inverse(k, b), ref.truncated_coupling[k][f]);
        if (metric_.trace == 0) continue;
        const double factor = metric_.trace * unit * cell.inverse(k, b);
        add_multiple(traces[b], factor, ref.coupling[k][f]);
        add_multiple(traces[b], factor, ref.truncated_coupling[k][f]);
      }
    }
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        for (int i = 0; i < m; ++i)
        {
          double* const target = coupling_.row(a * m + i) + f * facet_stride + b * n;
          for (int j = 0; j < n; ++j)
            target[j] = cell.grad[f][a] * skew[b](i, j) + cell.grad[f][b] * traces[a](i, j) +
                        (a == b ? diagonal(i, j) : 0);
        }
  }
  solve_transposed<S::u, all_facets>(factor_.data(), factor_.stride, reciprocal_.data(), coupling_.data(),
                                     all_facets);
}

/// N N^T - C_L^T C_L / 2 has the blocks (delta_st grad_f.grad_g (E_f E_g^T - E'_f E'_g^T / 2)
/// + grad_f[t] grad_g[s] E'_f E'_g^T / 2) / (|grad_f| |grad_g|)^{1/2}. The metric multiplies by its scale and
/// adds trace grad_f[s] grad_g[t] E_f E_g^T.
template <int dim, int p>
void CellOperator<dim, p>::condense(const SortedCell<dim>& cell)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int n = S::facet;
  for (int f = 0; f <= dim; ++f)
    for (int g = 0; g <= dim; ++g)
    {
      const double unit = 1 / std::sqrt(cell.grad_norm[f] * cell.grad_norm[g]);
      const double scale = metric_.scale * unit;
      const double product = scale * cell.grad[f].dot(cell.grad[g]);
      for (int s = 0; s < dim; ++s)
        for (int t = 0; t < dim; ++t)
        {
          const double traces = metric_.trace * unit * cell.grad[f][s] * cell.grad[g][t];
          const double skew = scale * cell.grad[f][t] * cell.grad[g][s] + traces;
          const double straight = (s == t ? product : 0) + traces;
          for (int i = 0; i < n; ++i)
          {
            double* const target = schur_.row(f * S::block + s * n + i) + g * facet_stride + t * n;
            for (int j = 0; j < n; ++j)
              target[j] = skew * ref.truncated_schur[f][g](i, j) + straight * ref.schur[f][g](i, j);
          }
        }
    }
  for (int f = 0; f <= dim; ++f)
    subtract_transposed_product<S::block, all_facets, S::u>(schur_.row(f * S::block), all_facets,
                                                            coupling_.data() + f * facet_stride, all_facets,
                                                            coupling_.data(), all_facets);
}

template <int dim, int p>
auto CellOperator<dim, p>::reduce(const UVector& r_u) const -> UVector
{
  UVector reduced = r_u;
  solve_transposed<S::u>(factor_.data(), factor_.stride, reciprocal_.data(), reduced.data());
  return reduced;
}

template <int dim, int p>
void CellOperator<dim, p>::subtract_load(FacetVectors& load, const SortedCell<dim>& cell, const UVector& r_u,
                                         const Tensor<dim>& w) const
{
  const UVector reduced = reduce(r_u);
  subtract_transposed_times<S::u, all_facets>(load.data(), coupling_.data(), all_facets, reduced.data());
  if constexpr (p == 1)  // C_L^T w: constant rotations have no part in B_U B_L^T
    for (int f = 0; f <= dim; ++f)
    {
      const Point<dim> direction =
          moment_of_one<dim, p>(cell) / std::sqrt(cell.grad_norm[f]) * (w * cell.grad[f]);
      for (int s = 0; s < dim; ++s)
        for (int j = 0; j < S::facet; ++j)
          load(f, s * S::facet + j) -= direction[s] * reference<dim, p>().trace[f](j, 0);
    }
}

template <int dim, int p>
DenseVector<Sizes<dim, p>::u> discrete_divergence(const SortedCell<dim>& cell,
                                                  const DiscreteStress<dim, p>& sigma)
{
  using S = Sizes<dim, p>;
  DenseVector<S::u> result;
  if constexpr (p > 1)
  {
    constexpr int m = S::multiplier;
    for (int r = 0; r < dim; ++r)
      for (int k = 0; k < dim; ++k)
      {
        std::array<double, m> row{};  // component k of row r on the reference cell
        for (int c = 0; c < dim; ++c)
          for (int j = 0; j < m; ++j) row[j] += cell.inverse(k, c) * sigma[(dim * r + c) * m + j];
        const auto& derivative = reference<dim, p>().derivative[k];
        for (int i = 0; i < m; ++i)
          for (int j = 0; j < m; ++j) result[r * m + i] += derivative(i, j) * row[j];
      }
  }
  return result;
}

template <int dim, int p>
DenseVector<Sizes<dim, p>::u> divergence_moments(const SortedCell<dim>& cell,
                                                 const StressCoefficients<dim, p>& tau)
{
  using S = Sizes<dim, p>;
  DenseVector<S::u> result;
  for (int r = 0; r < dim; ++r)
    for (int k = 0; k < dim; ++k)
    {
      std::array<double, S::stress> row{};  // component k of row r on the reference cell
      for (int c = 0; c < dim; ++c)
        for (int j = 0; j < S::stress; ++j) row[j] += cell.inverse(k, c) * tau[(dim * r + c) * S::stress + j];
      const auto& derivative = reference<dim, p>().derivative[k];
      for (int i = 0; i < S::multiplier; ++i)
        for (int j = 0; j < S::stress; ++j) result[r * S::multiplier + i] += derivative(i, j) * row[j];
    }
  return result;
}

template <int dim, int p, class At>
void add_normal_traces(const SortedCell<dim>& cell, const StressCoefficients<dim, p>& tau, const At& at)
{
  using S = Sizes<dim, p>;
  for (int f = 0; f <= dim; ++f)
    for (int r = 0; r < dim; ++r)
    {
      std::array<double, S::stress> normal{};
      const double scale = -1 / std::sqrt(cell.grad_norm[f]);
      for (int c = 0; c < dim; ++c)
        for (int j = 0; j < S::stress; ++j)
          normal[j] += scale * cell.grad[f][c] * tau[(dim * r + c) * S::stress + j];
      for (int i = 0; i < S::facet; ++i)
        for (int j = 0; j < S::stress; ++j) at(f, r, i) += reference<dim, p>().trace[f](i, j) * normal[j];
    }
}

/// C tau.
template <int dim, int p>
void CellOperator<dim, p>::apply_metric(StressCoefficients<dim, p>& stress) const
{
  if (metric_ == StressMetric{}) return;
  constexpr int n = S::stress;
  for (int j = 0; j < n; ++j)
  {
    double trace = 0;
    for (int r = 0; r < dim; ++r) trace += metric_.trace * stress[(dim * r + r) * n + j];
    for (int entry = 0; entry < dim * dim; ++entry) stress[entry * n + j] *= metric_.scale;
    for (int r = 0; r < dim; ++r) stress[(dim * r + r) * n + j] += trace;
  }
}

template <int dim, int p>
StressCoefficients<dim, p> CellOperator<dim, p>::correction(const SortedCell<dim>& cell, const UVector& r_u,
                                                            const Tensor<dim>& w,
                                                            const FacetVectors& mu) const
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  using Column = DenseVector<S::stress>;
  UVector eta = reduce(r_u);
  subtract_times<S::u, all_facets>(eta.data(), coupling_.data(), all_facets, mu.data());
  solve_upper<S::u>(factor_.data(), factor_.stride, reciprocal_.data(), eta.data());

  StressCoefficients<dim, p> result{};
  const auto add = [&](int r, int c, double factor, const Column& column)
  {
    for (int j = 0; j < S::stress; ++j) result[(dim * r + c) * S::stress + j] += factor * column[j];
  };
  for (int r = 0; r < dim; ++r)
  {
    for (int k = 0; k < dim; ++k)  // B_U^T: entry (r, c) gets sum_k J^{-1}(k, c) D_k^T eta_r
    {
      Column column;
      subtract_transposed_times<m, Column::stride>(column.data(), ref.derivative[k].data(), Column::stride,
                                                   eta.data() + r * m);
      for (int c = 0; c < dim; ++c) add(r, c, cell.inverse(k, c), column);
    }
    for (int f = 0; f <= dim; ++f)  // N^T: entry (r, c) gets n_c |grad lambda|^{1/2} E^T mu_r
    {
      Column column;
      subtract_transposed_times<n, Column::stride>(column.data(), ref.trace[f].data(), Column::stride,
                                                   mu.row(f) + r * n);
      const double scale = -1 / std::sqrt(cell.grad_norm[f]);
      for (int c = 0; c < dim; ++c) add(r, c, scale * cell.grad[f][c], column);
    }
  }
  apply_metric(result);
  for (const auto& [r, c] : skew_pairs<dim>)
  {
    for (int j = 0; j < m; ++j)
    {
      double& upper = result[(dim * r + c) * S::stress + j];
      double& lower = result[(dim * c + r) * S::stress + j];
      upper = lower = (upper + lower) / 2;
    }
    if constexpr (p == 1)
    {
      const double moment = w(r, c) * moment_of_one<dim, p>(cell);
      result[(dim * r + c) * S::stress] += moment;
      result[(dim * c + r) * S::stress] -= moment;
    }
  }
  return result;
}

template <int dim, int p>
DiscreteStress<dim, p> discrete_stress(const SortedCell<dim>& cell, const problem::Material& material,
                                       std::span<const Index> nodes, std::span<const double> u)
{
  using S = Sizes<dim, p>;
  const Reference<dim, p>& ref = reference<dim, p>();
  const auto& nodal = ref.nodal_derivative[permutation_number(cell.local)];
  std::array<std::array<DenseVector<S::multiplier>, dim>, dim> gradient;  // minus d_k u_a: [k][a]
  for (int a = 0; a < dim; ++a)
  {
    std::array<double, S::stress> values;
    for (int i = 0; i < S::stress; ++i) values[i] = u[static_cast<std::size_t>(dim) * nodes[i] + a];
    for (int k = 0; k < dim; ++k)
      subtract_transposed_times<S::stress, padded(S::multiplier)>(gradient[k][a].data(), nodal[k].data(),
                                                                  nodal[k].stride, values.data());
  }
  DiscreteStress<dim, p> result;
  const double scale = -std::sqrt(cell.det);  // basis functions on the cell are chi / sqrt(det)
  for (int j = 0; j < S::multiplier; ++j)
  {
    Tensor<dim> hat;
    for (int k = 0; k < dim; ++k)
      for (int a = 0; a < dim; ++a) hat(a, k) = scale * gradient[k][a][j];
    const Tensor<dim> stress = contact::sigma<dim>(material, hat * cell.inverse);
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c) result[(dim * r + c) * S::multiplier + j] = stress(r, c);
  }
  return result;
}

}  // namespace tribound::certify
