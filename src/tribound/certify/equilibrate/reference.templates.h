#pragma once

/// @file reference.templates.h
/// The definitions of reference.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include "tribound/certify/equilibrate/reference.h"

#include <algorithm>

#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace detail
{

/// [j * n + l], n = dim P^p: the coefficient on phi_l, in the coordinates of the sorted cell, of the Lagrange
/// basis function of node j of the unsorted one; local[i] is the position of sorted vertex i in the unsorted
/// cell.
template <int dim>
[[nodiscard]] std::vector<double> nodal_coefficients(const fem::LagrangeBasis<dim>& basis,
                                                     const std::array<int, dim + 1>& local);

/// Fills the matrices that are integrals over the reference cell.
template <int dim, int p>
void integrate_cell(Reference<dim, p>& r)
{
  using S = Sizes<dim, p>;
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * p);
  std::vector<double> values(S::stress);
  std::vector<Point<dim>> gradients(S::stress);
  for (int q = 0; q < rule.size(); ++q)
  {
    fem::orthonormal_gradients<dim>(p, rule.points[q], values, gradients);
    const auto lambda = fem::barycentric<dim>(rule.points[q]);
    for (int i = 0; i < S::multiplier; ++i)
    {
      const double weight = rule.weights[q] * values[i];
      for (int j = 0; j < S::stress; ++j)
        for (int k = 0; k < dim; ++k) r.derivative[k](i, j) += weight * gradients[j][k];
      for (int a = 0; a <= dim; ++a)
      {
        r.hat_moment(i, a) += weight * lambda[a];
        for (int j = 0; j < S::multiplier; ++j) r.hat[a](i, j) += weight * lambda[a] * values[j];
      }
    }
  }
}

/// Fills the matrices that are integrals over the reference facets.
template <int dim, int p>
void integrate_facets(Reference<dim, p>& r)
{
  using S = Sizes<dim, p>;
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * p);
  std::vector<double> values(S::stress);
  std::vector<double> theta(S::facet);
  for (int q = 0; q < rule.size(); ++q)
  {
    fem::orthonormal_values<dim - 1>(p, rule.points[q], theta);
    const auto on_facet = fem::barycentric<dim - 1>(rule.points[q]);
    for (int i = 0; i < S::facet; ++i)
      for (int v = 0; v < dim; ++v) r.facet_hat_moment(i, v) += rule.weights[q] * theta[i] * on_facet[v];
    for (int f = 0; f <= dim; ++f)
    {
      const Point<dim> x = mesh::facet_to_cell<dim>(f, rule.points[q]);
      fem::orthonormal_values<dim>(p, x, values);
      auto lambda = fem::barycentric<dim>(x);
      lambda[f] = 0;  // exactly
      for (int i = 0; i < S::facet; ++i)
      {
        const double weight = rule.weights[q] * theta[i];
        for (int j = 0; j < S::stress; ++j) r.trace[f](i, j) += weight * values[j];
        for (int a = 0; a <= dim; ++a)
          for (int j = 0; j < S::multiplier; ++j) r.hat_trace[f][a](i, j) += weight * lambda[a] * values[j];
      }
    }
  }
}

/// Coefficients of reference derivatives of the nodal basis, for every numbering of the vertices.
template <int dim, int p>
void differentiate_nodal_basis(Reference<dim, p>& r)
{
  using S = Sizes<dim, p>;
  constexpr int n = S::stress;
  const fem::LagrangeBasis<dim> basis(p);
  std::array<int, dim + 1> local;
  for (int i = 0; i <= dim; ++i) local[i] = i;
  do
  {
    const std::vector<double> coefficients = nodal_coefficients(basis, local);
    auto& derivative = r.nodal_derivative.emplace_back();
    for (int k = 0; k < dim; ++k)
      for (int i = 0; i < S::multiplier; ++i)
        for (int j = 0; j < n; ++j)
          for (int l = 0; l < n; ++l) derivative[k](j, i) += r.derivative[k](i, l) * coefficients[j * n + l];
  } while (std::next_permutation(local.begin(), local.end()));
}

/// The first columns of a matrix.
template <int n, int rows, int cols>
Dense<rows, n> truncated(const Dense<rows, cols>& matrix)
{
  Dense<rows, n> result;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < n; ++j) result(i, j) = matrix(i, j);
  return result;
}

/// A B^T - A' B'^T / 2 and A' B'^T / 2, the prime standing for the first n columns.
template <int n, int rows, int cols, int inner>
void multiply(const Dense<rows, inner>& a, const Dense<cols, inner>& b, Dense<rows, cols>& product,
              Dense<rows, cols>& half_truncated)
{
  half_truncated = Dense<rows, cols>{};
  add_multiple(half_truncated, 0.5, times_transposed(truncated<n>(a), truncated<n>(b)));
  product = times_transposed(a, b);
  add_multiple(product, -1.0, half_truncated);
}

}  // namespace detail

template <int dim, int p>
Reference<dim, p>::Reference()
{
  detail::integrate_cell(*this);
  detail::integrate_facets(*this);
  constexpr int m = S::multiplier;
  for (int k = 0; k < dim; ++k)
  {
    for (int f = 0; f <= dim; ++f)
      detail::multiply<m>(derivative[k], trace[f], coupling[k][f], truncated_coupling[k][f]);
    for (int l = 0; l < dim; ++l)
      detail::multiply<m>(derivative[k], derivative[l], divergence[k][l], truncated_divergence[k][l]);
  }
  for (int f = 0; f <= dim; ++f)
    for (int g = 0; g <= dim; ++g)
      detail::multiply<m>(trace[f], trace[g], schur[f][g], truncated_schur[f][g]);
  detail::differentiate_nodal_basis(*this);
}

template <int dim, int p>
const Reference<dim, p>& reference()
{
  static const Reference<dim, p> instance;
  return instance;
}

}  // namespace tribound::certify
