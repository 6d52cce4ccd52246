#pragma once

/// @file repeated_shapes.h
/// What cells that are translates of each other share: most of a structured mesh, and of one refined from it.

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/too_flat.h"

namespace tribound::certify
{

/// The outer facet o of a patch's cell eliminated: S(o, o) = U(o, o)^T U(o, o), U(o, f) = U(o, o)^{-T} S(o,
/// f).
template <class Operator>
struct OuterElimination
{
  static constexpr int dim = Operator::dimension;
  static constexpr int n = Operator::block;
  static constexpr int stride = Operator::facet_stride;
  static constexpr int row = Operator::all_facets;

  Dense<n, row> rows;                ///< U(o, .)
  std::array<double, n> reciprocal;  ///< of the diagonal of U(o, o)

  /// Throws SolveError for a cell that is too flat.
  void factor(const Operator& op, const SortedCell<dim>& cell, int o)
  {
    std::copy_n(op.schur(o), n * row, rows.data());
    double* const pivot = rows.data() + o * stride;
    if (!cholesky<n>(pivot, row, reciprocal.data()))
      throw no_equilibrated_stress<dim>(cell.origin, slenderness(cell));
    for (int f = 0; f <= dim; ++f)
      if (f != o) solve_transposed<n, stride>(pivot, row, reciprocal.data(), rows.data() + f * stride, row);
  }

  /// target += S(f, g) - S(f, o) S(o, o)^{-1} S(o, g).
  void add_block(const Operator& op, int f, int g, Dense<n, n>& target) const
  {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < stride; j += lanes)
        lanes_at(target.row(i) + j) += lanes_at(op.schur(f) + i * row + g * stride + j);
    subtract_transposed_product<n, stride, n>(target.data(), stride, rows.data() + f * stride, row,
                                              rows.data() + g * stride, row);
  }
};

/// Everything of a cell that does not change when it is moved.
template <class Operator>
struct RepeatedShape
{
  static constexpr int dim = Operator::dimension;
  static constexpr int n = Operator::block;

  explicit RepeatedShape(const SortedCell<dim>& cell, const StressMetric& metric = {})
  {
    op.build(cell, metric);
    op.condense(cell);
    for (int o = 0; o <= dim; ++o)
    {
      outer[o].factor(op, cell, o);
      for (int f = 0; f <= dim; ++f)
        for (int g = 0; g <= dim; ++g)
          if (f != o && g != o) outer[o].add_block(op, f, g, reduced[o][f][g]);
    }
  }

  Operator op;
  std::array<OuterElimination<Operator>, dim + 1> outer;
  /// [o][f][g]: S(f, g) without the outer facet o
  std::array<std::array<std::array<Dense<n, n>, dim + 1>, dim + 1>, dim + 1> reduced;
};

/// The cells of a mesh sorted by shape.
struct ShapeClasses
{
  std::vector<int> number;   ///< per cell: its shape; -1 for one whose shape was not followed
  std::vector<Index> first;  ///< per shape: its first cell
  std::vector<int> count;    ///< per shape: how many cells have it
};

/// Numbers the shapes by their first cell; the same on every run. Shapes are equal if the rounding of the
/// coordinates explains the difference, and if the identities of the stress cannot feel it; `by_region`: of
/// cells of one region alone.
template <int dim>
[[nodiscard]] ShapeClasses classify_shapes(const mesh::Mesh<dim>& mesh, bool by_region = false);

/// The shapes that come often in a mesh.
template <class Operator>
class RepeatedShapes
{
 public:
  static constexpr int dim = Operator::dimension;

  /// `metrics`: of the regions; empty: L2 everywhere.
  explicit RepeatedShapes(const mesh::Mesh<dim>& mesh, std::span<const StressMetric> metrics = {})
  {
    ShapeClasses classes = classify_shapes(mesh, !metrics.empty());
    std::vector<int> kept(classes.first.size(), -1);
    for (std::size_t i = 0; i < classes.first.size(); ++i)
    {
      if (classes.count[i] < often) continue;
      kept[i] = static_cast<int>(shapes_.size());
      const Index first = classes.first[i];
      shapes_.push_back(std::make_unique<RepeatedShape<Operator>>(
          make_sorted_cell(mesh, first), metrics.empty() ? StressMetric{} : metrics[mesh.region(first)]));
    }
    number_ = std::move(classes.number);
    for (int& number : number_)
      if (number >= 0) number = kept[number];
  }

  /// Null for a cell whose shape does not come often.
  [[nodiscard]] const RepeatedShape<Operator>* find(Index cell) const
  {
    return number_[cell] < 0 ? nullptr : shapes_[number_[cell]].get();
  }

 private:
  static constexpr int often = 64;  ///< cells over which the memory of a shape is spread

  std::vector<int> number_;  ///< per cell: index in shapes_, or -1
  std::vector<std::unique_ptr<RepeatedShape<Operator>>> shapes_;
};

}  // namespace tribound::certify
