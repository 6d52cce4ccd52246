#pragma once

/// @file patch.templates.h
/// The definitions of patch.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include "tribound/certify/equilibrate/patch.h"

#include <algorithm>
#include <cmath>

#include "tribound/certify/equilibrate/too_flat.h"

namespace tribound::certify
{

template <int dim, int p>
void Patch<dim, p>::solve()
{
  this->order_facets();
  make_compatible();
  assemble();
  if (factors_ == nullptr)
  {
    fix_rigid_motions();
    this->factor();
  }
  for (int problem = 0; problem < n_problems_; ++problem)
    factors_->solve(std::span(x_[problem]).first(facets_.size()));
  if (motions_.n_almost() > 0) balance_almost_rigid();
  for (int problem = 0; problem < n_problems_; ++problem)
    for (int k = 0; k < n_cells_; ++k) recover(cells_[k], problem);
}

/// Coefficients of motion i in P^p(F)^d.
template <int dim, int p>
auto Patch<dim, p>::moments_on_facet(int facet, int motion) const -> FacetVector
{
  const auto& hat = reference<dim, p>().facet_hat_moment;
  FacetVector moments;
  const double scale = std::sqrt(facets_[facet].scale);
  for (int v = 0; v < dim; ++v)
  {
    const Point<dim> z =
        scale * motions_(motion, mesh_.vertex(mesh_.topology().facets[facets_[facet].number][v]));
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < S::facet; ++i) moments[c * S::facet + i] += z[c] * hat(i, v);
  }
  return moments;
}

template <int dim, int p>
void Patch<dim, p>::assemble()
{
  for (int problem = 0; problem < n_problems_; ++problem) x_[problem].assign(facets_.size(), {});
  for (int k = 0; k < n_cells_; ++k)
  {
    this->eliminate_outer(cells_[k]);
    this->add_to_matrix(cells_[k]);
    for (int problem = 0; problem < n_problems_; ++problem) assemble_load(cells_[k], problem);
  }
  if (motions_.n_almost() > 0) load_almost_rigid();
  for (std::size_t i = 0; i < facets_.size(); ++i)
  {
    if (!data_.is_boundary(facets_[i].number)) continue;
    for (int problem = 0; problem < n_problems_; ++problem)
      if (const auto* t = traction(facets_[i].number, problem)) add_multiple(x_[problem][i], -1, *t);
    decouple_fixed_components(static_cast<int>(i));
  }
}

/// G = psi_a (C eps(u) + Pi^{p-1} sigma_0) + rest, and g = N G - C^T (B B^T)^{-1} r with the outer facet
/// eliminated. With div G = psi_a div sigma + sigma grad psi_a, r is (psi_a (div sigma + f) + y_a, v) on U
/// and -(w_a, q) on Lambda for dis; (-y_lin, v) and
/// -(w_lin, q) for lin, and the same for reg.
template <int dim, int p>
void Patch<dim, p>::assemble_load(CellPart& part, int problem)
{
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  const PreparedCell<dim, p>& cell = *part.prepared;
  const SortedCell<dim>& sorted = cell.sorted;
  const Reference<dim, p>& ref = reference<dim, p>();
  const int o = part.vertex;
  UVector r_u;
  FacetVectors load;
  if (problem == 0)
  {
    r_u = cell.body[o];
    for (int r = 0; r < dim; ++r)
      for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) r_u[r * m + i] += ref.hat[o](i, j) * cell.divergence[r * m + j];
    for (int f = 0; f <= dim; ++f)  // N (psi_a sigma)
      for (int r = 0; r < dim && f != o; ++r)
      {
        std::array<double, m> normal{};
        for (int c = 0; c < dim; ++c)
          for (int j = 0; j < m; ++j) normal[j] -= sorted.grad[f][c] * cell.sigma[(dim * r + c) * m + j];
        const double scale = 1 / std::sqrt(sorted.grad_norm[f]);
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < m; ++j) load(f, r * n + i) += scale * ref.hat_trace[f][o](i, j) * normal[j];
      }
  }
  if (problem == 0 && !cell.rest.empty())
  {
    add_multiple(r_u, 1, divergence_moments<dim, p>(sorted, cell.rest[o]));
    add_normal_traces<dim, p>(sorted, cell.rest[o],
                              [&load](int f, int r, int i) -> double& { return load(f, r * n + i); });
  }
  add_moments(r_u, cell, o, y_[problem], problem == 0 ? 1 : -1);
  cell.op->subtract_load(load, sorted, r_u, w_[problem]);

  FacetVector& outer = part.outer_load[problem];
  std::copy_n(load.row(o), FacetVector::stride, outer.data());
  solve_transposed<S::block>(part.outer->rows.data() + o * FacetVector::stride, Operator::all_facets,
                             part.outer->reciprocal.data(), outer.data());
  subtract_transposed_times<S::block, Operator::all_facets>(load.data(), part.outer->rows.data(),
                                                            Operator::all_facets, outer.data());
  for (int f = 0; f <= dim; ++f)
    if (f != o)
      for (int i = 0; i < S::block; ++i) x_[problem][part.facets[f]][i] += load(f, i);
}

