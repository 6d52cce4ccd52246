#include "tribound/fem/polynomials.h"

#include <array>
#include <cassert>
#include <cmath>

namespace tribound::fem
{

namespace
{

/// A function of (a, t) with its partial derivatives.
struct Homogeneous
{
  double value;
  double d_a;
  double d_t;
};

/// t^n P_n^{(alpha,0)}(a/t), a polynomial in a and t also at t = 0, by the three-term recurrence of the
/// Jacobi polynomials made homogeneous (Sherwin and Karniadakis, Int. J. Numer. Meth. Eng. 38, 1995).
Homogeneous scaled_jacobi(int n, double alpha, double a, double t)
{
  Homogeneous previous{1, 0, 0};
  if (n == 0) return previous;
  Homogeneous current{((alpha + 2) * a + alpha * t) / 2, (alpha + 2) / 2, alpha / 2};
  for (int i = 2; i <= n; ++i)
  {
    const double s = 2 * i + alpha;
    const double c = 2 * i * (i + alpha) * (s - 2);
    const double c_a = (s - 1) * s * (s - 2) / c;
    const double c_t = (s - 1) * alpha * alpha / c;
    const double c_2 = 2 * (i + alpha - 1) * (i - 1) * s / c;
    const double factor = c_a * a + c_t * t;
    const Homogeneous next{
        factor * current.value - c_2 * t * t * previous.value,
        c_a * current.value + factor * current.d_a - c_2 * t * t * previous.d_a,
        c_t * current.value + factor * current.d_t - c_2 * t * (2 * previous.value + t * previous.d_t)};
    previous = current;
    current = next;
  }
  return current;
}

/// The basis function of the given degrees: the product over j of scaled Jacobi polynomials of degree
/// degrees[j] with a_j = 2 x_j + x_{j+1} + ... + x_k - 1 and t_j = 1 - x_{j+1} - ... - x_k, normalised.
template <int k>
void evaluate(const std::array<int, k>& degrees, const Point<k>& x, double& value, Point<k>* gradient)
{
  std::array<Homogeneous, k> factor;
  double norm = 1;
  double tail = x.sum();  // x_j + ... + x_k
  for (int j = 0, total = 0; j < k; ++j)
  {
    const double a = tail + x[j] - 1;
    tail -= x[j];
    factor[j] = scaled_jacobi(degrees[j], 2 * total + j, a, 1 - tail);
    total += degrees[j];
    norm *= 2 * total + j + 1;
  }
  norm = std::sqrt(norm);

  value = norm;
  for (int j = 0; j < k; ++j) value *= factor[j].value;
  if (!gradient) return;
  gradient->setZero();
  for (int j = 0; j < k; ++j)
  {
    double others = norm;
    for (int i = 0; i < k; ++i)
      if (i != j) others *= factor[i].value;
    (*gradient)[j] += 2 * others * factor[j].d_a;
    for (int i = j + 1; i < k; ++i) (*gradient)[i] += others * (factor[j].d_a - factor[j].d_t);
  }
}

/// Calls visit(degrees) for every multi-index of total degree <= `degree`, by increasing total degree.
template <int k, class Visit>
void for_each_multi_index(int degree, Visit visit)
{
  for (int total = 0; total <= degree; ++total)
  {
    if constexpr (k == 1) visit(std::array<int, 1>{total});
    if constexpr (k == 2)
      for (int j = 0; j <= total; ++j) visit(std::array<int, 2>{total - j, j});
    if constexpr (k == 3)
      for (int j = 0; j <= total; ++j)
        for (int i = 0; i <= j; ++i) visit(std::array<int, 3>{total - j, j - i, i});
  }
}

}  // namespace

template <int k>
void orthonormal_values(int degree, const Point<k>& x, std::span<double> values)
{
  assert(static_cast<int>(values.size()) == polynomial_dimension(k, degree));
  std::size_t n = 0;
  for_each_multi_index<k>(
      degree, [&](const std::array<int, k>& degrees) { evaluate<k>(degrees, x, values[n++], nullptr); });
}

template <int k>
void orthonormal_gradients(int degree, const Point<k>& x, std::span<double> values,
                           std::span<Point<k>> gradients)
{
  assert(static_cast<int>(values.size()) == polynomial_dimension(k, degree));
  assert(values.size() == gradients.size());
  std::size_t n = 0;
  for_each_multi_index<k>(degree,
                          [&](const std::array<int, k>& degrees)
                          {
                            evaluate<k>(degrees, x, values[n], &gradients[n]);
                            ++n;
                          });
}

template void orthonormal_values<1>(int, const Point<1>&, std::span<double>);
template void orthonormal_values<2>(int, const Point<2>&, std::span<double>);
template void orthonormal_values<3>(int, const Point<3>&, std::span<double>);
template void orthonormal_gradients<1>(int, const Point<1>&, std::span<double>, std::span<Point<1>>);
template void orthonormal_gradients<2>(int, const Point<2>&, std::span<double>, std::span<Point<2>>);
template void orthonormal_gradients<3>(int, const Point<3>&, std::span<double>, std::span<Point<3>>);

}  // namespace tribound::fem
