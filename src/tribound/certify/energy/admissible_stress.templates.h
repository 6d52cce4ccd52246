#pragma once

/// @file admissible_stress.templates.h
/// The definitions of admissible_stress.h and of on_pieces(), only for the kernels
/// (certify/energy/kernel.cpp.in).

#include <cassert>
#include <cmath>

#include "tribound/certify/energy/admissible_stress.h"
#include "tribound/certify/energy/alfeld_reference.h"
#include "tribound/certify/equilibrate/cell_operator.h"

namespace tribound::certify
{

namespace detail
{

/// Coefficients on the cell, function by function; see symmetric_vector() for the components.
template <int dim, int q>
using SymmetricCoefficients = Dense<AlfeldSizes<dim, q>::scalar, AlfeldSizes<dim, q>::components>;

/// Adds a multiple of the symmetric part of a stress with coefficients as in on_pieces().
template <int dim, int q>
void add_symmetric_part(SymmetricCoefficients<dim, q>& sum, double factor, std::span<const double> stress)
{
  const auto n = static_cast<int>(stress.size()) / (dim * dim);
  assert(n <= (AlfeldSizes<dim, q>::scalar));
  for (int a = 0; a < AlfeldSizes<dim, q>::components; ++a)
  {
    const auto [r, c] = symmetric_pairs<dim>[a];
    const double half = factor * (r == c ? 0.5 : M_SQRT1_2);
    const double* const one = &stress[(dim * r + c) * n];
    const double* const other = &stress[(dim * c + r) * n];
    for (int j = 0; j < n; ++j) sum(j, a) += half * (one[j] + other[j]);
  }
}

template <int dim, int q>
[[nodiscard]] PiecewiseStress<dim, q> minus_on_pieces(const SymmetricCoefficients<dim, q>& coefficients)
{
  using S = AlfeldSizes<dim, q>;
  const auto& restriction = alfeld_reference<dim, q>().restriction;
  PiecewiseStress<dim, q> result;
  subtract_transposed_product<S::components, padded(S::functions), S::scalar>(
      result.data(), result.stride, coefficients.data(), coefficients.stride, restriction.data(),
      restriction.stride);
  return result;
}

/// sum += A x, where A acts on the components.
template <class Matrix, int rows, int cols>
void add_mapped(Dense<rows, cols>& sum, const Matrix& a, const Dense<rows, cols>& x)
{
  for (int r = 0; r < rows; ++r)
    for (int j = 0; j < sum.stride; j += lanes)
    {
      Lanes row = lanes_at(sum.row(r) + j);
      for (int c = 0; c < rows; ++c) row += a(r, c) * lanes_at(x.row(c) + j);
      lanes_at(sum.row(r) + j) = row;
    }
}

/// -w^ with w^ = J^{-1} w J^{-T}, w the skew part of a stress without its mean; ordered by pairs and
/// functions as in alfeld_factors().
template <int dim, int q>
[[nodiscard]] DenseVector<AlfeldSizes<dim, q>::rotation> minus_skew_part(const Tensor<dim>& inverse,
                                                                         std::span<const double> stress)
{
  using S = AlfeldSizes<dim, q>;
  DenseVector<S::rotation> result;
  for (int to = 0; to < S::pairs; ++to)
    for (int from = 0; from < S::pairs; ++from)
    {
      const auto [a, b] = skew_pairs<dim>[to];
      const auto [r, c] = skew_pairs<dim>[from];
      const double half = 0.5 * (inverse(a, r) * inverse(b, c) - inverse(a, c) * inverse(b, r));
      const double* const above = &stress[(dim * r + c) * S::scalar];
      const double* const below = &stress[(dim * c + r) * S::scalar];
      double* const target = &result[to * (S::scalar - 1)];
      for (int j = 1; j < S::scalar; ++j) target[j - 1] -= half * (above[j] - below[j]);
    }
  return result;
}

/// ||w_0||_T.
template <int dim>
[[nodiscard]] double mean_skew_part(std::span<const double> stress)
{
  const std::size_t n = stress.size() / (dim * dim);
  double sum = 0;
  for (const auto& [r, c] : skew_pairs<dim>)
    sum += std::pow(stress[(dim * r + c) * n] - stress[(dim * c + r) * n], 2) / 2;
  return std::sqrt(sum);
}

}  // namespace detail

template <int dim, int q>
PiecewiseStress<dim, q> on_pieces(std::span<const double> stress)
{
  detail::SymmetricCoefficients<dim, q> coefficients;
  detail::add_symmetric_part<dim, q>(coefficients, -1, stress);
  return detail::minus_on_pieces<dim, q>(coefficients);
}

template <int dim, int q>
AdmissibleStress<dim, q> AdmissibleStressSolver<dim, q>::solve(const SortedCell<dim>& cell,
                                                               const problem::Material& material,
                                                               std::span<const double> sigma_h,
                                                               std::span<const double> sigma_v)
{
  assert(sigma_h.size() == std::size_t(dim) * dim * S::scalar);
  const AlfeldReference<dim, q>& reference = alfeld_reference<dim, q>();
  detail::SymmetricCoefficients<dim, q> negative;
  detail::add_symmetric_part<dim, q>(negative, -1, sigma_h);
  detail::add_symmetric_part<dim, q>(negative, 1, sigma_v);

  Metric map;
  for (int a = 0; a < S::components; ++a)
  {
    const Tensor<dim> unit = symmetric_tensor<dim>(SymmetricVector<dim>::Unit(a));
    map.col(a) = symmetric_vector<dim>(cell.jacobian * unit * cell.jacobian.transpose());
  }
  AdmissibleStress<dim, q> result;
  result.difference = detail::minus_on_pieces<dim, q>(negative);
  const auto skew = detail::minus_skew_part<dim, q>(cell.inverse, sigma_h);
  PiecewiseStress<dim, q> lifted;
  subtract_transposed_product<1, S::flat, S::rotation>(lifted.data(), S::flat, skew.data(), 1,
                                                       reference.lifting.data(), reference.lifting.stride);
  detail::add_mapped(result.difference, map, lifted);
  minimise(map, compliance<dim>(material), result.difference);
  result.square = compliance_product(material, result.difference, result.difference);
  result.unbalanced = detail::mean_skew_part<dim>(sigma_h);
  return result;
}

template <int dim, int q>
void AdmissibleStressSolver<dim, q>::minimise(const Metric& map, const Metric& compliance,
                                              PiecewiseStress<dim, q>& difference)
{
  if constexpr (S::kernel > 0)  // q > 1
  {
    const auto& kernel = alfeld_reference<dim, q>().kernel;
    if (!factor(map.transpose() * compliance * map)) return;

    const Metric to_products = map.transpose() * compliance;
    PiecewiseStress<dim, q> product;
    detail::add_mapped(product, to_products, difference);
    DenseVector<S::kernel> alpha;
    subtract_times<S::kernel, S::flat>(alpha.data(), kernel.data(), kernel.stride, product.data());
    solve_transposed<S::kernel>(gram_.data(), gram_.stride, reciprocal_.data(), alpha.data());
    solve_upper<S::kernel>(gram_.data(), gram_.stride, reciprocal_.data(), alpha.data());

    PiecewiseStress<dim, q> correction;  // -sum_k alpha_k K_k
    subtract_transposed_product<1, S::flat, S::kernel>(correction.data(), S::flat, alpha.data(), 1,
                                                       kernel.data(), kernel.stride);
    const Metric back = -map;
    detail::add_mapped(difference, back, correction);
  }
}

template <int dim, int q>
bool AdmissibleStressSolver<dim, q>::factor(const Metric& metric)
{
  const SymmetricVector<dim> sizes = metric_.diagonal().cwiseSqrt();
  if (((metric - metric_).cwiseAbs() - same * sizes * sizes.transpose()).maxCoeff() <= 0) return is_definite_;
  metric_ = metric;
  constexpr int n = AlfeldReference<dim, q>::n_products;
  const auto& products = alfeld_reference<dim, q>().products;
  std::array<double, n> factors;
  for (int a = 0, m = 0; a < S::components; ++a)
    for (int b = a; b < S::components; ++b) factors[m++] = metric(a, b);
  for (int k = 0; k < S::kernel; ++k)
    for (int j = k / lanes * lanes; j < gram_.stride; j += lanes)  // the upper triangle
    {
      Lanes sum{};
      for (int m = 0; m < n; ++m) sum += factors[m] * lanes_at(products.row(k * n + m) + j);
      lanes_at(gram_.row(k) + j) = sum;
    }
  if constexpr (S::kernel > 0)
    is_definite_ = cholesky<S::kernel>(gram_.data(), gram_.stride, reciprocal_.data());
  return is_definite_;
}

}  // namespace tribound::certify
