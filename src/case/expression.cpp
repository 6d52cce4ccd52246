#include "case/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

namespace tribound
{

/// A compiled formula with the variables its byte code points to.
struct Expression::Formula
{
  explicit Formula(std::string formula_text) : text(std::move(formula_text))
  {
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    parser.DefineVar("x", &variables[0]);
    parser.DefineVar("y", &variables[1]);
    parser.DefineVar("z", &variables[2]);
    parser.SetExpr(text);
  }
  Formula(const Formula& other) : Formula(other.text) {}
  Formula& operator=(const Formula&) = delete;

  std::string text;
  double variables[3] = {0.0, 0.0, 0.0};
  mu::Parser parser;
};

namespace
{

/// Throws, with the part of the formula around `position` (0-based) and a caret under it.
[[noreturn]] void fail_at(const std::string& text, std::size_t position, const Where& where,
                          const std::string& what, const std::string& hint)
{
  constexpr std::size_t before = 60;
  constexpr std::size_t width = 90;
  const std::size_t begin = position > before ? position - before : 0;
  throw InputError(where,
                   fmt::format("{} at character {} of the formula\n    {}\n    {:>{}}", what, position + 1,
                               text.substr(begin, width), '^', position - begin + 1),
                   hint);
}

std::vector<std::string> function_names(const mu::Parser& parser)
{
  std::vector<std::string> names;
  for (const auto& [name, callback] : parser.GetFunDef()) names.push_back(name);
  return names;
}

bool is_name_character(char c)
{
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The position behind the number that starts at `begin`.
std::size_t skip_number(const std::string& text, std::size_t begin)
{
  const auto digits = [&](std::size_t i)
  {
    while (i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]))) ++i;
    return i;
  };
  std::size_t end = digits(begin);
  if (end < text.size() && text[end] == '.') end = digits(end + 1);
  if (end >= text.size() || (text[end] != 'e' && text[end] != 'E')) return end;
  std::size_t exponent = end + 1;
  if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
  const std::size_t behind = digits(exponent);
  return behind > exponent ? behind : end;
}

/// Throws InputError at the first name that is neither a variable, nor a constant, nor a function.
/// muParser stops at such names too, but often at the character behind them.
void check_names(const std::string& text, const std::vector<std::string>& functions, const Where& where)
{
  std::vector<std::string> known = {"x", "y", "z", "pi", "e"};
  known.insert(known.end(), functions.begin(), functions.end());
  for (std::size_t i = 0; i < text.size();)
  {
    if (std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.')
    {
      i = std::max(i + 1, skip_number(text, i));
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && is_name_character(text[end])) ++end;
    const std::string name = text.substr(i, end - i);
    if (!name.empty() && std::ranges::find(known, name) == known.end())
    {
      const std::string near = closest(name, known);
      fail_at(text, i, where, fmt::format("unknown name \"{}\"", name),
              fmt::format("{}allowed are x, y, z, pi, e and the functions {}",
                          near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                          fmt::join(functions, ", ")));
    }
    i = std::max(i + 1, end);
  }
}

/// Throws InputError at a single "=": muParser would assign to the variable.
void check_no_assignment(const std::string& text, const Where& where)
{
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=')
      ++i;
    else if (i == 0 || std::string_view("<>!").find(text[i - 1]) == std::string_view::npos)
      fail_at(text, i, where, "an assignment", "to compare, write == ; give the formula alone otherwise");
  }
}

std::string describe(const mu::ParserError& error)
{
  std::string token = error.GetToken();
  while (!token.empty() && token.back() == ' ') token.pop_back();
  switch (error.GetCode())
  {
    case mu::ecUNEXPECTED_EOF:
      return "something is missing";
    case mu::ecMISSING_PARENS:
      return "\")\" is missing";
    case mu::ecMISSING_ELSE_CLAUSE:
      return "\":\" is missing";
    case mu::ecMISPLACED_COLON:
      return "unexpected \":\"";
    case mu::ecEXPRESSION_TOO_LONG:
      return "too long";
    case mu::ecTOO_FEW_PARAMS:
      return fmt::format("too few arguments of \"{}\"", token);
    case mu::ecTOO_MANY_PARAMS:
      return fmt::format("too many arguments of \"{}\"", token);
    default:
      return fmt::format("unexpected \"{}\"", token);
  }
}

}  // namespace

Expression::Expression() = default;

Expression::Expression(double value, Where where) : value_(value), where_(std::move(where)) {}

Expression::Expression(std::string text, Where where) : where_(std::move(where))
{
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  if (text.find_first_not_of(' ') == std::string::npos)
    throw InputError(where_, "is an empty formula", "a number or a formula; 0 where there is nothing");
  check_names(text, function_names(mu::Parser()), where_);
  check_no_assignment(text, where_);
  try
  {
    formula_ = std::make_unique<Formula>(text);
    int n_results = 0;
    formula_->parser.Eval(n_results);
    if (n_results != 1)
      throw InputError(where_, fmt::format("the formula \"{}\" has {} results", text, n_results),
                       "a comma separates arguments of a function; the decimal sign is a point");
    if (!formula_->parser.GetUsedVar().empty()) return;
  }
  catch (const mu::ParserError& error)
  {
    // A position of -1 and the blank that muParser appends both mean the end.
    const std::size_t position =
        error.GetPos() < 0 ? text.size() : std::min<std::size_t>(error.GetPos(), text.size());
    fail_at(text, position, where_, describe(error),
            "operators are + - * / ^, comparisons, && || and c ? a : b; "
            "functions take their arguments in parentheses");
  }
  value_ = evaluate({});
  formula_.reset();
}

Expression::Expression(const Expression& other)
    : value_(other.value_),
      formula_(other.formula_ ? std::make_unique<Formula>(*other.formula_) : nullptr),
      where_(other.where_)
{
}

Expression& Expression::operator=(const Expression& other)
{
  *this = Expression(other);
  return *this;
}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

bool Expression::uses_z() const
{
  return formula_ && formula_->parser.GetUsedVar().contains("z");
}

double Expression::evaluate(std::span<const double> x) const
{
  std::ranges::copy(x, formula_->variables);
  const double value = formula_->parser.Eval();
  if (std::isfinite(value)) return value;
  const bool undefined = std::isnan(value);
  throw InputError(where_,
                   fmt::format("the formula \"{}\" is {}{}", formula_->text,
                               undefined ? "undefined (nan)" : fmt::format("{}", value),
                               x.empty() ? "" : fmt::format(" at the point ({:.9g})", fmt::join(x, ", "))),
                   undefined ? "keep it defined, such as sqrt(max(x, 0)) for sqrt(x)"
                             : "keep it finite, such as 1/max(x, 1e-12) for 1/x");
}

}  // namespace tribound
