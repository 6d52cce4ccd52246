#pragma once

/// @file patch_compatibility.templates.h
/// What makes the data of a patch compatible: its rigid motions Z_a, y_a and w_a.

#include <algorithm>

#include "tribound/certify/equilibrate/patch.h"

namespace tribound::certify
{

template <int dim, int p>
void Patch<dim, p>::make_compatible()
{
  find_rigid_motions();
  const Moments moments = integrate();
  find_divergence_part(moments);
  w_.fill(Tensor<dim>::Zero());
  if constexpr (p == 1) find_skew_part(moments);
}

template <int dim, int p>
void Patch<dim, p>::find_rigid_motions()
{
  fixed_facets_.clear();
  for (const auto& [facet, scale] : facets_)
  {
    if (!data_.is_boundary(facet) || !data_.fixes_any(facet)) continue;
    FixedFacet<dim>& fixed = fixed_facets_.emplace_back();
    for (int v = 0; v < dim; ++v) fixed.vertices[v] = mesh_.vertex(mesh_.topology().facets[facet][v]);
    for (int c = 0; c < dim; ++c) fixed.fixed[c] = data_.fixes(facet, c);
  }
  double size = 0;  // the largest height of a cell above the vertex
  for (int k = 0; k < n_cells_; ++k)
    size = std::max(size, 1 / cells_[k].prepared->sorted.grad_norm[cells_[k].vertex]);
  motions_ = RigidMotions<dim>(mesh_.vertex(vertex_), size, fixed_facets_);
}

/// (-psi_a f + sigma(u^k) grad psi_a, v)_T for v in U.
template <int dim, int p>
auto Patch<dim, p>::raw_load(const CellPart& part) const -> UVector
{
  constexpr int m = S::multiplier;
  const PreparedCell<dim, p>& cell = *part.prepared;
  const Point<dim>& gradient = cell.sorted.grad[part.vertex];
  UVector load;
  for (int r = 0; r < dim; ++r)
    for (int j = 0; j < m; ++j)
    {
      load[r * m + j] = -cell.body[part.vertex][r * m + j];
      for (int c = 0; c < dim; ++c) load[r * m + j] += gradient[c] * cell.sigma[(dim * r + c) * m + j];
    }
  return load;
}

template <int dim, int p>
auto Patch<dim, p>::integrate() const -> Moments
{
  constexpr int n = S::affine;
  Moments sum{Point<dim>::Zero(), Tensor<dim>::Zero(), 0, Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (int k = 0; k < n_cells_; ++k)
  {
    const PreparedCell<dim, p>& cell = *cells_[k].prepared;
    const UVector load = raw_load(cells_[k]);
    const Point<dim> edge = edge_to(cell.sorted, cells_[k].vertex);
    auto x = cell.coordinates;
    for (int d = 0; d < dim; ++d) x[d][0] -= edge[d] * cell.one;
    sum.volume += cell.one * cell.one;
    for (int c = 0; c < dim; ++c)
    {
      sum.load[c] += cell.one * load[c * S::multiplier];
      sum.position[c] += cell.one * x[c][0];
      for (int d = 0; d < dim; ++d)
        for (int j = 0; j < n; ++j)
        {
          sum.load_position(c, d) += load[c * S::multiplier + j] * x[d][j];
          sum.position_position(c, d) += x[c][j] * x[d][j];
        }
    }
  }
  return sum;
}

/// (t, z) over the facets of the patch.
template <int dim, int p>
double Patch<dim, p>::traction_work(int problem, int motion) const
{
  double work = 0;
  for (std::size_t i = 0; i < facets_.size(); ++i)
    if (const auto* t = traction(facets_[i].number, problem))
    {
      const FacetVector z = moments_on_facet(static_cast<int>(i), motion);
      for (int k = 0; k < S::block; ++k) work += (*t)[k] * z[k];
    }
  return work;
}

/// The Gram matrix of the first n motions, those after them put in place of by unit vectors.
template <int dim, int p>
auto Patch<dim, p>::motion_gram(const Moments& moments, int n) const -> Dense<S::rigid, S::rigid>
{
  Dense<S::rigid, S::rigid> gram;
  for (int i = 0; i < S::rigid; ++i) gram(i, i) = 1;
  for (int i = 0; i < n; ++i)
  {
    const auto& [translation, gradient] = motions_[i];
    for (int j = i; j < n; ++j)
    {
      const auto& [other_translation, other_gradient] = motions_[j];
      gram(i, j) = moments.volume * translation.dot(other_translation) +
                   translation.dot(other_gradient * moments.position) +
                   other_translation.dot(gradient * moments.position) +
                   (gradient * moments.position_position).cwiseProduct(other_gradient).sum();
    }
  }
  return gram;
}

/// y_a with (y_lin, z) = (t^k - T_delta(u^k), psi_a z)_C for the lin problem and (y_reg, z) =
/// (T_delta(u^k) - T(u^k), psi_a z)_C for the reg problem, for z in Z_a (rigid motions; constants for p = 1)
/// and almost admissible rotations; y_a = y_lin + y_reg - rho_a for the dis problem with rho_a in Z_a, (y_a,
/// z) = -<R(u^k), psi_a z> = (b, z) - (t, z) for z in Z_a: rho_a = 0 if a(u^k, v) - (t^k, v)_C = L(v).
template <int dim, int p>
void Patch<dim, p>::find_divergence_part(const Moments& moments)
{
  y_.fill({Point<dim>::Zero(), Tensor<dim>::Zero()});
  const int n_admissible = p == 1 ? motions_.n_translations() : motions_.size();
  const int n = p == 1 ? n_admissible : n_admissible + motions_.n_almost();
  if (n == 0) return;
  std::array<RigidVector, max_problems> y{};
  for (int i = 0; i < n; ++i)
    for (int problem = 1; problem < n_problems_; ++problem) y[problem][i] = traction_work(problem, i);
  for (int i = 0; i < n_admissible; ++i)
  {
    const auto& [translation, gradient] = motions_[i];
    y[0][i] = translation.dot(moments.load) + gradient.cwiseProduct(moments.load_position).sum() -
              traction_work(0, i) - y[1][i] - y[2][i];
  }
  Dense<S::rigid, S::rigid> gram = motion_gram(moments, n);
  RigidVector reciprocal;
  if (!cholesky<S::rigid>(gram.data(), gram.stride, reciprocal.data())) throw failure();
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    solve_transposed<S::rigid>(gram.data(), gram.stride, reciprocal.data(), y[problem].data());
    if (problem == 0) std::fill(y[0].begin() + n_admissible, y[0].end(), 0.0);  // its part in Z_a alone
    solve_upper<S::rigid>(gram.data(), gram.stride, reciprocal.data(), y[problem].data());
    for (int i = 0; i < n; ++i)
    {
      y_[problem].translation += y[problem][i] * motions_[i].translation;
      y_[problem].gradient += y[problem][i] * motions_[i].gradient;
    }
  }
  for (int problem = 1; problem < n_problems_; ++problem)
  {
    y_[0].translation += y_[problem].translation;
    y_[0].gradient += y_[problem].gradient;
  }
}

/// (psi_a sigma(u^k) n, z) in the fixed components of the facets of Gamma_D around the vertex, for p = 1 and
/// a rotation z about it: with z linear and 0 in a, (psi_a, z_r)_F = |F| sum_{b in F} z_r(b) / (dim (dim +
/// 1)).
template <int dim, int p>
double Patch<dim, p>::reaction_work(int motion) const
{
  double work = 0;
  for (int k = 0; k < n_cells_; ++k)
    for (int f = 0; f <= dim; ++f)
    {
      if (cells_[k].facets[f] < 0) continue;
      const Index facet = facets_[cells_[k].facets[f]].number;
      if (!data_.is_boundary(facet) || !data_.fixes_any(facet)) continue;
      const PreparedCell<dim, p>& cell = *cells_[k].prepared;
      Point<dim> z = Point<dim>::Zero();
      for (const Index v : mesh_.topology().facets[facet]) z += motions_(motion, mesh_.vertex(v));
      for (int r = 0; r < dim; ++r)
      {
        if (!data_.fixes(facet, r)) continue;
        double normal = 0;  // |F| n = -dim |T| grad lambda_f, and the moment of sigma is |T|^{1/2} sigma
        for (int c = 0; c < dim; ++c) normal -= cell.sigma[dim * r + c] * cell.sorted.grad[f][c];
        work += cell.one * normal * z[r] / (dim + 1);
      }
    }
  return work;
}

/// w_a for p = 1: in the span of grad z of the rotations z that are admissible or almost so, with
/// (w_a, grad z) = (t, z)_{N, C} - (Pi^0 b, z), for dis plus (psi_a sigma(u^k) n, z)_D.
template <int dim, int p>
void Patch<dim, p>::find_skew_part(const Moments& moments)
{
  const int n = motions_.n_rotations() + motions_.n_almost();
  if (n == 0) return;
  const int first = motions_.n_translations();
  using Gram = Eigen::Matrix<double, S::pairs, S::pairs>;
  Gram gram = Gram::Identity();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      gram(i, j) =
          moments.volume * motions_[first + i].gradient.cwiseProduct(motions_[first + j].gradient).sum();
  const Gram inverse = gram.inverse();
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    // (Pi^0 b, z), z = grad z x: b is the load of dis without y_a, y_lin,a in lin and y_reg,a in reg
    const Tensor<dim> y = y_[problem].translation * moments.position.transpose();
    const Tensor<dim> b = problem == 0 ? Tensor<dim>(moments.load_position - y) : y;
    Eigen::Matrix<double, S::pairs, 1> rhs = Eigen::Matrix<double, S::pairs, 1>::Zero();
    for (int i = 0; i < n; ++i)
      rhs[i] = traction_work(problem, first + i) - b.cwiseProduct(motions_[first + i].gradient).sum();
    for (int i = motions_.n_rotations(); i < n && problem == 0; ++i) rhs[i] += reaction_work(first + i);
    for (int i = 0; i < n; ++i) w_[problem] += inverse.row(i).dot(rhs) * motions_[first + i].gradient;
  }
}

}  // namespace tribound::certify
