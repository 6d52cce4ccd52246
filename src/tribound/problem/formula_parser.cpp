#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "tribound/problem/formula_builder.h"
#include "tribound/problem/formula_text.h"

namespace tribound::problem
{
namespace
{

constexpr std::size_t max_length = 100'000;
constexpr int max_depth = 200;

/// A binary operator; a higher level binds more tightly.
struct BinaryOperator
{
  std::string_view symbol;
  Op op;
  int level;
};

constexpr int n_levels = 5;
// Longer symbols first.
constexpr std::array binary_operators = {
    BinaryOperator{"||", Op::disjunction, 0}, BinaryOperator{"&&", Op::conjunction, 1},
    BinaryOperator{"<=", Op::less_equal, 2},  BinaryOperator{">=", Op::greater_equal, 2},
    BinaryOperator{"==", Op::equal, 2},       BinaryOperator{"!=", Op::not_equal, 2},
    BinaryOperator{"<", Op::less, 2},         BinaryOperator{">", Op::greater, 2},
    BinaryOperator{"+", Op::add, 3},          BinaryOperator{"-", Op::subtract, 3},
    BinaryOperator{"*", Op::multiply, 4},     BinaryOperator{"/", Op::divide, 4},
};

/// Recursive descent:
///   formula = choice                     choice = binary(0) ["?" choice ":" choice]
///   binary(l) = binary(l+1) {operator of level l, binary(l+1)}            binary(n_levels) = signed
///   signed = ("-" | "+") signed | power   power = primary ["^" signed]
///   primary = number | name | function "(" choice {"," choice} ")" | "(" choice ")"
class Parser
{
 public:
  Parser(const std::string& text, const Where& where, double t) : text_(text), where_(where), t_(t) {}

  FormulaProgram parse()
  {
    int n_results = 0;
    do
    {
      choice();
      ++n_results;
    } while (accept(","));
    if (position_ < text_.size()) unexpected();
    if (n_results > 1)
      throw InputError(where_, fmt::format("the formula \"{}\" has {} results", text_, n_results),
                       "a comma separates arguments of a function; the decimal sign is a point");
    FormulaProgram program = std::move(builder_).finish(text_);
    program.uses_time = uses_time_;
    return program;
  }

 private:
  /// Counts the depth of the recursion while it lives.
  class Level
  {
   public:
    explicit Level(Parser& parser) : parser_(parser)
    {
      if (++parser_.depth_ > max_depth) parser_.too_deep();
    }
    ~Level() { --parser_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    Parser& parser_;
  };

  [[noreturn]] void fail(std::size_t position, const std::string& what) const
  {
    fail_at(text_, position, where_, what,
            "operators are + - * / ^, comparisons, && || and c ? a : b; "
            "functions take their arguments in parentheses");
  }

  [[noreturn]] void too_deep() const
  {
    fail_at(text_, std::min(position_, text_.size()), where_, "too deeply nested",
            fmt::format("at most {} levels of parentheses, signs, powers and choices", max_depth));
  }

  /// Throws at the token that begins here.
  [[noreturn]] void unexpected() const
  {
    if (position_ == text_.size()) fail(position_, "something is missing");
    std::size_t end = std::max(position_ + 1, skip_number(text_, position_));
    if (is_name_character(text_[position_]))
      while (end < text_.size() && is_name_character(text_[end])) ++end;
    fail(position_, fmt::format("unexpected \"{}\"", text_.substr(position_, end - position_)));
  }

  void skip_blanks() { position_ = std::min(text_.find_first_not_of(' ', position_), text_.size()); }

  /// Whether `symbol` comes next; if so, steps past it and past blanks.
  bool accept(std::string_view symbol)
  {
    skip_blanks();
    if (!std::string_view(text_).substr(position_).starts_with(symbol)) return false;
    position_ += symbol.size();
    skip_blanks();
    return true;
  }

  void expect(std::string_view symbol)
  {
    if (accept(symbol)) return;
    if (position_ == text_.size()) fail(position_, fmt::format("\"{}\" is missing", symbol));
    unexpected();
  }

  void choice()
  {
    const Level level(*this);
    binary(0);
    if (!accept("?")) return;
    choice();
    expect(":");
    choice();
    builder_.apply(Op::choose);
  }

