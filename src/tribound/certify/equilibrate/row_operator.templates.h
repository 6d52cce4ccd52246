#pragma once

/// @file row_operator.templates.h
/// The definitions of row_operator.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include <cassert>

#include "tribound/certify/equilibrate/row_operator.h"
#include "tribound/certify/equilibrate/too_flat.h"

namespace tribound::certify
{

/// B_c = sum_k J^{-1}(k, c) D_k and N_f = -|grad lambda_f|^{-1/2} grad lambda_f E_f; the reference has
/// products as sums of two.
template <int dim, int p>
void RowOperator<dim, p>::build(const SortedCell<dim>& cell, [[maybe_unused]] const StressMetric& metric)
{
  assert(metric == StressMetric{});
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  const Tensor<dim> products = cell.inverse * cell.inverse.transpose();
  factor_ = {};
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l)
      for (const auto* part : {&ref.divergence[k][l], &ref.truncated_divergence[k][l]})
        add_multiple(factor_, products(k, l), *part);
  if (!cholesky<m>(factor_.data(), factor_.stride, reciprocal_.data()))
    throw no_equilibrated_stress<dim>(cell.origin, slenderness(cell));

  for (int f = 0; f <= dim; ++f)
  {
    const Point<dim> direction = -1 / std::sqrt(cell.grad_norm[f]) * (cell.inverse * cell.grad[f]);
    Dense<m, S::facet> coupling;
    for (int k = 0; k < dim; ++k)
      for (const auto* part : {&ref.coupling[k][f], &ref.truncated_coupling[k][f]})
        add_multiple(coupling, direction[k], *part);
    for (int i = 0; i < m; ++i)
      std::copy_n(coupling.row(i), facet_stride, coupling_.row(i) + f * facet_stride);
  }
  solve_transposed<m, all_facets>(factor_.data(), factor_.stride, reciprocal_.data(), coupling_.data(),
                                  all_facets);
}

template <int dim, int p>
void RowOperator<dim, p>::condense(const SortedCell<dim>& cell)
{
  const Reference<dim, p>& ref = reference<dim, p>();
  for (int f = 0; f <= dim; ++f)
  {
    for (int g = 0; g <= dim; ++g)
    {
      const double product =
          cell.grad[f].dot(cell.grad[g]) / std::sqrt(cell.grad_norm[f] * cell.grad_norm[g]);
      Dense<block, block> traces;
      for (const auto* part : {&ref.schur[f][g], &ref.truncated_schur[f][g]})
        add_multiple(traces, product, *part);
      for (int i = 0; i < block; ++i)
        std::copy_n(traces.row(i), facet_stride, schur_.row(f * block + i) + g * facet_stride);
    }
    subtract_transposed_product<block, all_facets, S::multiplier>(schur_.row(f * block), all_facets,
                                                                  coupling_.data() + f * facet_stride,
                                                                  all_facets, coupling_.data(), all_facets);
  }
}

/// U^{-T} r.
template <int dim, int p>
auto RowOperator<dim, p>::reduce(const CellRows& r) const -> CellRows
{
  CellRows reduced = r;
  solve_transposed<S::multiplier, width>(factor_.data(), factor_.stride, reciprocal_.data(), reduced.data(),
                                         width);
  return reduced;
}

template <int dim, int p>
void RowOperator<dim, p>::subtract_load(AllFacetRows& load, const CellRows& r) const
{
  const CellRows reduced = reduce(r);
  for (int f = 0; f <= dim; ++f)
    subtract_transposed_product<block, width, S::multiplier>(
        load[f].data(), width, coupling_.data() + f * facet_stride, all_facets, reduced.data(), width);
}

template <int dim, int p>
StressCoefficients<dim, p> RowOperator<dim, p>::correction(const SortedCell<dim>& cell, const CellRows& r,
                                                           const AllFacetRows& mu) const
{
  const Reference<dim, p>& ref = reference<dim, p>();
  constexpr int m = S::multiplier;
  constexpr int n = S::stress;
  using Columns = Dense<n, dim>;
  CellRows eta = reduce(r);
  for (int f = 0; f <= dim; ++f)
    subtract_product<m, width, block>(eta.data(), width, coupling_.data() + f * facet_stride, all_facets,
                                      mu[f].data(), width);
  solve_upper<m, width>(factor_.data(), factor_.stride, reciprocal_.data(), eta.data(), width);

  StressCoefficients<dim, p> result{};
  const auto add = [&](int k, double factor, const Columns& columns)  // to entry (row, k) of every row
  {
    for (int row = 0; row < dim; ++row)
      for (int j = 0; j < n; ++j) result[(dim * row + k) * n + j] += factor * columns(j, row);
  };
  for (int k = 0; k < dim; ++k)  // -B^T eta
  {
    Columns columns;
    subtract_transposed_product<n, width, m>(columns.data(), width, ref.derivative[k].data(),
                                             ref.derivative[k].stride, eta.data(), width);
    for (int c = 0; c < dim; ++c) add(c, cell.inverse(k, c), columns);
  }
  for (int f = 0; f <= dim; ++f)  // -N^T mu
  {
    Columns columns;
    subtract_transposed_product<n, width, block>(columns.data(), width, ref.trace[f].data(),
                                                 ref.trace[f].stride, mu[f].data(), width);
    const double scale = -1 / std::sqrt(cell.grad_norm[f]);
    for (int c = 0; c < dim; ++c) add(c, scale * cell.grad[f][c], columns);
  }
  return result;
}

}  // namespace tribound::certify
