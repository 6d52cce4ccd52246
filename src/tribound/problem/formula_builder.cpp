#include "tribound/problem/formula_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tribound::problem
{
namespace
{

/// Values with more affine pieces count as unknown, and more switches are not listed. This bounds the time.
constexpr std::size_t max_pieces = 16;
constexpr std::size_t max_switches = 256;

using Pieces = std::vector<AffineForm>;

bool same(const AffineForm& a, const AffineForm& b)
{
  return a.c == b.c;
}

/// Adds `form` unless it is there; `pieces` becomes empty (unknown) when there are too many.
bool insert(Pieces& pieces, const AffineForm& form)
{
  if (std::ranges::any_of(pieces, [&](const AffineForm& piece) { return same(piece, form); })) return true;
  pieces.push_back(form);
  return pieces.size() <= max_pieces;
}

Pieces numbers(std::initializer_list<double> values)
{
  Pieces pieces;
  for (const double value : values) pieces.push_back(AffineForm::number(value));
  return pieces;
}

Pieces unite(const Pieces& a, const Pieces& b)
{
  if (a.empty() || b.empty()) return {};
  Pieces pieces = a;
  for (const AffineForm& form : b)
    if (!insert(pieces, form)) return {};
  return pieces;
}

Pieces negatives(const Pieces& a)
{
  Pieces pieces;
  for (const AffineForm& form : a) pieces.push_back(-form);
  return pieces;
}

Pieces combinations(Op op, const Pieces& a, const Pieces& b)
{
  Pieces pieces;
  for (const AffineForm& s : a)
    for (const AffineForm& t : b)
    {
      const std::optional<AffineForm> form = affine_result(op, s, t);
      if (!form || !insert(pieces, *form)) return {};
    }
  return pieces;
}

/// Whether one is a multiple of the other, up to rounding.
bool proportional(const Affine& s, const Affine& t)
{
  constexpr double tolerance = 1e-14;
  const std::array<double, 4> a = {s.a[0], s.a[1], s.a[2], s.b};
  const std::array<double, 4> b = {t.a[0], t.a[1], t.a[2], t.b};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j)
      if (std::abs(a[i] * b[j] - a[j] * b[i]) > tolerance * (std::abs(a[i] * b[j]) + std::abs(a[j] * b[i])))
        return false;
  return true;
}

bool is_comparison(Op op)
{
  return op >= Op::less && op <= Op::not_equal;
}

}  // namespace

int n_arguments(Op op)
{
  switch (op)
  {
    case Op::number:
    case Op::variable:
      return 0;
    case Op::choose:
      return 3;
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::divide:
    case Op::power:
    case Op::conjunction:
    case Op::disjunction:
    case Op::minimum:
    case Op::maximum:
    case Op::atan2:
      return 2;
    default:
      return is_comparison(op) ? 2 : 1;
  }
}

std::span<const Node> FormulaBuilder::nodes_of(std::size_t value) const
{
  const std::size_t begin = values_[value].begin;
  const std::size_t end = value + 1 < values_.size() ? values_[value + 1].begin : program_.nodes.size();
  return std::span(program_.nodes).subspan(begin, end - begin);
}

bool FormulaBuilder::is_number(std::size_t value) const
{
  return nodes_of(value).size() == 1 && nodes_of(value)[0].op == Op::number;
}

void FormulaBuilder::number(double value)
{
  values_.push_back({.begin = program_.nodes.size(),
                     .degree = 0,
                     .pieces = std::isfinite(value) ? numbers({value}) : Pieces{}});
  program_.nodes.push_back({.op = Op::number, .value = value});
}

void FormulaBuilder::variable(int index)
{
  values_.push_back({program_.nodes.size(), 1, {AffineForm::variable(index)}});
  program_.nodes.push_back({.op = Op::variable, .index = index});
  program_.uses[index] = true;
}

void FormulaBuilder::fold(Op op, std::size_t first)
{
  program_.nodes.push_back({.op = op});
  const std::size_t begin = values_[first].begin;
  const double value = constant_value(std::span(program_.nodes).subspan(begin));
  program_.nodes.resize(begin);
  values_.resize(first);
  number(value);
}

