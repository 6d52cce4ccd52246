#pragma once

/// @file row_patch.templates.h
/// The definitions of row_patch.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include <algorithm>
#include <cmath>

#include "tribound/certify/equilibrate/row_patch.h"
#include "tribound/certify/equilibrate/too_flat.h"

namespace tribound::certify
{

template <int dim, int p>
void RowPatch<dim, p>::solve()
{
  this->order_facets();
  make_compatible();
  for (int problem = 0; problem < n_problems_; ++problem) x_[problem].assign(facets_.size(), {});
  for (int k = 0; k < n_cells_; ++k)
  {
    this->eliminate_outer(cells_[k]);
    this->add_to_matrix(cells_[k]);
    for (int problem = 0; problem < n_problems_; ++problem) assemble_load(cells_[k], problem);
  }
  for (std::size_t i = 0; i < facets_.size(); ++i)
    for (int problem = 0; problem < n_problems_; ++problem)
      if (const auto* t = traction(facets_[i].number, problem))
        for (int c = 0; c < dim; ++c)
          for (int j = 0; j < S::facet; ++j) x_[problem][i](j, c) -= (*t)[c * S::facet + j];
  for (int c = 0; c < dim; ++c)
  {
    bool is_first = true;
    for (int other = 0; other < c; ++other) is_first = is_first && !fixed_alike(c, other);
    if (is_first) solve_rows_like(c);
  }
  for (int problem = 0; problem < n_problems_; ++problem)
    for (int k = 0; k < n_cells_; ++k) recover(cells_[k], problem);
}

/// Whether a facet of the patch fixes the component.
template <int dim, int p>
bool RowPatch<dim, p>::is_fixed(int component) const
{
  for (int i = 0; i < static_cast<int>(facets_.size()); ++i)
    if (fixes(i, component)) return true;
  return false;
}

template <int dim, int p>
bool RowPatch<dim, p>::fixed_alike(int component, int other) const
{
  for (int i = 0; i < static_cast<int>(facets_.size()); ++i)
    if (fixes(i, component) != fixes(i, other)) return false;
  return true;
}

/// y_a in the components that no facet fixes: (y_a, e_c) = -<R(u^k), psi_a e_c> for dis, (y_lin, e_c) =
/// (t^k - T_delta(u^k), psi_a e_c)_C for lin and (y_reg, e_c) = (T_delta(u^k) - T(u^k), psi_a e_c)_C for reg.
template <int dim, int p>
void RowPatch<dim, p>::make_compatible()
{
  Point<dim> load = Point<dim>::Zero();  // (-psi_a f + sigma(u^k) grad psi_a, 1)
  double volume = 0;
  for (int k = 0; k < n_cells_; ++k)
  {
    const RowCell<dim, p>& cell = *cells_[k].prepared;
    const int a = cells_[k].vertex;
    volume += cell.one * cell.one;
    for (int c = 0; c < dim; ++c)
    {
      double sum = -cell.body[a](0, c);
      for (int d = 0; d < dim; ++d) sum += cell.sorted.grad[a][d] * cell.sigma[(dim * c + d) * S::multiplier];
      load[c] += cell.one * sum;
    }
  }
  y_.fill(Point<dim>::Zero());
  for (int c = 0; c < dim; ++c)
  {
    if (is_fixed(c)) continue;
    for (int problem = 1; problem < n_problems_; ++problem)
      y_[problem][c] = traction_work(problem, c) / volume;
    y_[0][c] = (load[c] - traction_work(0, c)) / volume;
  }
}

/// (t_c, 1) over the facets of the patch.
template <int dim, int p>
double RowPatch<dim, p>::traction_work(int problem, int component) const
{
  const auto& hat = reference<dim, p>().facet_hat_moment;
  double work = 0;
  for (const auto& [number, scale] : facets_)
    if (const auto* t = traction(number, problem))
      for (int i = 0; i < S::facet; ++i)
        for (int v = 0; v < dim; ++v) work += std::sqrt(scale) * hat(i, v) * (*t)[component * S::facet + i];
  return work;
}

/// g = N G - C^T A^{-1} r with the outer facet eliminated; r is psi_a (div sigma + f) + y_a for dis, -y_lin
/// for lin, -y_reg for reg.
template <int dim, int p>
void RowPatch<dim, p>::assemble_load(CellPart& part, int problem)
{
  constexpr int m = S::multiplier;
  const RowCell<dim, p>& cell = *part.prepared;
  const Reference<dim, p>& ref = reference<dim, p>();
  const int o = part.vertex;
  CellRows r;
  typename Operator::AllFacetRows load{};
  if (problem == 0)
  {
    r = cell.body[o];
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) lanes_at(r.row(i)) += ref.hat[o](i, j) * lanes_at(cell.divergence.row(j));
    for (int f = 0; f <= dim; ++f)  // N (psi_a sigma)
      for (int i = 0; i < S::facet && f != o; ++i)
        for (int j = 0; j < m; ++j)
          lanes_at(load[f].row(i)) += ref.hat_trace[f][o](i, j) * lanes_at(cell.normal[f].row(j));
  }
  if (problem == 0 && !cell.rest.empty())
  {
    add_by_rows<dim, p>(r, divergence_moments<dim, p>(cell.sorted, cell.rest[o]));
    add_normal_traces<dim, p>(cell.sorted, cell.rest[o],
                              [&load](int f, int row, int i) -> double& { return load[f](i, row); });
  }
  for (int c = 0; c < dim; ++c) r(0, c) += (problem == 0 ? 1 : -1) * y_[problem][c] * cell.one;
  cell.op->subtract_load(load, r);

