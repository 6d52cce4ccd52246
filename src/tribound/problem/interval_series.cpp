#include "tribound/problem/interval_series.h"

namespace tribound::problem
{
namespace
{

/// `a` with the coefficients that did not overflow.
IntervalSeries up_to_overflow(IntervalSeries a)
{
  for (int n = 0; n < a.n_known; ++n)
    if (!is_finite(a.c[n])) a.n_known = n;
  a.length = std::min(a.length, a.n_known);
  return a;
}

/// The series of coefficients coefficient(n), zero from `length` on.
template <class Coefficient>
IntervalSeries series(int n_known, int length, Coefficient coefficient)
{
  IntervalSeries result;
  result.n_known = n_known;
  result.length = std::min(n_known, length);
  for (int n = 0; n < n_known; ++n) result.c[n] = n < result.length ? coefficient(n) : exactly(0.0);
  return up_to_overflow(result);
}

IntervalSeries square(const IntervalSeries& a)
{
  return series(a.n_known, 2 * a.length - 1,
                [&](int n)
                {
                  Enclosure sum = exactly(0.0);
                  for (int k = std::max(0, n - a.length + 1); 2 * k < n; ++k) sum = sum + a.c[k] * a.c[n - k];
                  sum = exactly(2.0) * sum;
                  return n % 2 == 0 ? sum + integer_power(a.c[n / 2], 2) : sum;
                });
}

/// (a_0 + a_1 t)^n: C(n, k) a_0^(n-k) a_1^k
IntervalSeries affine_power(const IntervalSeries& a, int n)
{
  Enclosure binomial = exactly(1.0);
  return series(a.n_known, n + 1,
                [&](int k)
                {
                  if (k > 0) binomial = binomial * exactly(n - k + 1) / exactly(k);
                  return binomial * integer_power(a.c[0], n - k) * integer_power(a.c[1], k);
                });
}

}  // namespace

IntervalSeries unknown_series()
{
  return {};
}

IntervalSeries constant_series(const Enclosure& value, int n_known)
{
  return series(n_known, 1, [&](int) { return value; });
}

IntervalSeries values_only(const Enclosure& value)
{
  return constant_series(value, 1);
}

IntervalSeries negate(const IntervalSeries& a)
{
  return series(a.n_known, a.length, [&](int n) { return -a.c[n]; });
}

IntervalSeries add(const IntervalSeries& a, const IntervalSeries& b)
{
  return series(std::min(a.n_known, b.n_known), std::max(a.length, b.length),
                [&](int n) { return a.c[n] + b.c[n]; });
}

IntervalSeries subtract(const IntervalSeries& a, const IntervalSeries& b)
{
  return add(a, negate(b));
}

IntervalSeries multiply(const IntervalSeries& a, const IntervalSeries& b)
{
  return series(std::min(a.n_known, b.n_known), a.length + b.length - 1,
                [&](int n)
                {
                  Enclosure sum = exactly(0.0);
                  for (int k = std::max(0, n - b.length + 1); k <= std::min(n, a.length - 1); ++k)
                    sum = sum + a.c[k] * b.c[n - k];
                  return sum;
                });
}

IntervalSeries divide(const IntervalSeries& a, const IntervalSeries& b)
{
  if (b.c[0].contains(0.0)) return unknown_series();
  IntervalSeries result;
  result.n_known = std::min(a.n_known, b.n_known);
  result.length = b.length == 1 ? std::min(a.length, result.n_known) : result.n_known;
  for (int n = 0; n < result.n_known; ++n)
  {
    Enclosure sum = n < a.length ? a.c[n] : exactly(0.0);
    for (int k = 1; k <= std::min(n, b.length - 1); ++k) sum = sum - b.c[k] * result.c[n - k];
    result.c[n] = sum / b.c[0];
    if (!is_finite(result.c[n])) return up_to_overflow(result);
  }
  return result;
}

IntervalSeries integer_power(const IntervalSeries& a, int n)
{
  if (n < 0)
  {
    const IntervalSeries denominator = integer_power(a, -n);
    return denominator.n_known == 0 ? denominator
                                    : divide(constant_series(exactly(1.0), a.n_known), denominator);
  }
  if (a.length <= 2) return affine_power(a, n);
  if (n == 2) return square(a);
  IntervalSeries result = constant_series(exactly(1.0), a.n_known);
  IntervalSeries factor = a;
  for (int bits = n; bits > 0 && result.n_known > 0 && factor.n_known > 0; bits /= 2)
  {
    if (bits % 2 == 1) result = multiply(result, factor);
    if (bits > 1) factor = square(factor);
  }
  if (result.n_known == 0 || factor.n_known == 0) return unknown_series();
  result.c[0] = integer_power(a.c[0], n);
  return result;
}

}  // namespace tribound::problem
