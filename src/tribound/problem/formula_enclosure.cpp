#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/problem/formula_program.h"
#include "tribound/problem/formula_region.h"

namespace tribound::problem
{
namespace
{

/// A value on the stack: an affine function, or a series.
struct Value
{
  std::optional<AffineForm> affine{};
  IntervalSeries series{};
};

/// Evaluates a formula on a region.
class Evaluator
{
 public:
  Evaluator(const Region& region, std::span<const std::array<Enclosure, 3>> coordinates, int n_coefficients,
            std::vector<Value>& stack)
      : region_(region), coordinates_(coordinates), n_coefficients_(n_coefficients), stack_(stack)
  {
  }

  IntervalSeries operator()(std::span<const Node> nodes)
  {
    stack_.clear();
    for (const Node& node : nodes) apply(node);
    return series_of(stack_.back());
  }

 private:
  void push(const AffineForm& form) { stack_.push_back({.affine = form}); }
  void push(double value) { push(AffineForm::number(value)); }
  void push(const IntervalSeries& series) { stack_.push_back({.series = series}); }

  void push_coordinate(std::size_t k)
  {
    if (k >= coordinates_.size()) return push(0.0);
    const auto& c = coordinates_[k];
    if (!std::ranges::all_of(c, is_finite)) return push(unknown_series());
    IntervalSeries series = constant_series(c[0], n_coefficients_);
    series.length = std::min(n_coefficients_, 3);
    std::copy_n(c.begin(), series.length, series.c.begin());
    push(series);
  }

  Value pop()
  {
    Value value = stack_.back();
    stack_.pop_back();
    return value;
  }

  [[nodiscard]] IntervalSeries series_of(const Value& a) const
  {
    return a.affine ? region_.series(*a.affine, n_coefficients_) : a.series;
  }

  [[nodiscard]] int signs(const Value& a) const
  {
    if (a.affine) return region_.signs(*a.affine);
    return a.series.n_known > 0 ? signs_in(a.series.c[0]) : any_sign;
  }

  /// The signs of a - b.
  [[nodiscard]] int signs_of_difference(const Value& a, const Value& b) const
  {
    if (a.affine && b.affine)
    {
      const std::optional<AffineForm> difference = affine_result(Op::subtract, *a.affine, *b.affine);
      return difference ? region_.signs(*difference) : any_sign;
    }
    const IntervalSeries s = series_of(a);
    const IntervalSeries t = series_of(b);
    return s.n_known > 0 && t.n_known > 0 ? signs_in(s.c[0] - t.c[0]) : any_sign;
  }

  /// Pushes one of the two, not known which: its values are combine(values of a, values of b).
  template <class Combine>
  void push_undecided(const Value& a, const Value& b, Combine combine)
  {
    const IntervalSeries s = series_of(a);
    const IntervalSeries t = series_of(b);
    push(s.n_known > 0 && t.n_known > 0 ? values_only(combine(s.c[0], t.c[0])) : unknown_series());
  }

  void push_truth(bool may_be_true, bool may_be_false)
  {
    if (may_be_true && may_be_false)
      push(values_only({0.0, 1.0}));
    else
      push(may_be_true ? 1.0 : 0.0);
  }

  void apply(const Node& node)
  {
    switch (node.op)
    {
      case Op::number:
        return std::isfinite(node.value) ? push(node.value) : push(unknown_series());
      case Op::variable:
        return coordinates_.empty() ? push(AffineForm::variable(node.index)) : push_coordinate(node.index);
      case Op::choose:
        return choose();
      case Op::conjunction:
      case Op::disjunction:
        return connective(node.op);
      case Op::minimum:
      case Op::maximum:
        return extremum(node.op == Op::maximum);
      case Op::abs:
        return absolute_value();
      case Op::sign:
        return sign();
      case Op::rint:
        return nearest_integer();
      default:
        if (node.op >= Op::less && node.op <= Op::not_equal) return comparison(node.op);
        return n_arguments(node.op) == 2 ? smooth_binary(node.op) : smooth_unary(node);
    }
  }

  void smooth_binary(Op op)
  {
    const Value b = pop();
    const Value a = pop();
    if (a.affine && b.affine)
      if (const auto form = affine_result(op, *a.affine, *b.affine)) return push(*form);
    const IntervalSeries s = series_of(a);
    const IntervalSeries t = series_of(b);
    if (s.n_known == 0 || t.n_known == 0) return push(unknown_series());
    switch (op)
    {
      case Op::add:
        return push(add(s, t));
      case Op::subtract:
        return push(subtract(s, t));
      case Op::multiply:
        return push(multiply(s, t));
      case Op::divide:
        return push(divide(s, t));
      case Op::power:
        return push(power(s, t));
      default:
        assert(op == Op::atan2);
        return push(arc_tangent(s, t));
    }
  }

  void smooth_unary(const Node& node)
  {
    const Value a = pop();
    if (node.op == Op::negate && a.affine) return push(-*a.affine);
    const IntervalSeries s = series_of(a);
    if (s.n_known == 0) return push(s);
    if (node.op == Op::negate) return push(negate(s));
    if (node.op == Op::integer_power) return push(integer_power(s, node.index));
    push(smooth_function(node.op, s));
  }

  void choose()
  {
    const Value b = pop();
    const Value a = pop();
    const int condition = signs(pop());
    if ((condition & zero) == 0)
      stack_.push_back(a);
    else if (condition == zero)
      stack_.push_back(b);
    else
      push_undecided(a, b, hull);
  }