  FacetRows& outer = part.outer_load[problem];
  outer = load[o];
  solve_transposed<S::facet, width>(part.outer->rows.data() + o * Operator::facet_stride,
                                    Operator::all_facets, part.outer->reciprocal.data(), outer.data(), width);
  for (int f = 0; f <= dim; ++f)
  {
    if (f == o) continue;
    subtract_transposed_product<S::facet, width, S::facet>(
        load[f].data(), width, part.outer->rows.data() + f * Operator::facet_stride, Operator::all_facets,
        outer.data(), width);
    add_multiple(x_[problem][part.facets[f]], 1, load[f]);
  }
}

/// The multipliers of the rows that are fixed on the same facets as that of the component.
template <int dim, int p>
void RowPatch<dim, p>::solve_rows_like(int component)
{
  const auto n_facets = static_cast<int>(facets_.size());
  if (component > 0)  // the matrix was factored for other rows
  {
    factors_ = nullptr;
    matrix_.clear();
    for (int k = 0; k < n_cells_; ++k) this->add_to_matrix(cells_[k]);
  }
  if (factors_ == nullptr)
  {
    for (int i = 0; i < n_facets; ++i)
      if (fixes(i, component)) matrix_.template decouple<S::facet>(i, 0);
    if (!is_fixed(component)) fix_constant();
    this->factor();
  }
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    rows_.assign(x_[problem].begin(), x_[problem].begin() + n_facets);
    for (int i = 0; i < n_facets; ++i)
      if (fixes(i, component)) rows_[i] = {};  // the normal trace is free: its multiplier is 0
    factors_->solve(std::span(rows_));
    for (int c = component; c < dim; ++c)
      if (fixed_alike(c, component))
        for (int i = 0; i < n_facets; ++i)
          for (int j = 0; j < S::facet; ++j) x_[problem][i](j, c) = rows_[i](j, c);
  }
}

/// Multipliers that are the trace of a constant change nothing: makes the matrix definite by a term on one
/// facet, which the solution, the data being compatible, does not feel.
template <int dim, int p>
void RowPatch<dim, p>::fix_constant()
{
  const auto last = static_cast<int>(facets_.size()) - 1;
  auto& diagonal = matrix_.block(last, last);
  std::array<double, S::facet> one{};
  double scale = 0;
  double square = 0;
  for (int i = 0; i < S::facet; ++i)
  {
    for (int v = 0; v < dim; ++v) one[i] += reference<dim, p>().facet_hat_moment(i, v);
    scale += diagonal(i, i) / S::facet;
    square += one[i] * one[i];
  }
  for (int i = 0; i < S::facet; ++i)
    for (int j = 0; j < S::facet; ++j) diagonal(i, j) += scale / square * one[i] * one[j];
}

/// The multiplier of the outer facet, and all that goes to the cell.
template <int dim, int p>
void RowPatch<dim, p>::recover(CellPart& part, int problem)
{
  RowShare<dim, p>& share = part.shares[problem];
  const int o = part.vertex;
  const double* const rows = part.outer->rows.data();
  FacetRows& outer = share.mu[o];
  outer = part.outer_load[problem];
  for (int f = 0; f <= dim; ++f)
  {
    if (f == o) continue;
    share.mu[f] = x_[problem][part.facets[f]];
    subtract_product<S::facet, width, S::facet>(outer.data(), width, rows + f * Operator::facet_stride,
                                                Operator::all_facets, share.mu[f].data(), width);
  }
  solve_upper<S::facet, width>(rows + o * Operator::facet_stride, Operator::all_facets,
                               part.outer->reciprocal.data(), outer.data(), width);
  share.y = y_[problem];
}

/// The data of the cell problem add up, psi_a to 1.
template <int dim, int p>
StressCoefficients<dim, p> RowPatch<dim, p>::stress(const RowCell<dim, p>& cell,
                                                    const CellShares<RowShare<dim, p>, dim>& shares,
                                                    int problem, const FacetData<dim, p>& data)
{
  CellRows r;
  if (problem == 0) r = cell.divergence;
  typename Operator::AllFacetRows mu{};
  for (int a = 0; a <= dim; ++a)
  {
    if (problem == 0) add_multiple(r, 1, cell.body[a]);
    if (problem == 0 && !cell.rest.empty())
      add_by_rows<dim, p>(r, divergence_moments<dim, p>(cell.sorted, cell.rest[a]));
    if (problem > 0 && !data.on_contact(cell.sorted.vertices[a])) continue;
    const RowShare<dim, p>& share = shares[a][problem];
    for (int c = 0; c < dim; ++c) r(0, c) += (problem == 0 ? 1 : -1) * share.y[c] * cell.one;
    for (int f = 0; f <= dim; ++f) add_multiple(mu[f], 1, share.mu[f]);
  }
  return cell.op->correction(cell.sorted, r, mu);
}

}  // namespace tribound::certify
