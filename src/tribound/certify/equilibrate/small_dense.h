#pragma once

/// @file small_dense.h
/// Kernels for the small dense matrices of cells and patches. Sizes are known at compile time and rows start
/// at vector boundaries, so that the inner loops are a few vector instructions without remainders. A matrix
/// is given by its first entry and the distance of its rows; see docs/decisions.md for why these are not
/// Eigen's.

#include <algorithm>
#include <array>
#include <cmath>

namespace tribound::certify
{

/// Doubles of a vector; the compiler splits or joins them where the processor's registers have another width.
inline constexpr int lanes = 4;
using Lanes [[gnu::vector_size(lanes * sizeof(double)), gnu::may_alias]] = double;

/// Length of a row with n entries in memory.
[[nodiscard]] constexpr int padded(int n)
{
  return (n + lanes - 1) / lanes * lanes;
}

/// Row by row; what fills up the rows is 0.
template <int n_rows, int n_cols>
struct Dense
{
  static constexpr int rows = n_rows;
  static constexpr int cols = n_cols;
  static constexpr int stride = padded(n_cols);

  [[nodiscard]] double& operator()(int i, int j) { return entries[i * stride + j]; }
  [[nodiscard]] double operator()(int i, int j) const { return entries[i * stride + j]; }
  [[nodiscard]] double* row(int i) { return entries.data() + i * stride; }
  [[nodiscard]] const double* row(int i) const { return entries.data() + i * stride; }
  [[nodiscard]] double* data() { return entries.data(); }
  [[nodiscard]] const double* data() const { return entries.data(); }