  void connective(Op op)
  {
    const int b = signs(pop());
    const int a = signs(pop());
    const bool a_true = (a & (negative | positive)) != 0;
    const bool b_true = (b & (negative | positive)) != 0;
    const bool a_false = (a & zero) != 0;
    const bool b_false = (b & zero) != 0;
    if (op == Op::conjunction)
      push_truth(a_true && b_true, a_false || b_false);
    else
      push_truth(a_true || b_true, a_false && b_false);
  }

  void comparison(Op op)
  {
    const Value b = pop();
    const Value a = pop();
    const int signs = signs_of_difference(a, b);
    const int true_signs = op == Op::less            ? negative
                           : op == Op::less_equal    ? negative | zero
                           : op == Op::greater       ? positive
                           : op == Op::greater_equal ? positive | zero
                           : op == Op::equal         ? zero
                                                     : negative | positive;
    push_truth((signs & true_signs) != 0, (signs & ~true_signs) != 0);
  }

  void extremum(bool is_maximum)
  {
    const Value b = pop();
    const Value a = pop();
    const int signs = signs_of_difference(a, b);
    const int first_wins = is_maximum ? positive : negative;
    const int second_wins = is_maximum ? negative : positive;
    if ((signs & second_wins) == 0) return stack_.push_back(a);
    if ((signs & first_wins) == 0) return stack_.push_back(b);
    push_undecided(a, b,
                   [&](const Enclosure& s, const Enclosure& t)
                   {
                     return is_maximum ? Enclosure{std::max(s.lower, t.lower), std::max(s.upper, t.upper)}
                                       : Enclosure{std::min(s.lower, t.lower), std::min(s.upper, t.upper)};
                   });
  }

  void absolute_value()
  {
    const Value a = pop();
    const int signs_of_a = signs(a);
    if ((signs_of_a & negative) == 0) return stack_.push_back(a);
    if ((signs_of_a & positive) == 0)
    {
      stack_.push_back(a);
      return smooth_unary({.op = Op::negate});
    }
    const IntervalSeries s = series_of(a);
    push(s.n_known > 0 ? values_only({mignitude(s.c[0]), s.c[0].magnitude()}) : s);
  }

  void sign()
  {
    const int signs_of_a = signs(pop());
    const double lower = (signs_of_a & negative) != 0 ? -1.0 : (signs_of_a & zero) != 0 ? 0.0 : 1.0;
    const double upper = (signs_of_a & positive) != 0 ? 1.0 : (signs_of_a & zero) != 0 ? 0.0 : -1.0;
    if (lower == upper)
      push(lower);
    else
      push(values_only({lower, upper}));
  }

  void nearest_integer()
  {
    const IntervalSeries s = series_of(pop());
    if (s.n_known == 0) return push(s);
    const double lower = std::floor(s.c[0].lower + 0.5);
    const double upper = std::floor(s.c[0].upper + 0.5);
    if (lower == upper)
      push(lower);
    else
      push(values_only({lower, upper}));
  }

  const Region& region_;
  std::span<const std::array<Enclosure, 3>> coordinates_;  ///< empty: those of the region
  int n_coefficients_;
  std::vector<Value>& stack_;
};

IntervalSeries evaluate(std::span<const Node> nodes, const Region& region, int n_coefficients,
                        std::span<const std::array<Enclosure, 3>> coordinates = {})
{
  thread_local std::vector<Value> stack;  // kept: making it costs as much as the evaluation
  return Evaluator(region, coordinates, n_coefficients, stack)(nodes);
}

void take(const IntervalSeries& series, std::span<Enclosure> coefficients)
{
  for (std::size_t n = 0; n < coefficients.size(); ++n)
    coefficients[n] = static_cast<int>(n) < series.n_known ? series.c[n] : Enclosure{};
}

}  // namespace

void Formula::enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients,
                      Sides sides) const
{
  assert(coefficients.size() <= max_order + 1);
  const Region region(vertices, dim, sides);
  take(problem::evaluate(program_->nodes, region, static_cast<int>(coefficients.size())), coefficients);
}

void Formula::enclose_composed(std::span<const std::array<Enclosure, 3>> coordinates,
                               std::span<Enclosure> coefficients) const
{
  assert(coefficients.size() <= max_order + 1 && !coordinates.empty());
  constexpr std::array<double, 3> anywhere{};
  const Region region(anywhere, 3, Sides::closed);  // for constants alone
  take(problem::evaluate(program_->nodes, region, static_cast<int>(coefficients.size()), coordinates),
       coefficients);
}

Enclosure Formula::enclose_box(std::span<const double> lower, std::span<const double> upper) const
{
  const std::size_t dim = lower.size();
  const std::size_t n_vertices = std::size_t{1} << dim;
  std::array<double, 8 * 3> vertices;
  for (std::size_t i = 0; i < n_vertices; ++i)
    for (std::size_t k = 0; k < dim; ++k) vertices[i * dim + k] = (i >> k) % 2 == 0 ? lower[k] : upper[k];
  const Region region({vertices.data(), n_vertices * dim}, static_cast<int>(dim), Sides::closed);
  const IntervalSeries series = problem::evaluate(program_->nodes, region, 1);
  return series.n_known > 0 ? series.c[0] : Enclosure{};
}

double distance_from_polynomials(std::span<const Enclosure> taylor, int order)
{
  double smallest = (taylor[0].upper - taylor[0].lower) / 2;
  for (int n = 1; n <= order; ++n) smallest = std::min(smallest, taylor[n].magnitude());
  return smallest;
}

}  // namespace tribound::problem
