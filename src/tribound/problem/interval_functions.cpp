#include <cassert>
#include <numbers>

#include "tribound/problem/interval_series.h"

namespace tribound::problem
{
namespace
{

/// By how much a range may exceed the domain of a function, because of rounding, and still count as touching
/// its end. (The function is undefined beyond it, so that every existing value is enclosed.)
constexpr double domain_slack = 1e-9;

/// Larger integer exponents are treated as real ones.
constexpr double max_integer_power = 1024;

/// Coefficient n >= 1 of f(a), f' = g(a): (1/n) sum_{k=1}^n k a_k g_{n-k}
Enclosure chain_rule(const IntervalSeries& a, const IntervalSeries& g, int n)
{
  Enclosure sum = exactly(0.0);
  for (int k = std::max(1, n - g.length + 1); k <= std::min(n, a.length - 1); ++k)
    sum = sum + exactly(k) * a.c[k] * g.c[n - k];
  return sum / exactly(n);
}

/// The series f(a) with the value f(a_0); coefficient n is next(f, n), by those before it, until one
/// overflows.
template <class Next>
IntervalSeries build(const IntervalSeries& a, const Enclosure& value, Next next)
{
  if (a.length == 1) return constant_series(value, a.n_known);
  IntervalSeries f = constant_series(value, 1);
  for (int n = 1; f.n_known == n && n < a.n_known; ++n)
  {
    f.c[n] = next(f, n);
    if (is_finite(f.c[n])) f.n_known = f.length = n + 1;
  }
  return f;
}

/// f(a) with the value f(a_0) and the derivative g = f'(a).
IntervalSeries integral(const IntervalSeries& a, const Enclosure& value, const IntervalSeries& g)
{
  return build(a, value,
               [&](const IntervalSeries&, int n)
               { return n <= g.n_known ? chain_rule(a, g, n) : Enclosure{}; });
}

IntervalSeries exponential(const IntervalSeries& a)
{
  return build(a, increasing(a.c[0], [](double x) { return std::exp(x); }),
               [&](const IntervalSeries& f, int n) { return chain_rule(a, f, n); });
}

/// f(a) where f' = sign g, g' = f, with the values of both.
IntervalSeries circular(const IntervalSeries& a, const Enclosure& f0, const Enclosure& g0, double f_sign,
                        double g_sign)
{
  IntervalSeries g = constant_series(g0, 1);
  return build(a, f0,
               [&](const IntervalSeries& f, int n)
               {
                 const Enclosure coefficient = exactly(f_sign) * chain_rule(a, g, n);
                 g.c[n] = exactly(g_sign) * chain_rule(a, f, n);
                 g.length = n + 1;
                 return is_finite(g.c[n]) ? coefficient : Enclosure{};
               });
}

/// tan (sign 1) or tanh (sign -1): f' = 1 + sign f^2
IntervalSeries tangent(const IntervalSeries& a, const Enclosure& value, double sign)
{
  IntervalSeries g;
  return build(a, value,
               [&](const IntervalSeries& f, int n)
               {
                 Enclosure square = exactly(0.0);
                 for (int k = 0; k < n; ++k) square = square + f.c[k] * f.c[n - 1 - k];
                 if (n == 1) square = integer_power(f.c[0], 2);
                 g.c[n - 1] = n == 1 ? exactly(1.0) + exactly(sign) * square : exactly(sign) * square;
                 g.length = n;
                 return is_finite(g.c[n - 1]) ? chain_rule(a, g, n) : Enclosure{};
               });
}

IntervalSeries square_root(const IntervalSeries& a)
{
  const Enclosure& x = a.c[0];
  if (x.lower < -domain_slack * x.upper || x.upper < 0.0) return unknown_series();
  const Enclosure value =
      increasing(Enclosure{std::max(x.lower, 0.0), x.upper}, [](double s) { return std::sqrt(s); });
  if (x.lower <= 0.0 && a.length > 1) return values_only(value);
  return build(a, value,
               [&](const IntervalSeries& f, int n)
               {
                 Enclosure sum = n < a.length ? a.c[n] : exactly(0.0);
                 for (int k = 1; k < n; ++k) sum = sum - f.c[k] * f.c[n - k];
                 return sum / (exactly(2.0) * f.c[0]);
               });
}

IntervalSeries reciprocal(const IntervalSeries& a)
{
  return a.n_known == 0 ? a : divide(constant_series(exactly(1.0), a.n_known), a);
}

IntervalSeries logarithm(const IntervalSeries& a)
{
  if (a.c[0].lower <= 0.0) return unknown_series();
  return integral(a, increasing(a.c[0], [](double x) { return std::log(x); }), reciprocal(a));
}

/// s + t a^2
IntervalSeries quadratic(double s, double t, const IntervalSeries& a)
{
  const IntervalSeries square = integer_power(a, 2);
  if (square.n_known == 0) return square;
  return add(constant_series(exactly(s), a.n_known),
             multiply(constant_series(exactly(t), a.n_known), square));
}

/// 1/sqrt(s + t a^2)
IntervalSeries inverse_root(double s, double t, const IntervalSeries& a)
{
  const IntervalSeries radicand = quadratic(s, t, a);
  return radicand.n_known == 0 ? radicand : reciprocal(square_root(radicand));
}

/// f(a) for a monotone function on [begin, end] with a derivative that is infinite at the ends; `derivative`
/// makes the series f'(a).
template <class Function, class Derivative>
IntervalSeries on_domain(const IntervalSeries& a, double begin, double end, Function function,
                         Derivative derivative)
{
  const Enclosure& x = a.c[0];
  if (x.lower < begin - domain_slack || x.upper > end + domain_slack) return unknown_series();
  const double u = function(std::clamp(x.lower, begin, end));
  const double v = function(std::clamp(x.upper, begin, end));
  const Enclosure value = outward(std::min(u, v), std::max(u, v), library_error);
  if ((x.lower <= begin || x.upper >= end) && a.length > 1) return values_only(value);
  return a.length == 1 ? constant_series(value, a.n_known) : integral(a, value, derivative());
}

IntervalSeries inverse_function(Op op, const IntervalSeries& a)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto arc_derivative = [&] { return inverse_root(1, -1, a); };
  switch (op)
  {
    case Op::asin:
      return on_domain(
          a, -1, 1, [](double x) { return std::asin(x); }, arc_derivative);
    case Op::acos:
      return on_domain(
          a, -1, 1, [](double x) { return std::acos(x); }, [&] { return negate(arc_derivative()); });
    case Op::acosh:
      return on_domain(
          a, 1, infinity, [](double x) { return std::acosh(x); }, [&] { return inverse_root(-1, 1, a); });
    case Op::atanh:
      return on_domain(
          a, -1, 1, [](double x) { return std::atanh(x); }, [&] { return reciprocal(quadratic(1, -1, a)); });
    case Op::asinh:
      return integral(a, increasing(a.c[0], [](double x) { return std::asinh(x); }), inverse_root(1, 1, a));
    default:
      assert(op == Op::atan);
      return integral(a, increasing(a.c[0], [](double x) { return std::atan(x); }),
                      reciprocal(quadratic(1, 1, a)));
  }
}

IntervalSeries hyperbolic_function(Op op, const IntervalSeries& a)
{
  const Enclosure& x = a.c[0];
  if (op == Op::tanh) return tangent(a, increasing(x, [](double s) { return std::tanh(s); }), -1);
  const Enclosure sinh = increasing(x, [](double s) { return std::sinh(s); });
  const Enclosure cosh = outward(std::cosh(mignitude(x)), std::cosh(x.magnitude()), library_error);
  return op == Op::sinh ? circular(a, sinh, cosh, 1, 1) : circular(a, cosh, sinh, 1, 1);
}

IntervalSeries logarithm_to_base(double base, const IntervalSeries& a)
{
  const IntervalSeries log = logarithm(a);
  if (log.n_known == 0) return log;
  const double factor = 1.0 / std::log(base);
  return multiply(constant_series(outward(factor, factor, library_error), a.n_known), log);
}

/// a^p for a constant p: f' a = p f a'
IntervalSeries constant_power(const IntervalSeries& a, const Enclosure& p)
{
  return build(a, real_power(a.c[0], p),
               [&](const IntervalSeries& f, int n)
               {
                 Enclosure sum = exactly(0.0);
                 for (int k = 1; k <= std::min(n, a.length - 1); ++k)
                   sum = sum + ((p + exactly(1.0)) * exactly(k) - exactly(n)) * a.c[k] * f.c[n - k];
                 return sum / (exactly(n) * a.c[0]);
               });
}

}  // namespace

