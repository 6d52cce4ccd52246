#include "tribound/problem/formula_calculus.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <string_view>
#include <utility>

#include "tribound/problem/formula_program.h"
#include "tribound/problem/formula_text.h"

namespace tribound::problem
{

namespace
{

/// A formula and its derivatives; empty stands for 0.
struct Term
{
  std::string value;
  std::array<std::string, 3> derivative{};
};

std::string sum(const std::string& a, const std::string& b)
{
  if (a.empty() || b.empty()) return a + b;
  return "(" + a + "+" + b + ")";
}

/// Empty if one of the factors is.
std::string product(const std::string& a, const std::string& b)
{
  if (a.empty() || b.empty()) return {};
  return "(" + a + "*" + b + ")";
}

std::string minus(const std::string& a)
{
  return a.empty() ? a : "(-" + a + ")";
}

std::string or_zero(const std::string& a)
{
  return a.empty() ? "0" : a;
}

std::string_view operator_of(Op op)
{
  switch (op)
  {
    case Op::add:
      return "+";
    case Op::subtract:
      return "-";
    case Op::multiply:
      return "*";
    case Op::divide:
      return "/";
    case Op::power:
      return "^";
    case Op::less:
      return "<";
    case Op::less_equal:
      return "<=";
    case Op::greater:
      return ">";
    case Op::greater_equal:
      return ">=";
    case Op::equal:
      return "==";
    case Op::not_equal:
      return "!=";
    case Op::conjunction:
      return "&&";
    case Op::disjunction:
      return "||";
    default:
      return {};
  }
}

std::string_view function_of(Op op)
{
  const auto functions = named_functions();
  const auto found = std::ranges::find_if(
      functions, [op](const NamedFunction& f) { return f.op == op && f.max_arguments <= 2; });
  if (found != functions.end()) return found->name;
  return op == Op::minimum ? "min" : "max";
}

/// f'(a), to be multiplied by a'; value = f(a).
std::string outer_derivative(Op op, const std::string& a, const std::string& value)
{
  switch (op)
  {
    case Op::abs:
      return fmt::format("sign({})", a);
    case Op::sqrt:
      return fmt::format("(0.5/{})", value);
    case Op::exp:
      return value;
    case Op::log:
      return fmt::format("(1/{})", a);
    case Op::log2:
      return fmt::format("(1/({}*ln(2)))", a);
    case Op::log10:
      return fmt::format("(1/({}*ln(10)))", a);
    case Op::sin:
      return fmt::format("cos({})", a);
    case Op::cos:
      return fmt::format("(-sin({}))", a);
    case Op::tan:
      return fmt::format("(1+{}^2)", value);
    case Op::asin:
      return fmt::format("(1/sqrt(1-{}^2))", a);
    case Op::acos:
      return fmt::format("(-1/sqrt(1-{}^2))", a);
    case Op::atan:
      return fmt::format("(1/(1+{}^2))", a);
    case Op::sinh:
      return fmt::format("cosh({})", a);
    case Op::cosh:
      return fmt::format("sinh({})", a);
    case Op::tanh:
      return fmt::format("(1-{}^2)", value);
    case Op::asinh:
      return fmt::format("(1/sqrt({}^2+1))", a);
    case Op::acosh:
      return fmt::format("(1/sqrt({}^2-1))", a);
    case Op::atanh:
      return fmt::format("(1/(1-{}^2))", a);
    default:  // sign and rint
      return {};
  }
}

/// d(a op b) from a' and b'.
std::string binary_derivative(Op op, const Term& a, const Term& b, const std::string& da,
                              const std::string& db)
{
  switch (op)
  {
    case Op::add:
      return sum(da, db);
    case Op::subtract:
      return sum(da, minus(db));
    case Op::multiply:
      return sum(product(da, b.value), product(a.value, db));
    case Op::divide:
    {
      const std::string top = sum(product(da, b.value), minus(product(a.value, db)));
      return top.empty() ? top : fmt::format("({}/{}^2)", top, b.value);
    }
    case Op::power:
      return sum(product(fmt::format("({0}*{1}^({0}-1))", b.value, a.value), da),
                 product(fmt::format("({1}^{0}*ln({1}))", b.value, a.value), db));
    case Op::minimum:
    case Op::maximum:
      return da.empty() && db.empty() ? std::string()
                                      : fmt::format("({}{}{}?{}:{})", a.value, op == Op::minimum ? "<" : ">",
                                                    b.value, or_zero(da), or_zero(db));
    case Op::atan2:
    {
      const std::string top = sum(product(da, b.value), minus(product(a.value, db)));
      return top.empty() ? top : fmt::format("({}/({}^2+{}^2))", top, a.value, b.value);
    }
    default:  // comparisons
      return {};
  }
}

class Calculus
{
 public:
  Calculus(std::span<const std::string> coordinates, bool differentiates)
      : coordinates_(coordinates), differentiates_(differentiates)
  {
  }

