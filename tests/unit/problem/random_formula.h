#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace tribound
{

/// A formula as a tree, for evaluation independent of the parser.
struct FormulaTree
{
  std::string symbol;  ///< of an operator, a function, a variable or a number; "neg" is the sign
  std::vector<FormulaTree> arguments;

  /// Whether the parser folds the tree to a number.
  [[nodiscard]] bool is_constant() const
  {
    if (symbol == "?" && arguments[0].is_constant())
      return arguments[arguments[0].value({0.0, 0.0, 0.0}) != 0.0 ? 1 : 2].is_constant();
    return symbol != "x" && symbol != "y" && symbol != "z" &&
           std::ranges::all_of(arguments, [](const FormulaTree& a) { return a.is_constant(); });
  }

  /// The value where x, y, z are `x`, in the arithmetic of Number; constants are folded in double precision.
  template <class Number>
  [[nodiscard]] Number value(const Number (&x)[3]) const
  {
    if constexpr (!std::is_same_v<Number, double>)
      if (is_constant()) return Number(value({0.0, 0.0, 0.0}));
    std::vector<Number> a;
    for (const FormulaTree& argument : arguments) a.push_back(argument.value(x));
    if (a.empty())
      return symbol == "x" ? x[0] : symbol == "y" ? x[1] : symbol == "z" ? x[2] : Number(std::stod(symbol));
    if (a.size() == 1) return function(a[0]);
    if (symbol == "?") return a[0] != 0 ? a[1] : a[2];
    return binary(a[0], a[1]);
  }

 private:
  template <class Number>
  [[nodiscard]] Number function(Number a) const
  {
    static const std::map<std::string, Number (*)(Number)> functions = {
        {"neg", [](Number s) { return -s; }},
        {"abs", [](Number s) { return std::abs(s); }},
        {"sign", [](Number s) { return s < 0   ? Number(-1)
                                       : s > 0 ? Number(1)
                                               : Number(0); }},
        {"rint", [](Number s) { return std::floor(s + Number(0.5)); }},
        {"sqrt", [](Number s) { return std::sqrt(s); }},
        {"exp", [](Number s) { return std::exp(s); }},
        {"log", [](Number s) { return std::log(s); }},
        {"ln", [](Number s) { return std::log(s); }},
        {"log2", [](Number s) { return std::log2(s); }},
        {"log10", [](Number s) { return std::log10(s); }},
        {"sin", [](Number s) { return std::sin(s); }},
        {"cos", [](Number s) { return std::cos(s); }},
        {"tan", [](Number s) { return std::tan(s); }},
        {"asin", [](Number s) { return std::asin(s); }},
        {"acos", [](Number s) { return std::acos(s); }},
        {"atan", [](Number s) { return std::atan(s); }},
        {"sinh", [](Number s) { return std::sinh(s); }},
        {"cosh", [](Number s) { return std::cosh(s); }},
        {"tanh", [](Number s) { return std::tanh(s); }},
        {"asinh", [](Number s) { return std::asinh(s); }},
        {"acosh", [](Number s) { return std::acosh(s); }},
        {"atanh", [](Number s) { return std::atanh(s); }},
    };
    return functions.at(symbol)(a);
  }

  template <class Number>
  [[nodiscard]] Number binary(Number a, Number b) const
  {
    static const std::map<std::string, Number (*)(Number, Number)> operators = {
        {"+", [](Number s, Number t) { return s + t; }},
        {"-", [](Number s, Number t) { return s - t; }},
        {"*", [](Number s, Number t) { return s * t; }},
        {"/", [](Number s, Number t) { return s / t; }},
        {"^", [](Number s, Number t) { return std::pow(s, t); }},
        {"<", [](Number s, Number t) { return Number(s < t); }},
        {"<=", [](Number s, Number t) { return Number(s <= t); }},
        {">", [](Number s, Number t) { return Number(s > t); }},
        {">=", [](Number s, Number t) { return Number(s >= t); }},
        {"==", [](Number s, Number t) { return Number(s == t); }},
        {"!=", [](Number s, Number t) { return Number(s != t); }},
        {"&&", [](Number s, Number t) { return Number(s != 0 && t != 0); }},
        {"||", [](Number s, Number t) { return Number(s != 0 || t != 0); }},
        {"min", [](Number s, Number t) { return std::min(s, t); }},
        {"max", [](Number s, Number t) { return std::max(s, t); }},
        {"sum", [](Number s, Number t) { return s + t; }},
        {"avg", [](Number s, Number t) { return (s + t) / 2; }},
        {"atan2", [](Number s, Number t) { return std::atan2(s, t); }},
    };
    return operators.at(symbol)(a, b);
  }
};

/// Makes random formulas over the whole grammar.
class RandomFormulas
{
 public:
  explicit RandomFormulas(unsigned seed) : random_(seed) {}

  /// A tree of at most `depth` levels; `smooth`: without what jumps or kinks.
  FormulaTree tree(int depth, bool smooth)
  {
    if (depth == 0 || uniform(0, 1) < 0.1) return leaf();
    const double kind = uniform(0, 1);
    if (kind < 0.08) return {"neg", {tree(depth - 1, smooth)}};
    if (kind < 0.5) return pair({"+", "-", "*", "/"}, depth, smooth);
    if (kind < 0.6)
      return {"^", {tree(depth - 1, smooth), {choose({"2", "3", "4", "5", "-1", "0.5", "1.5", "x"}), {}}}};
    if (kind < 0.62) return pair({"atan2", "sum", "avg"}, depth, smooth);
    if (kind < 0.8 || smooth)
      return {choose({"sqrt", "exp", "log", "ln", "log2", "log10", "sin", "cos", "tan", "asin", "acos",
                      "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh"}),
              {tree(depth - 1, smooth)}};
    if (kind < 0.84) return {choose({"abs", "sign", "rint"}), {tree(depth - 1, smooth)}};
    if (kind < 0.89) return pair({"min", "max"}, depth, smooth);
    if (kind < 0.94) return pair({"<", "<=", ">", ">=", "==", "!=", "&&", "||"}, depth, smooth);
    return {"?", {tree(depth - 1, smooth), tree(depth - 1, smooth), tree(depth - 1, smooth)}};
  }

  /// The text of the tree. Necessary parentheses are left out with the given probability: then it is another
  /// formula, which precedence and associativity decide.
  std::string text(const FormulaTree& tree, double left_out = 0.0)
  {
    const auto blank = [&] { return std::string(uniform(0, 1) < 0.2 ? " " : ""); };
    const auto argument = [&](std::size_t i) { return text(tree.arguments[i], left_out); };
    std::string result;
    if (tree.arguments.empty()) return tree.symbol[0] == '-' ? "(" + tree.symbol + ")" : tree.symbol;
    if (std::isalpha(static_cast<unsigned char>(tree.symbol[0])) != 0 && tree.symbol != "neg")
    {
      result = tree.symbol + "(" + blank();
      for (std::size_t i = 0; i < tree.arguments.size(); ++i)
        result += (i > 0 ? "," + blank() : "") + argument(i);
      return result + blank() + ")";
    }
    if (tree.symbol == "neg")
    {
      result = argument(0);
      result = "-" + blank() + (result[0] == '-' ? "(" + result + ")" : result);
    }
    else if (tree.symbol == "?")
      result = argument(0) + blank() + "?" + blank() + argument(1) + blank() + ":" + blank() + argument(2);
    else
      result = argument(0) + blank() + tree.symbol + blank() + argument(1);
    return uniform(0, 1) < left_out ? result : "(" + result + ")";
  }

  double uniform(double lower, double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }

 private:
  FormulaTree leaf()
  {
    if (uniform(0, 1) < 0.75) return {choose({"x", "y", "z"}), {}};
    return {choose({"0.5", "1", "2", "3", "1.5e-1", ".25", "10", "7.", "2E+0", "0.3", "0"}), {}};
  }

  FormulaTree pair(const std::vector<std::string>& symbols, int depth, bool smooth)
  {
    return {choose(symbols), {tree(depth - 1, smooth), tree(depth - 1, smooth)}};
  }

  std::string choose(const std::vector<std::string>& from)
  {
    return from[std::uniform_int_distribution<std::size_t>(0, from.size() - 1)(random_)];
  }

  std::mt19937 random_;
};

}  // namespace tribound
