#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/problem/formula_program.h"

namespace tribound::problem
{
namespace
{

/// Points evaluated together, operation by operation.
constexpr int block_width = 32;

/// The values of `n` <= width points on the stack.
template <int width>
class Lanes
{
 public:
  Lanes(double* values, int n) : values_(values), n_(width == 1 ? 1 : n) {}

  /// f(top)
  template <class Function>
  void unary(Function f)
  {
    double* const a = values_ + (top_ - 1) * width;
    for (int i = 0; i < n_; ++i) a[i] = f(a[i]);
  }

  /// f(second from the top, top)
  template <class Function>
  void binary(Function f)
  {
    --top_;
    double* const a = values_ + (top_ - 1) * width;
    const double* const b = a + width;
    for (int i = 0; i < n_; ++i) a[i] = f(a[i], b[i]);
  }

  void choose()
  {
    top_ -= 2;
    double* const c = values_ + (top_ - 1) * width;
    for (int i = 0; i < n_; ++i) c[i] = c[i] != 0.0 ? c[width + i] : c[2 * width + i];
  }

  void push(double value) { std::fill_n(values_ + top_++ * width, n_, value); }
  void push(const double* values) { std::copy_n(values, n_, values_ + top_++ * width); }

 private:
  double* values_;
  int n_;
  int top_ = 0;
};

double power(double a, int n)
{
  const double square = a * a;
  return n == 2 ? square : n == 3 ? square * a : square * square;
}

template <int width>
void comparison(Op op, Lanes<width>& lanes)
{
  switch (op)
  {
    case Op::less:
      return lanes.binary([](double a, double b) { return a < b ? 1.0 : 0.0; });
    case Op::less_equal:
      return lanes.binary([](double a, double b) { return a <= b ? 1.0 : 0.0; });
    case Op::greater:
      return lanes.binary([](double a, double b) { return a > b ? 1.0 : 0.0; });
    case Op::greater_equal:
      return lanes.binary([](double a, double b) { return a >= b ? 1.0 : 0.0; });
    case Op::equal:
      return lanes.binary([](double a, double b) { return a == b ? 1.0 : 0.0; });
    default:
      return lanes.binary([](double a, double b) { return a != b ? 1.0 : 0.0; });
  }
}

template <int width>
void elementary_function(Op op, Lanes<width>& lanes)
{
  switch (op)
  {
    case Op::sqrt:
      return lanes.unary([](double a) { return std::sqrt(a); });
    case Op::exp:
      return lanes.unary([](double a) { return std::exp(a); });
    case Op::log:
      return lanes.unary([](double a) { return std::log(a); });
    case Op::log2:
      return lanes.unary([](double a) { return std::log2(a); });
    case Op::log10:
      return lanes.unary([](double a) { return std::log10(a); });
    case Op::sin:
      return lanes.unary([](double a) { return std::sin(a); });
    case Op::cos:
      return lanes.unary([](double a) { return std::cos(a); });
    case Op::tan:
      return lanes.unary([](double a) { return std::tan(a); });
    case Op::asin:
      return lanes.unary([](double a) { return std::asin(a); });
    case Op::acos:
      return lanes.unary([](double a) { return std::acos(a); });
    case Op::atan:
      return lanes.unary([](double a) { return std::atan(a); });
    case Op::atan2:
      return lanes.binary([](double a, double b) { return std::atan2(a, b); });
    case Op::sinh:
      return lanes.unary([](double a) { return std::sinh(a); });
    case Op::cosh:
      return lanes.unary([](double a) { return std::cosh(a); });
    case Op::tanh:
      return lanes.unary([](double a) { return std::tanh(a); });
    case Op::asinh:
      return lanes.unary([](double a) { return std::asinh(a); });
    case Op::acosh:
      return lanes.unary([](double a) { return std::acosh(a); });
    case Op::atanh:
      return lanes.unary([](double a) { return std::atanh(a); });
    default:
      return comparison(op, lanes);
  }
}

template <int width>
void apply(const Node& node, Lanes<width>& lanes)
{
  switch (node.op)
  {
    case Op::number:
      return lanes.push(node.value);
    case Op::negate:
      return lanes.unary([](double a) { return -a; });
    case Op::add:
      return lanes.binary([](double a, double b) { return a + b; });
    case Op::subtract:
      return lanes.binary([](double a, double b) { return a - b; });
    case Op::multiply:
      return lanes.binary([](double a, double b) { return a * b; });
    case Op::divide:
      return lanes.binary([](double a, double b) { return a / b; });
    case Op::power:
      return lanes.binary([](double a, double b) { return std::pow(a, b); });
    case Op::integer_power:
      return lanes.unary([n = node.index](double a) { return power(a, n); });
    case Op::conjunction:
      return lanes.binary([](double a, double b) { return a != 0.0 && b != 0.0 ? 1.0 : 0.0; });
    case Op::disjunction:
      return lanes.binary([](double a, double b) { return a != 0.0 || b != 0.0 ? 1.0 : 0.0; });
    case Op::choose:
      return lanes.choose();
    case Op::minimum:
      return lanes.binary([](double a, double b) { return std::min(a, b); });
    case Op::maximum:
      return lanes.binary([](double a, double b) { return std::max(a, b); });
    case Op::abs:
      return lanes.unary([](double a) { return std::abs(a); });
    case Op::sign:
      return lanes.unary([](double a) { return a < 0.0 ? -1.0 : a > 0.0 ? 1.0 : 0.0; });
    case Op::rint:
      return lanes.unary([](double a) { return std::floor(a + 0.5); });
    default:
      return elementary_function(node.op, lanes);
  }
}

/// The values at `n` <= width points, coordinate k of point i at coordinates[k*width + i].
template <int width>
void evaluate_block(std::span<const Node> nodes, const double* coordinates, int n, double* values)
{
  double stack[max_stack * width];  // not initialised: mostly a few values of it are used
  Lanes<width> lanes(stack, n);
  for (const Node& node : nodes)
    if (node.op == Op::variable)
      lanes.push(coordinates + node.index * width);
    else
      apply(node, lanes);
  std::copy_n(stack, n, values);
}

}  // namespace

double constant_value(std::span<const Node> nodes)
{
  double value = 0.0;
  evaluate_block<1>(nodes, nullptr, 1, &value);
  return value;
}

double Formula::operator()(std::span<const double> x) const
{
  std::array<double, 3> coordinates{};
  std::ranges::copy(x, coordinates.begin());
  double value = 0.0;
  evaluate_block<1>(program_->nodes, coordinates.data(), 1, &value);
  return value;
}

void Formula::evaluate(std::span<const double> points, int dim, std::span<double> values) const
{
  std::array<double, 3 * block_width> coordinates{};
  for (std::size_t begin = 0; begin < values.size(); begin += block_width)
  {
    const int n = static_cast<int>(std::min<std::size_t>(block_width, values.size() - begin));
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < dim; ++k) coordinates[k * block_width + i] = points[(begin + i) * dim + k];
    evaluate_block<block_width>(program_->nodes, coordinates.data(), n, values.data() + begin);
  }
}

}  // namespace tribound::problem