  alignas(lanes * sizeof(double)) std::array<double, static_cast<std::size_t>(n_rows) * stride> entries{};
};

template <int n>
struct DenseVector : Dense<1, n>
{
  [[nodiscard]] double& operator[](int i) { return this->entries[i]; }
  [[nodiscard]] double operator[](int i) const { return this->entries[i]; }
};

[[nodiscard]] inline Lanes& lanes_at(double* x)
{
  return *reinterpret_cast<Lanes*>(x);
}
[[nodiscard]] inline const Lanes& lanes_at(const double* x)
{
  return *reinterpret_cast<const Lanes*>(x);
}

/// y += a x, entry by entry.
template <int rows, int cols>
void add_multiple(Dense<rows, cols>& y, double a, const Dense<rows, cols>& x)
{
  for (int i = 0; i < rows * Dense<rows, cols>::stride; i += lanes)
    lanes_at(y.data() + i) += a * lanes_at(x.data() + i);
}

template <int n>
[[nodiscard]] double dot(const DenseVector<n>& x, const DenseVector<n>& y)
{
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

/// A B^T.
template <int rows, int cols, int inner>
[[nodiscard]] Dense<rows, cols> times_transposed(const Dense<rows, inner>& a, const Dense<cols, inner>& b)
{
  Dense<rows, cols> result;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < cols; ++j)
      for (int k = 0; k < inner; ++k) result(i, j) += a(i, k) * b(j, k);
  return result;
}

/// C -= A^T B for a tile of C that fits into registers: rows x (vectors * lanes); A and B have k rows.
template <int rows, int vectors, int k>
void subtract_tile(double* c, int c_stride, const double* a, int a_stride, const double* b, int b_stride)
{
  Lanes sum[rows][vectors];
#pragma GCC unroll 16
  for (int i = 0; i < rows; ++i)
#pragma GCC unroll 16
    for (int j = 0; j < vectors; ++j) sum[i][j] = lanes_at(c + i * c_stride + j * lanes);
  for (int l = 0; l < k; ++l)
  {
#pragma GCC unroll 16
    for (int i = 0; i < rows; ++i)
    {
      const double factor = a[l * a_stride + i];
#pragma GCC unroll 16
      for (int j = 0; j < vectors; ++j) sum[i][j] -= factor * lanes_at(b + l * b_stride + j * lanes);
    }
  }
#pragma GCC unroll 16
  for (int i = 0; i < rows; ++i)
#pragma GCC unroll 16
    for (int j = 0; j < vectors; ++j) lanes_at(c + i * c_stride + j * lanes) = sum[i][j];
}

/// The same for a strip of C of any height. Tiles of 12 vectors leave room for the factors where there are 16
/// registers.
template <int n, int vectors, int k>
void subtract_strip(double* c, int c_stride, const double* a, int a_stride, const double* b, int b_stride)
{
  constexpr int height = std::min(n, 12 / vectors);
  constexpr int rest = n % height;
  for (int i = 0; i < n - rest; i += height)
    subtract_tile<height, vectors, k>(c + i * c_stride, c_stride, a + i, a_stride, b, b_stride);
  if constexpr (rest > 0)
    subtract_tile<rest, vectors, k>(c + (n - rest) * c_stride, c_stride, a + n - rest, a_stride, b, b_stride);
}

/// C -= A^T B with C n x m, A k x n and B k x m; m is a multiple of `lanes`.
template <int n, int m, int k>
void subtract_transposed_product(double* c, int c_stride, const double* a, int a_stride, const double* b,
                                 int b_stride)
{
  constexpr int vectors = m / lanes;
  constexpr int width = std::min(vectors, 2);
  constexpr int rest = vectors % width;
  for (int j = 0; j < (vectors - rest) * lanes; j += width * lanes)
    subtract_strip<n, width, k>(c + j, c_stride, a, a_stride, b + j, b_stride);
  if constexpr (rest > 0)
    subtract_strip<n, rest, k>(c + (vectors - rest) * lanes, c_stride, a, a_stride,
                               b + (vectors - rest) * lanes, b_stride);
}

/// The upper triangle of C -= A^T A with C n x n and A k x n, from column `first` on, a multiple of `lanes`;
/// below the diagonal C is undefined then.
template <int n, int k, int first = 0>
void subtract_gram(double* c, const double* a, int stride)
{
  constexpr int vectors = std::min(2, (padded(n) - first) / lanes);
  constexpr int next = first + vectors * lanes;
  subtract_strip<std::min(n, next), vectors, k>(c + first, stride, a, stride, a + first, stride);
  if constexpr (next < n) subtract_gram<n, k, next>(c, a, stride);
}

/// A = U^T U, U taking the place of the upper triangle of A, the only part that is read. reciprocal[i] = 1 /
/// U(i, i). False if A is not positive definite. Row by row: what is stored as a vector is not read before
/// the next row needs it.
template <int n>
[[nodiscard]] bool cholesky(double* a, int stride, double* reciprocal)
{
  constexpr int vectors = padded(n) / lanes;
  for (int i = 0; i < n; ++i)
  {
    Lanes row[vectors];
#pragma GCC unroll 16
    for (int j = 0; j < vectors; ++j) row[j] = lanes_at(a + i * stride + j * lanes);
    double pivot = a[i * stride + i];
    for (int k = 0; k < i; ++k)
    {
      const double factor = a[k * stride + i];
      pivot -= factor * factor;
#pragma GCC unroll 16
      for (int j = 0; j < vectors; ++j) row[j] -= factor * lanes_at(a + k * stride + j * lanes);
    }
    if (!(pivot > 0)) return false;
    reciprocal[i] = 1 / std::sqrt(pivot);
#pragma GCC unroll 16
    for (int j = 0; j < vectors; ++j) lanes_at(a + i * stride + j * lanes) = reciprocal[i] * row[j];
  }
  return true;
}

/// B = U^{-T} B for `vectors` columns of lanes, which fit into registers.
template <int n, int vectors>
void solve_transposed_strip(const double* u, int u_stride, const double* reciprocal, double* b, int b_stride)
{
  for (int i = 0; i < n; ++i)
  {
    Lanes sum[vectors];
#pragma GCC unroll 16
    for (int j = 0; j < vectors; ++j) sum[j] = lanes_at(b + i * b_stride + j * lanes);
    for (int k = 0; k < i; ++k)
    {
      const double factor = u[k * u_stride + i];
#pragma GCC unroll 16
      for (int j = 0; j < vectors; ++j) sum[j] -= factor * lanes_at(b + k * b_stride + j * lanes);
    }
#pragma GCC unroll 16
    for (int j = 0; j < vectors; ++j) lanes_at(b + i * b_stride + j * lanes) = reciprocal[i] * sum[j];
  }
}

/// B = U^{-T} B with B n x m; m is a multiple of `lanes`.
template <int n, int m>
void solve_transposed(const double* u, int u_stride, const double* reciprocal, double* b, int b_stride)
{
  constexpr int vectors = m / lanes;
  constexpr int width = std::min(vectors, 8);
  constexpr int rest = vectors % width;
  for (int j = 0; j < (vectors - rest) * lanes; j += width * lanes)
    solve_transposed_strip<n, width>(u, u_stride, reciprocal, b + j, b_stride);
  if constexpr (rest > 0)
    solve_transposed_strip<n, rest>(u, u_stride, reciprocal, b + (vectors - rest) * lanes, b_stride);
}

/// x = U^{-T} x, column by column of U^T: sums of all entries go on together.
template <int n>
void solve_transposed(const double* u, int stride, const double* reciprocal, double* x)
{
  DenseVector<n> rest;
  std::copy_n(x, n, rest.data());
  for (int i = 0; i < n; ++i)
  {
    x[i] = reciprocal[i] * rest[i];
    for (int j = (i + 1) / lanes * lanes; j < padded(n); j += lanes)
      lanes_at(rest.data() + j) -= x[i] * lanes_at(u + i * stride + j);
  }
}

/// x = U^{-1} x.
template <int n>
void solve_upper(const double* u, int stride, const double* reciprocal, double* x)
{
  for (int i = n - 1; i >= 0; --i)
  {
    x[i] *= reciprocal[i];
    for (int j = 0; j < i; ++j) x[j] -= u[j * stride + i] * x[i];
  }
}

/// B = U^{-1} B with B n x m; m is a multiple of `lanes`.
template <int n, int m>
void solve_upper(const double* u, int u_stride, const double* reciprocal, double* b, int b_stride)
{
  for (int i = n - 1; i >= 0; --i)
    for (int j = 0; j < m; j += lanes)
    {
      Lanes sum = lanes_at(b + i * b_stride + j);
      for (int k = i + 1; k < n; ++k) sum -= u[i * u_stride + k] * lanes_at(b + k * b_stride + j);
      lanes_at(b + i * b_stride + j) = reciprocal[i] * sum;
    }
}

/// C -= A B with C n x m, A n x k and B k x m; m is a multiple of `lanes`.
template <int n, int m, int k>
void subtract_product(double* c, int c_stride, const double* a, int a_stride, const double* b, int b_stride)
{
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; j += lanes)
    {
      Lanes sum = lanes_at(c + i * c_stride + j);
      for (int l = 0; l < k; ++l) sum -= a[i * a_stride + l] * lanes_at(b + l * b_stride + j);
      lanes_at(c + i * c_stride + j) = sum;
    }
}

/// y -= A^T x with A k x m; m is a multiple of `lanes`.
template <int k, int m>
void subtract_transposed_times(double* y, const double* a, int stride, const double* x)
{
  constexpr int vectors = m / lanes;
  constexpr int width = std::min(vectors, 8);
  constexpr int rest = vectors % width;
  for (int j = 0; j < (vectors - rest) * lanes; j += width * lanes)
    subtract_tile<1, width, k>(y + j, 0, x, 1, a + j, stride);
  if constexpr (rest > 0)
    subtract_tile<1, rest, k>(y + (vectors - rest) * lanes, 0, x, 1, a + (vectors - rest) * lanes, stride);
}

/// y -= A x with A k x m; m is a multiple of `lanes`, and what fills up A and x is 0.
template <int k, int m>
void subtract_times(double* y, const double* a, int stride, const double* x)
{
  for (int l = 0; l < k; ++l)
  {
    Lanes sum{};
    for (int j = 0; j < m; j += lanes) sum += lanes_at(a + l * stride + j) * lanes_at(x + j);
    y[l] -= (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

}  // namespace tribound::certify