IntervalSeries power(const IntervalSeries& a, const IntervalSeries& b)
{
  const Enclosure& x = a.c[0];
  const Enclosure& p = b.c[0];
  if (b.length == 1 && p.lower == p.upper && std::rint(p.lower) == p.lower &&
      std::abs(p.lower) <= max_integer_power)
  {
    IntervalSeries base = a;
    base.n_known = std::min(a.n_known, b.n_known);
    base.length = std::min(a.length, base.n_known);
    return integer_power(base, static_cast<int>(p.lower));
  }
  if (x.lower <= 0.0)
  {
    const bool reaches_zero = x.lower >= -domain_slack * x.upper && x.upper >= 0.0 && p.lower > 0.0;
    return reaches_zero ? values_only(real_power({0.0, x.upper}, p)) : unknown_series();
  }
  if (b.length == 1 && b.n_known >= a.n_known) return constant_power(a, p);
  const IntervalSeries exponent = multiply(b, logarithm(a));
  if (exponent.n_known == 0) return exponent;
  IntervalSeries result = exponential(exponent);
  if (result.n_known > 0) result.c[0] = real_power(x, p);
  return result;
}

IntervalSeries arc_tangent(const IntervalSeries& y, const IntervalSeries& x)
{
  constexpr double pi = std::numbers::pi;
  const auto atan_of = [](const IntervalSeries& a)
  { return a.n_known == 0 ? a : inverse_function(Op::atan, a); };
  if (x.c[0].lower > 0.0) return atan_of(divide(y, x));
  if (y.c[0].contains(0.0)) return values_only(outward(-pi, pi, library_error));
  const double quarter = y.c[0].lower > 0.0 ? pi / 2 : -pi / 2;
  const IntervalSeries angle = atan_of(divide(x, y));
  if (angle.n_known == 0) return angle;
  return subtract(constant_series(outward(quarter, quarter), angle.n_known), angle);
}

IntervalSeries smooth_function(Op op, const IntervalSeries& a)
{
  const Enclosure& x = a.c[0];
  switch (op)
  {
    case Op::sqrt:
      return square_root(a);
    case Op::exp:
      return exponential(a);
    case Op::log:
      return logarithm(a);
    case Op::log2:
      return logarithm_to_base(2.0, a);
    case Op::log10:
      return logarithm_to_base(10.0, a);
    case Op::sin:
      return circular(a, sine(x), cosine(x), 1, -1);
    case Op::cos:
      return circular(a, cosine(x), sine(x), -1, 1);
    case Op::tan:
      if (has_pole_of_tangent(x)) return unknown_series();
      return tangent(a, increasing(x, [](double s) { return std::tan(s); }), 1);
    case Op::sinh:
    case Op::cosh:
    case Op::tanh:
      return hyperbolic_function(op, a);
    default:
      return inverse_function(op, a);
  }
}

}  // namespace tribound::problem
