#pragma once

/// @file formula_text.h
/// The text of a formula: positions of mistakes, and names.

#include <span>
#include <string>
#include <string_view>

#include "tribound/problem/formula_program.h"

namespace tribound::problem
{

/// A function of the grammar.
struct NamedFunction
{
  std::string_view name;
  Op op;
  int min_arguments;
  int max_arguments;
};

/// All functions, by name.
[[nodiscard]] std::span<const NamedFunction> named_functions();

/// Throws, with the part of the formula around `position` (0-based) and a caret under it.
[[noreturn]] void fail_at(const std::string& text, std::size_t position, const Where& where,
                          const std::string& what, const std::string& hint);

[[nodiscard]] bool is_name_character(char c);

/// The position after the number that starts at `begin`.
[[nodiscard]] std::size_t skip_number(const std::string& text, std::size_t begin);

/// Throws InputError at the first name that is neither a variable, nor a constant, nor a function.
void check_names(const std::string& text, const Where& where);

/// Throws InputError at a single "=".
void check_no_assignment(const std::string& text, const Where& where);

}  // namespace tribound::problem
