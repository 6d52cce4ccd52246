#pragma once

/// @file prepared_cell.h
/// A cell with everything its patches share, and what they leave in it.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/repeated_shapes.h"
#include "tribound/certify/equilibrate/rigid.h"
#include "tribound/certify/equilibrate/row_operator.h"
#include "tribound/certify/equilibrate/stress.h"

namespace tribound::certify
{

/// What all kinds of patches need of a cell.
template <class Operator>
struct ShapedCell
{
  static constexpr int dim = Operator::dimension;

  SortedCell<dim> sorted;
  const RepeatedShape<Operator>* shape;  ///< null if the cell's shape does not come often
  const Operator* op;                    ///< of the shape, or `own`
  std::unique_ptr<Operator> own;
  double one;  ///< moment of 1 on chi_0; it has no others
};

/// Of the patches in the Arnold-Falk-Winther spaces.
template <int dim, int p>
struct PreparedCell : ShapedCell<CellOperator<dim, p>>
{
  using S = Sizes<dim, p>;
  using UVector = DenseVector<S::u>;

  DiscreteStress<dim, p> sigma;       ///< sigma(u^k), with Pi^{p-1} sigma_0
  UVector divergence;                 ///< moments of div sigma(u^k)
  std::array<UVector, dim + 1> body;  ///< moments of psi_a f
  /// Of each vertex Pi^p (psi_a sigma_0) - psi_a Pi^{p-1} sigma_0; empty: 0
  std::vector<StressCoefficients<dim, p>> rest;
  /// [d]: moments of x_d - x_d(vertex 0), on chi of degree <= 1; it has no others
  std::array<std::array<double, S::affine>, dim> coordinates;
};

/// What the patch of one vertex leaves in a cell, for one part of the stress.
template <int dim, int p>
struct CellShare
{
  typename CellOperator<dim, p>::FacetVectors mu;  ///< multipliers of its facets
  RigidField<dim> y;                               ///< y_a
  Tensor<dim> w;                                   ///< w_a (p = 1)
};

/// Of the patches row by row. Column c of a matrix belongs to row c of the stress.
template <int dim, int p>
struct RowCell : ShapedCell<RowOperator<dim, p>>
{
  using CellRows = typename RowOperator<dim, p>::CellRows;

  DiscreteStress<dim, p> sigma;                  ///< sigma(u^k), with Pi^{p-1} sigma_0
  CellRows divergence;                           ///< moments of div sigma(u^k)
  std::array<CellRows, dim + 1> body;            ///< moments of psi_a f
  std::vector<StressCoefficients<dim, p>> rest;  ///< as of PreparedCell
  /// [f]: coefficients of sigma(u^k) n |grad lambda_f|^{1/2} on chi
  std::array<CellRows, dim + 1> normal;
};

/// Adds moments on U to those of the rows.
template <int dim, int p>
void add_by_rows(typename RowCell<dim, p>::CellRows& rows, const DenseVector<Sizes<dim, p>::u>& moments)
{
  constexpr int m = Sizes<dim, p>::multiplier;
  for (int r = 0; r < dim; ++r)
    for (int i = 0; i < m; ++i) rows(i, r) += moments[r * m + i];
}

/// The same as CellShare.
template <int dim, int p>
struct RowShare
{
  typename RowOperator<dim, p>::AllFacetRows mu;
  Point<dim> y;  ///< y_a, a constant
};

/// The shares of all vertices of a cell in all parts.
template <class Share, int dim>
class CellShares
{
 public:
  explicit CellShares(int n_parts) : n_parts_(n_parts), shares_(static_cast<std::size_t>(dim + 1) * n_parts)
  {
  }

  /// By vertex: its shares in the parts.
  [[nodiscard]] std::span<Share> operator[](int vertex)
  {
    return std::span(shares_).subspan(vertex * n_parts_, n_parts_);
  }
  [[nodiscard]] std::span<const Share> operator[](int vertex) const
  {
    return std::span(shares_).subspan(vertex * n_parts_, n_parts_);
  }

 private:
  std::size_t n_parts_;
  std::vector<Share> shares_;
};

/// The kinds of patches: what they are told of a cell, what they leave in it, and what they know of a facet.
template <int dim_, int p_>
struct AfwPatches
{
  static constexpr int dim = dim_;
  static constexpr int p = p_;
  static constexpr PatchStress patches = PatchStress::afw;
  using Operator = CellOperator<dim, p>;
  using Cell = PreparedCell<dim, p>;
  using Share = CellShare<dim, p>;
  using FacetUnknown = DenseVector<Operator::block>;
};
template <int dim_, int p_>
struct RowPatches
{
  static constexpr int dim = dim_;
  static constexpr int p = p_;
  static constexpr PatchStress patches = PatchStress::rows;
  using Operator = RowOperator<dim, p>;
  using Cell = RowCell<dim, p>;
  using Share = RowShare<dim, p>;
  using FacetUnknown = typename Operator::FacetRows;
};

/// Fills in `coordinates`; `sorted` is known.
template <int dim, int p>
void find_coordinates(PreparedCell<dim, p>& cell)
{
  const auto& hat = reference<dim, p>().hat_moment;
  const double scale = std::sqrt(cell.sorted.det);
  for (int d = 0; d < dim; ++d)
    for (int j = 0; j < Sizes<dim, p>::affine; ++j)
    {
      cell.coordinates[d][j] = 0;
      for (int v = 1; v <= dim; ++v)
        cell.coordinates[d][j] += scale * cell.sorted.jacobian(d, v - 1) * hat(j, v);
    }
}

/// Position of vertex a relative to vertex 0.
template <int dim>
[[nodiscard]] Point<dim> edge_to(const SortedCell<dim>& sorted, int a)
{
  return a == 0 ? Point<dim>(Point<dim>::Zero()) : Point<dim>(sorted.jacobian.col(a - 1));
}

/// moments += factor * those of the field about vertex a (for p = 1 of its mean).
template <int dim, int p>
void add_moments(DenseVector<Sizes<dim, p>::u>& moments, const PreparedCell<dim, p>& cell, int a,
                 const RigidField<dim>& field, double factor)
{
  constexpr int m = Sizes<dim, p>::multiplier;
  const Point<dim> at_origin = field.translation - field.gradient * edge_to(cell.sorted, a);
  for (int c = 0; c < dim; ++c)
  {
    moments[c * m] += factor * at_origin[c] * cell.one;
    for (int d = 0; d < dim; ++d)
      for (int j = 0; j < Sizes<dim, p>::affine; ++j)
        moments[c * m + j] += factor * field.gradient(c, d) * cell.coordinates[d][j];
  }
}

}  // namespace tribound::certify
