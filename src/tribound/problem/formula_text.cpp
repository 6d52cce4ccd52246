#include "tribound/problem/formula_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <vector>

namespace tribound::problem
{

std::span<const NamedFunction> named_functions()
{
  constexpr int any = std::numeric_limits<int>::max();
  static constexpr std::array functions = {
      NamedFunction{"abs", Op::abs, 1, 1},       NamedFunction{"acos", Op::acos, 1, 1},
      NamedFunction{"acosh", Op::acosh, 1, 1},   NamedFunction{"asin", Op::asin, 1, 1},
      NamedFunction{"asinh", Op::asinh, 1, 1},   NamedFunction{"atan", Op::atan, 1, 1},
      NamedFunction{"atan2", Op::atan2, 2, 2},   NamedFunction{"atanh", Op::atanh, 1, 1},
      NamedFunction{"avg", Op::divide, 1, any},  NamedFunction{"cos", Op::cos, 1, 1},
      NamedFunction{"cosh", Op::cosh, 1, 1},     NamedFunction{"exp", Op::exp, 1, 1},
      NamedFunction{"ln", Op::log, 1, 1},        NamedFunction{"log", Op::log, 1, 1},
      NamedFunction{"log10", Op::log10, 1, 1},   NamedFunction{"log2", Op::log2, 1, 1},
      NamedFunction{"max", Op::maximum, 1, any}, NamedFunction{"min", Op::minimum, 1, any},
      NamedFunction{"rint", Op::rint, 1, 1},     NamedFunction{"sign", Op::sign, 1, 1},
      NamedFunction{"sin", Op::sin, 1, 1},       NamedFunction{"sinh", Op::sinh, 1, 1},
      NamedFunction{"sqrt", Op::sqrt, 1, 1},     NamedFunction{"sum", Op::add, 1, any},
      NamedFunction{"tan", Op::tan, 1, 1},       NamedFunction{"tanh", Op::tanh, 1, 1},
  };
  return functions;
}

void fail_at(const std::string& text, std::size_t position, const Where& where, const std::string& what,
             const std::string& hint)
{
  constexpr std::size_t before = 60;
  constexpr std::size_t width = 90;
  const std::size_t begin = position > before ? position - before : 0;
  throw InputError(where,
                   fmt::format("{} at character {} of the formula\n    {}\n    {:>{}}", what, position + 1,
                               text.substr(begin, width), '^', position - begin + 1),
                   hint);
}

bool is_name_character(char c)
{
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

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

void check_names(const std::string& text, const Where& where)
{
  std::vector<std::string> functions;
  for (const NamedFunction& function : named_functions()) functions.emplace_back(function.name);
  std::vector<std::string> known = {"x", "y", "z", "t", "pi", "e"};
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
              fmt::format("{}allowed are x, y, z, t, pi, e and the functions {}",
                          near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                          fmt::join(functions, ", ")));
    }
    i = std::max(i + 1, end);
  }
}

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

}  // namespace tribound::problem