  void binary(int level)
  {
    if (level == n_levels) return signed_value();
    binary(level + 1);
    for (;;)
    {
      const auto* const found = std::ranges::find_if(
          binary_operators, [&](const BinaryOperator& o) { return o.level == level && accept(o.symbol); });
      if (found == binary_operators.end()) return;
      binary(level + 1);
      builder_.apply(found->op);
    }
  }

  void signed_value()
  {
    if (accept("-"))
    {
      const Level level(*this);
      signed_value();
      builder_.apply(Op::negate);
    }
    else if (accept("+"))
    {
      const Level level(*this);
      signed_value();
    }
    else
      power();
  }

  void power()
  {
    primary();
    if (!accept("^")) return;
    const Level level(*this);
    signed_value();
    builder_.apply(Op::power);
  }

  void primary()
  {
    if (accept("("))
    {
      choice();
      return expect(")");
    }
    if (position_ == text_.size()) unexpected();
    const char c = text_[position_];
    if ((c >= '0' && c <= '9') || c == '.')
      number();
    else
      name();
    if (builder_.n_values() > max_stack) too_deep();
  }

  void number()
  {
    const char* const begin = text_.data() + position_;
    const std::size_t end = skip_number(text_, position_);
    double value = 0.0;
    const auto [last, error] = std::from_chars(begin, text_.data() + end, value);
    // "1e" is a number with an exponent left out, not 1 followed by e.
    const bool exponent_is_missing = end < text_.size() && (text_[end] == 'e' || text_[end] == 'E');
    if (error != std::errc() || exponent_is_missing) unexpected();
    builder_.number(value);
    position_ = end;
  }

  void name()
  {
    const std::size_t begin = position_;
    std::size_t end = begin;
    while (end < text_.size() && is_name_character(text_[end])) ++end;
    const std::string_view word = std::string_view(text_).substr(begin, end - begin);
    const auto functions = named_functions();
    const auto function =
        std::ranges::find_if(functions, [&](const NamedFunction& f) { return f.name == word; });
    if (function != functions.end()) return call(*function, begin, end);
    if (word == "pi")
      builder_.number(std::numbers::pi);
    else if (word == "e")
      builder_.number(std::numbers::e);
    else if (word == "t")
    {
      builder_.number(t_);
      uses_time_ = true;
    }
    else if (word == "x" || word == "y" || word == "z")
      builder_.variable(word[0] - 'x');
    else
      unexpected();
    position_ = end;
  }

  /// The function at `begin`, with its arguments from `end` on. A function of any number of arguments takes
  /// them in one by one: max(a, b, c) = max(max(a, b), c).
  void call(const NamedFunction& function, std::size_t begin, std::size_t end)
  {
    position_ = end;
    if (!accept("("))
    {
      position_ = begin;
      unexpected();
    }
    const bool averages = function.op == Op::divide;
    const bool any_number = function.max_arguments > 2;
    int n = 0;
    if (position_ == text_.size() || text_[position_] != ')') do
      {
        choice();
        if (++n > 1 && any_number) builder_.apply(averages ? Op::add : function.op);
      } while (accept(","));
    expect(")");
    if (n < function.min_arguments) fail(begin, fmt::format("too few arguments of \"{}\"", function.name));
    if (n > function.max_arguments) fail(begin, fmt::format("too many arguments of \"{}\"", function.name));
    if (averages) builder_.number(n);
    if (averages || !any_number) builder_.apply(function.op);
  }

  const std::string& text_;
  const Where& where_;
  double t_;  ///< the load factor
  bool uses_time_ = false;
  std::size_t position_ = 0;
  int depth_ = 0;
  FormulaBuilder builder_;
};

}  // namespace

FormulaProgram parse_formula(std::string text, const Where& where, double t)
{
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  if (text.find_first_not_of(' ') == std::string::npos)
    throw InputError(where, "is an empty formula", "a number or a formula; 0 where there is nothing");
  if (text.size() > max_length)
    throw InputError(where, fmt::format("is a formula of {} characters", text.size()),
                     fmt::format("at most {}", max_length));
  check_names(text, where);
  check_no_assignment(text, where);
  return Parser(text, where, t).parse();
}

}  // namespace tribound::problem