  Term operator()(std::span<const Node> nodes)
  {
    for (const Node& node : nodes) apply(node);
    return pop();
  }

 private:
  Term pop()
  {
    Term term = std::move(stack_.back());
    stack_.pop_back();
    return term;
  }

  void apply(const Node& node)
  {
    switch (node.op)
    {
      case Op::number:
        stack_.push_back({fmt::format("({})", node.value)});
        return;
      case Op::variable:
        stack_.push_back(
            {node.index < static_cast<int>(coordinates_.size()) ? coordinates_[node.index] : "0"});
        if (differentiates_) stack_.back().derivative[node.index] = "1";
        return;
      case Op::choose:
        return choose();
      default:
        if (n_arguments(node.op) == 2) return binary(node.op);
        unary(node);
    }
  }

  void choose()
  {
    const Term b = pop();
    const Term a = pop();
    const Term condition = pop();
    Term result{fmt::format("({}?{}:{})", condition.value, a.value, b.value)};
    for (std::size_t i = 0; i < 3; ++i)
      if (!a.derivative[i].empty() || !b.derivative[i].empty())
        result.derivative[i] =
            fmt::format("({}?{}:{})", condition.value, or_zero(a.derivative[i]), or_zero(b.derivative[i]));
    stack_.push_back(std::move(result));
  }

  void binary(Op op)
  {
    const Term b = pop();
    const Term a = pop();
    const std::string_view sign = operator_of(op);
    Term result{sign.empty() ? fmt::format("{}({},{})", function_of(op), a.value, b.value)
                             : fmt::format("({}{}{})", a.value, sign, b.value)};
    for (std::size_t i = 0; i < 3; ++i)
      result.derivative[i] = binary_derivative(op, a, b, a.derivative[i], b.derivative[i]);
    stack_.push_back(std::move(result));
  }

  void unary(const Node& node)
  {
    const Term a = pop();
    Term result;
    std::string outer;
    if (node.op == Op::negate)
    {
      result.value = minus(a.value);
      outer = "(-1)";
    }
    else if (node.op == Op::integer_power)
    {
      result.value = fmt::format("({}^{})", a.value, node.index);
      outer = fmt::format("({}*{}^{})", node.index, a.value, node.index - 1);
    }
    else
    {
      result.value = fmt::format("{}({})", function_of(node.op), a.value);
      outer = outer_derivative(node.op, a.value, result.value);
    }
    for (std::size_t i = 0; i < 3; ++i) result.derivative[i] = product(outer, a.derivative[i]);
    stack_.push_back(std::move(result));
  }

  std::span<const std::string> coordinates_;
  bool differentiates_;
  std::vector<Term> stack_{};
};

}  // namespace

std::string composed(const std::string& text, std::span<const std::string> coordinates, const Where& where)
{
  const FormulaProgram program = parse_formula(text, where);
  return Calculus(coordinates, false)(program.nodes).value;
}

std::vector<std::string> gradient(const std::string& text, int dim, const Where& where)
{
  static const std::array<std::string, 3> coordinates = {"x", "y", "z"};
  const FormulaProgram program = parse_formula(text, where);
  const Term term = Calculus(coordinates, true)(program.nodes);
  std::vector<std::string> result;
  result.reserve(dim);
  for (int i = 0; i < dim; ++i) result.push_back(or_zero(term.derivative[i]));
  return result;
}

}  // namespace tribound::problem
