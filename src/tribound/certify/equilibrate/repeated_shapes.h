#pragma once

/// @file repeated_shapes.h
/// What cells that are translates of each other share: most of a structured mesh, and of one refined from it.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/too_flat.h"

namespace tribound::certify
{

/// The outer facet o of a patch's cell eliminated: S(o, o) = U(o, o)^T U(o, o), U(o, f) = U(o, o)^{-T} S(o,
/// f).
template <int dim, int p>
struct OuterElimination
{
  using S = Sizes<dim, p>;
  using Operator = CellOperator<dim, p>;
  static constexpr int stride = Operator::facet_stride;
  static constexpr int row = Operator::all_facets;

  Dense<S::block, row> rows;                ///< U(o, .)
  std::array<double, S::block> reciprocal;  ///< of the diagonal of U(o, o)

  /// Throws SolveError for a cell that is too flat.
  void factor(const Operator& op, const Frame<dim>& frame, int o)
  {
    std::copy_n(op.schur(o), S::block * row, rows.data());
    double* const pivot = rows.data() + o * stride;
    if (!cholesky<S::block>(pivot, row, reciprocal.data()))
      throw no_equilibrated_stress<dim>(frame.origin, slenderness(frame));
    for (int f = 0; f <= dim; ++f)
      if (f != o)
        solve_transposed<S::block, stride>(pivot, row, reciprocal.data(), rows.data() + f * stride, row);
  }

  /// target += S(f, g) - S(f, o) S(o, o)^{-1} S(o, g).
  void add_block(const Operator& op, int f, int g, Dense<S::block, S::block>& target) const
  {
    for (int i = 0; i < S::block; ++i)
      for (int j = 0; j < stride; j += lanes)
        lanes_at(target.row(i) + j) += lanes_at(op.schur(f) + i * row + g * stride + j);
    subtract_transposed_product<S::block, stride, S::block>(target.data(), stride, rows.data() + f * stride,
                                                            row, rows.data() + g * stride, row);
  }
};

/// Everything of a cell that does not change when it is moved.
template <int dim, int p>
struct RepeatedShape
{
  using S = Sizes<dim, p>;

  explicit RepeatedShape(const Frame<dim>& frame)
  {
    op.build(frame);
    op.condense(frame);
    for (int o = 0; o <= dim; ++o)
    {
      outer[o].factor(op, frame, o);
      for (int f = 0; f <= dim; ++f)
        for (int g = 0; g <= dim; ++g)
          if (f != o && g != o) outer[o].add_block(op, f, g, reduced[o][f][g]);
    }
  }

  CellOperator<dim, p> op;
  std::array<OuterElimination<dim, p>, dim + 1> outer;
  /// [o][f][g]: S(f, g) without the outer facet o
  std::array<std::array<std::array<Dense<S::block, S::block>, dim + 1>, dim + 1>, dim + 1> reduced;
};

/// The shapes that come often in a mesh.
template <int dim, int p>
class RepeatedShapes
{
 public:
  explicit RepeatedShapes(const mesh::Mesh<dim>& mesh) : number_(mesh.n_cells(), -1)
  {
    std::vector<Index> first;  // cell of each shape
    std::vector<int> count;
    classify(mesh, first, count);
    std::vector<int> kept(first.size(), -1);
    for (std::size_t i = 0; i < first.size(); ++i)
    {
      if (count[i] < often) continue;
      kept[i] = static_cast<int>(shapes_.size());
      shapes_.push_back(std::make_unique<RepeatedShape<dim, p>>(make_frame(mesh, first[i])));
    }
    for (int& number : number_)
      if (number >= 0) number = kept[number];
  }

  /// Null for a cell whose shape does not come often.
  [[nodiscard]] const RepeatedShape<dim, p>* find(Index cell) const
  {
    return number_[cell] < 0 ? nullptr : shapes_[number_[cell]].get();
  }

 private:
  static constexpr double exact = 1e-12;
  static constexpr int often = 64;  ///< cells over which the memory of a shape is spread
  static constexpr int table_size =
      1 << 12;  ///< of the hash table: a shape that finds its place taken is given up

  /// Numbers the shapes by their first cell; the same on every run. Shapes are equal if the rounding of the
  /// coordinates explains the difference, and if the identities of the stress cannot feel it.
  void classify(const mesh::Mesh<dim>& mesh, std::vector<Index>& first, std::vector<int>& count)
  {
    double largest = 0;
    for (const Point<dim>& x : mesh.vertices()) largest = std::max(largest, x.cwiseAbs().maxCoeff());
    const double rounding =
        8 * std::numeric_limits<double>::epsilon() * largest;  // of differences of coordinates
    std::vector<int> table(table_size, -1);
    for (Index c = 0; c < mesh.n_cells(); ++c)
    {
      const Tensor<dim> jacobian = jacobian_of(mesh, sorted_vertices<dim>(mesh.cell(c)));
      int& place = table[hash(jacobian, 1e3 * rounding)];
      if (place < 0)
      {
        place = static_cast<int>(first.size());
        first.push_back(c);
        count.push_back(0);
      }
      const Tensor<dim> known = jacobian_of(mesh, sorted_vertices<dim>(mesh.cell(first[place])));
      const double tolerance = std::min(rounding, exact * known.cwiseAbs().maxCoeff());
      if (!((jacobian - known).cwiseAbs().maxCoeff() <= tolerance)) continue;
      number_[c] = place;
      ++count[place];
    }
  }

  /// Equal for most pairs of matrices that differ by much less than the quantum.
  [[nodiscard]] static std::size_t hash(const Tensor<dim>& jacobian, double quantum)
  {
    std::uint64_t key = 0;
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        key =
            (key ^ static_cast<std::uint64_t>(std::llround(jacobian(r, c) / quantum))) * 0x9e3779b97f4a7c15U;
    return (key >> 40) % table_size;
  }

  std::vector<int> number_;  ///< per cell: place in shapes_, or -1
  std::vector<std::unique_ptr<RepeatedShape<dim, p>>> shapes_;
};

}  // namespace tribound::certify
