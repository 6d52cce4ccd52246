#pragma once

/// @file alfeld_reference.templates.h
/// The definitions of alfeld_reference.h, only for the kernels (certify/energy/kernel.cpp.in).

#include <algorithm>

#include "tribound/certify/energy/alfeld_reference.h"

namespace tribound::certify
{

namespace detail
{

/// Copies a stress into a row; each component starts at a vector boundary of the kernels.
template <int dim, int q>
void spread(const double* stress, double* row)
{
  using S = AlfeldSizes<dim, q>;
  for (int a = 0; a < S::components; ++a)
    std::copy_n(stress + a * S::functions, S::functions, row + a * padded(S::functions));
}

template <int dim, int q>
void multiply_kernel(AlfeldReference<dim, q>& r)
{
  using S = AlfeldSizes<dim, q>;
  constexpr int stride = padded(S::functions);
  const auto product = [&](int k, int a, int l, int b)
  {
    double sum = 0;
    for (int m = 0; m < S::functions; ++m) sum += r.kernel(k, a * stride + m) * r.kernel(l, b * stride + m);
    return sum;
  };
  for (int k = 0; k < S::kernel; ++k)
    for (int l = 0; l < S::kernel; ++l)
    {
      int row = k * AlfeldReference<dim, q>::n_products;
      for (int a = 0; a < S::components; ++a)
        for (int b = a; b < S::components; ++b)
          r.products(row++, l) = product(k, a, l, b) + (a == b ? 0 : product(k, b, l, a));
    }
}

}  // namespace detail

template <int dim, int q>
AlfeldReference<dim, q>::AlfeldReference()
{
  const AlfeldFactors factors = alfeld_factors<dim>(q);
  for (int j = 0; j < S::scalar; ++j)
    std::copy_n(factors.restriction.data() + j * S::functions, S::functions, restriction.row(j));
  for (int k = 0; k < S::kernel; ++k)
    detail::spread<dim, q>(factors.kernel.data() + k * S::unknowns, kernel.row(k));
  for (int k = 0; k < S::rotation; ++k)
    detail::spread<dim, q>(factors.lifting.data() + k * S::unknowns, lifting.row(k));
  detail::multiply_kernel(*this);
}

template <int dim, int q>
const AlfeldReference<dim, q>& alfeld_reference()
{
  static const AlfeldReference<dim, q> instance;
  return instance;
}

}  // namespace tribound::certify