/// Where Gamma_D fixes a component the normal trace is free: its multiplier is 0.
template <int dim, int p>
void Patch<dim, p>::decouple_fixed_components(int facet)
{
  for (int c = 0; c < dim; ++c)
  {
    if (!data_.fixes(facets_[facet].number, c)) continue;
    matrix_.template decouple<S::facet>(facet, c * S::facet);
    for (int problem = 0; problem < n_problems_; ++problem)
      std::fill_n(x_[problem][facet].data() + c * S::facet, S::facet, 0.0);
    for (int i = 0; i < motions_.n_almost(); ++i)
      std::fill_n(almost_rigid_[i][facet].data() + c * S::facet, S::facet, 0.0);
  }
}

/// To multiples of about a millionth of the size. Sizes that differ by rounding must not end on different
/// sides of a power of 2; many are one.
template <int n>
void round_coarsely(DenseVector<n>& x, double size)
{
  const double quantum = std::exp2(std::ilogb(1.2345 * size) - 20);
  for (double& entry : x.entries) entry = quantum * std::nearbyint(entry / quantum);
}

/// Multipliers that are the trace of an admissible rigid motion change nothing: makes the matrix definite by
/// a term on one facet, which the solution, the data being compatible, does not feel. The same for motions
/// that are almost admissible, whose multiples balance_almost_rigid() finds. For the admissible ones any
/// vectors near their traces do: rounded to a few digits those of translated patches, which may share
/// factors, are the same.
template <int dim, int p>
void Patch<dim, p>::fix_rigid_motions()
{
  for (int motion = 0; motion < motions_.size() + motions_.n_almost(); ++motion)
  {
    const int facet = motion < motions_.size() ? static_cast<int>(facets_.size()) - 1 : holding_facet(motion);
    auto& diagonal = matrix_.block(facet, facet);
    double scale = 0;
    for (int i = 0; i < S::block; ++i) scale += diagonal(i, i) / S::block;
    FacetVector free = trace(facet, motion, false);
    if (motion < motions_.size()) round_coarsely(free, std::sqrt(facets_[facet].scale));
    const double square = dot(free, free);
    for (int i = 0; i < S::block; ++i)
      for (int j = 0; j < S::block; ++j) diagonal(i, j) += scale / square * free[i] * free[j];
  }
}

/// The multiplier of the outer facet, and all that goes to the cell.
template <int dim, int p>
void Patch<dim, p>::recover(CellPart& part, int problem)
{
  constexpr int stride = Operator::facet_stride;
  constexpr int row = Operator::all_facets;
  CellShare<dim, p>& share = part.shares[problem];
  const int o = part.vertex;
  double* const outer = share.mu.row(o);
  std::copy_n(part.outer_load[problem].data(), stride, outer);
  for (int f = 0; f <= dim; ++f)
  {
    if (f == o) continue;
    const FacetVector& x = x_[problem][part.facets[f]];
    std::copy_n(x.data(), stride, share.mu.row(f));
    subtract_times<S::block, stride>(outer, part.outer->rows.data() + f * stride, row, x.data());
  }
  solve_upper<S::block>(part.outer->rows.data() + o * stride, row, part.outer->reciprocal.data(), outer);
  share.y = y_[problem];
  share.w = w_[problem];
}

/// The data of the cell problem add up, psi_a to 1.
template <int dim, int p>
StressCoefficients<dim, p> Patch<dim, p>::stress(const PreparedCell<dim, p>& cell,
                                                 const CellShares<CellShare<dim, p>, dim>& shares,
                                                 int problem, const FacetData<dim, p>& data)
{
  UVector r_u;
  if (problem == 0) r_u = cell.divergence;
  Tensor<dim> w = Tensor<dim>::Zero();
  FacetVectors mu;
  for (int a = 0; a <= dim; ++a)
  {
    if (problem == 0) add_multiple(r_u, 1, cell.body[a]);
    if (problem == 0 && !cell.rest.empty())
      add_multiple(r_u, 1, divergence_moments<dim, p>(cell.sorted, cell.rest[a]));
    if (problem > 0 && !data.on_contact(cell.sorted.vertices[a])) continue;
    const CellShare<dim, p>& share = shares[a][problem];
    add_moments(r_u, cell, a, share.y, problem == 0 ? 1 : -1);
    w += share.w;
    add_multiple(mu, 1, share.mu);
  }
  return cell.op->correction(cell.sorted, r_u, w, mu);
}

}  // namespace tribound::certify
