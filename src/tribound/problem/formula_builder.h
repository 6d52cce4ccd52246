#pragma once

/// @file formula_builder.h
/// Puts the operations of a formula together: folds constants, finds degree and switches.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribound/problem/affine_form.h"
#include "tribound/problem/formula_program.h"

namespace tribound::problem
{

/// Takes the operations in postfix order.
class FormulaBuilder
{
 public:
  void number(double value);
  void variable(int index);
  /// Applies `op` to the last values.
  void apply(Op op);
  /// How many values are on the stack.
  [[nodiscard]] int n_values() const { return static_cast<int>(values_.size()); }
  [[nodiscard]] FormulaProgram finish(std::string text) &&;

 private:
  /// A value on the stack.
  struct Value
  {
    std::size_t begin;               ///< its first node
    int degree;                      ///< see Formula::degree
    std::vector<AffineForm> pieces;  ///< it equals one of these at every point; unknown if empty
  };

  [[nodiscard]] std::span<const Node> nodes_of(std::size_t value) const;
  [[nodiscard]] bool is_number(std::size_t value) const;
  void fold(Op op, std::size_t first);
  void take_branch();
  void add_switches(const std::vector<AffineForm>& a, const std::vector<AffineForm>& b);
  [[nodiscard]] int result_degree(Op op, std::size_t first) const;
  [[nodiscard]] std::vector<AffineForm> result_pieces(Op op, std::size_t first) const;

  FormulaProgram program_;
  std::vector<Value> values_;
};

}  // namespace tribound::problem
