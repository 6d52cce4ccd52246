#pragma once

/// @file formula_program.h
/// A parsed formula: operations in postfix order.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/problem/formula.h"

namespace tribound::problem
{

/// Operations. Those that are functions of the grammar stand in named_functions().
enum class Op
{
  number,
  variable,
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,
  integer_power,  ///< to the constant power Node::index
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  conjunction,
  disjunction,
  choose,  ///< c ? a : b
  minimum,
  maximum,
  abs,
  sign,
  rint,
  sqrt,
  exp,
  log,
  log2,
  log10,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,
};

/// One operation; its arguments are on the top of the stack.
struct Node
{
  Op op = Op::number;
  int index = 0;       ///< of a variable; exponent of integer_power
  double value = 0.0;  ///< of a number
};

/// How many arguments an operation takes from the stack.
[[nodiscard]] int n_arguments(Op op);

/// A parsed formula.
struct FormulaProgram
{
  std::string text;
  std::vector<Node> nodes;  ///< of which each leaves one value on the stack
  std::array<bool, 3> uses{};
  bool uses_time = false;
  int degree = Formula::not_polynomial;
  std::vector<Affine> switches;
};

/// The largest number of values on the stack.
inline constexpr int max_stack = 512;

/// The value of `nodes`, which name no variable.
[[nodiscard]] double constant_value(std::span<const Node> nodes);

/// Parses `text` with the value of t; throws as Formula does.
[[nodiscard]] FormulaProgram parse_formula(std::string text, const Where& where, double t = 1);

}  // namespace tribound::problem