/// c ? a : b with a number c becomes a or b.
void FormulaBuilder::take_branch()
{
  const std::size_t first = values_.size() - 3;
  const bool second_branch = nodes_of(first)[0].value == 0.0;
  Value taken = std::move(values_[first + (second_branch ? 2 : 1)]);
  const auto begin = program_.nodes.begin();
  if (!second_branch) program_.nodes.erase(begin + values_[first + 2].begin, program_.nodes.end());
  program_.nodes.erase(begin + values_[first].begin, begin + taken.begin);
  taken.begin = values_[first].begin;
  values_.resize(first);
  values_.push_back(std::move(taken));
}

void FormulaBuilder::apply(Op op)
{
  constexpr double max_product = 4.0;  // up to it, repeated multiplication is exact enough, and fast
  const std::size_t n = n_arguments(op);
  const std::size_t first = values_.size() - n;
  const auto is_number_from_first = [&](std::size_t i) { return is_number(first + i); };
  if (n == 2 ? is_number_from_first(0) && is_number_from_first(1) : n == 1 && is_number_from_first(0))
    return fold(op, first);
  if (op == Op::choose && is_number(first)) return take_branch();

  Value result = {values_[first].begin, result_degree(op, first), result_pieces(op, first)};
  if (is_comparison(op) || op == Op::minimum || op == Op::maximum)
    add_switches(values_[first].pieces, values_[first + 1].pieces);
  if (op == Op::abs || op == Op::sign) add_switches(values_[first].pieces, numbers({0.0}));
  const double exponent = program_.nodes.back().value;
  if (op == Op::power && is_number(first + 1) && exponent >= 2.0 && exponent <= max_product &&
      exponent == std::rint(exponent))
    program_.nodes.back() = {.op = Op::integer_power, .index = static_cast<int>(exponent)};
  else
    program_.nodes.push_back({.op = op});
  values_.resize(first);
  values_.push_back(std::move(result));
}

void FormulaBuilder::add_switches(const Pieces& a, const Pieces& b)
{
  for (const AffineForm& s : a)
    for (const AffineForm& t : b)
    {
      const std::optional<AffineForm> form = affine_result(Op::subtract, s, t);
      auto& switches = program_.switches;
      if (!form || form->is_constant() || switches.size() == max_switches) continue;
      const Affine candidate = {{form->c[0], form->c[1], form->c[2]}, form->c[3]};
      if (std::ranges::none_of(switches, [&](const Affine& known) { return proportional(known, candidate); }))
        switches.push_back(candidate);
    }
}

int FormulaBuilder::result_degree(Op op, std::size_t first) const
{
  constexpr int no = Formula::not_polynomial;
  const int a = values_[first].degree;
  const int b = values_.back().degree;
  const double constant = program_.nodes.back().value;
  switch (op)
  {
    case Op::negate:
      return a;
    case Op::add:
    case Op::subtract:
      return std::max(a, b);
    case Op::multiply:
      return std::min(a + b, no);
    case Op::divide:
      return is_number(first + 1) ? a : no;
    case Op::power:
      if (!is_number(first + 1) || constant < 0.0 || constant != std::rint(constant)) return no;
      return static_cast<int>(std::min<double>(a * constant, no));
    default:
      return no;
  }
}

std::vector<AffineForm> FormulaBuilder::result_pieces(Op op, std::size_t first) const
{
  const Pieces& a = values_[first].pieces;
  const Pieces& b = values_.back().pieces;
  switch (op)
  {
    case Op::negate:
      return negatives(a);
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::divide:
      return combinations(op, a, b);
    case Op::minimum:
    case Op::maximum:
      return unite(a, b);
    case Op::abs:
      return unite(a, negatives(a));
    case Op::choose:
      return unite(values_[first + 1].pieces, b);
    case Op::sign:
      return numbers({-1.0, 0.0, 1.0});
    case Op::conjunction:
    case Op::disjunction:
      return numbers({0.0, 1.0});
    default:
      return is_comparison(op) ? numbers({0.0, 1.0}) : Pieces{};
  }
}

FormulaProgram FormulaBuilder::finish(std::string text) &&
{
  program_.text = std::move(text);
  program_.degree = values_.back().degree;
  return std::move(program_);
}

}  // namespace tribound::problem
