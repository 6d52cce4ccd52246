#include "tribound/problem/affine_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tribound::problem
{
namespace
{

template <class Function>
AffineForm combine(const AffineForm& a, const AffineForm& b, Function function)
{
  AffineForm result;
  for (int k = 0; k < 4; ++k)
  {
    result.c[k] = function(a.c[k], b.c[k]);
    result.size[k] = a.size[k] + b.size[k];
  }
  result.n_operations = a.n_operations + b.n_operations + 1;
  return result;
}

/// `a` times the number b, which may carry rounding of its own.
AffineForm product(const AffineForm& a, const AffineForm& b)
{
  AffineForm result;
  for (int k = 0; k < 4; ++k)
  {
    result.c[k] = a.c[k] * b.c[3];
    result.size[k] = a.size[k] * b.size[3];
  }
  result.n_operations = a.n_operations + b.n_operations + 1;
  return result;
}

AffineForm quotient(const AffineForm& a, const AffineForm& b)
{
  AffineForm result;
  for (int k = 0; k < 4; ++k)
  {
    result.c[k] = a.c[k] / b.c[3];
    result.size[k] = a.size[k] / std::abs(b.c[3]) * (b.size[3] / std::abs(b.c[3]));
  }
  result.n_operations = a.n_operations + b.n_operations + 1;
  return result;
}

}  // namespace

AffineForm AffineForm::number(double value)
{
  return {.c = {0, 0, 0, value}, .size = {0, 0, 0, std::abs(value)}};
}

AffineForm AffineForm::variable(int index)
{
  AffineForm form;
  form.c[index] = form.size[index] = 1.0;
  return form;
}

bool AffineForm::is_shifted_variable() const
{
  constexpr int most_operations = 3;  // the variable, the number, their difference
  const auto n_variables = std::count_if(c.begin(), c.end() - 1, [](double a) { return a != 0.0; });
  return n_variables == 1 && std::abs(c[0] + c[1] + c[2]) == 1.0 && n_operations <= most_operations;
}

double AffineForm::value(std::span<const double> x) const
{
  double sum = c[3];
  for (std::size_t k = 0; k < x.size(); ++k) sum += c[k] * x[k];
  return sum;
}

double AffineForm::scale(std::span<const double> x) const
{
  double sum = size[3];
  for (std::size_t k = 0; k < x.size(); ++k) sum += size[k] * std::abs(x[k]);
  return sum;
}

double AffineForm::rounding(double scale) const
{
  constexpr int own_operations = 8;  // of value(), and of points that lie on the hull up to rounding
  return (n_operations + own_operations) * std::numeric_limits<double>::epsilon() * scale;
}

AffineForm operator-(const AffineForm& a)
{
  AffineForm result = a;
  for (double& c : result.c) c = -c;
  return result;
}

std::optional<AffineForm> affine_result(Op op, const AffineForm& a, const AffineForm& b)
{
  const auto is_zero = [](const AffineForm& form) { return form.is_number() && form.size[3] == 0.0; };
  if (is_zero(b) && (op == Op::add || op == Op::subtract)) return a;  // so that x - 1 > 0 is x > 1
  AffineForm result;
  if (op == Op::add)
    result = combine(a, b, [](double p, double q) { return p + q; });
  else if (op == Op::subtract)
    result = combine(a, b, [](double p, double q) { return p - q; });
  else if (op == Op::multiply && b.is_number())
    result = product(a, b);
  else if (op == Op::multiply && a.is_number())
    result = product(b, a);
  else if (op == Op::divide && b.is_number() && b.c[3] != 0.0)
    result = quotient(a, b);
  else
    return std::nullopt;
  const bool overflows = std::ranges::any_of(result.size, [](double size) { return !std::isfinite(size); });
  if (overflows) return std::nullopt;
  return result;
}

}  // namespace tribound::problem
