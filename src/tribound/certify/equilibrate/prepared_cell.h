#pragma once

/// @file prepared_cell.h
/// A cell with everything its patches share, and what they leave in it.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/repeated_shapes.h"
#include "tribound/certify/equilibrate/rigid.h"

namespace tribound::certify
{

template <int dim, int p>
struct PreparedCell
{
  using S = Sizes<dim, p>;
  using UVector = DenseVector<S::u>;

  SortedCell<dim> sorted;
  const RepeatedShape<dim, p>* shape;  ///< null if the cell's shape does not come often
  const CellOperator<dim, p>* op;      ///< of the shape, or `own`
  std::unique_ptr<CellOperator<dim, p>> own;
  DiscreteStress<dim, p> sigma;       ///< sigma(u^k)
  UVector divergence;                 ///< moments of div sigma(u^k)
  std::array<UVector, dim + 1> body;  ///< moments of psi_a f
  double one;                         ///< moment of 1 on chi_0; it has no others
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

/// The shares of all vertices of a cell in all parts.
template <int dim, int p>
class CellShares
{
 public:
  explicit CellShares(int n_parts) : n_parts_(n_parts), shares_(static_cast<std::size_t>(dim + 1) * n_parts)
  {
  }

  /// By vertex: its shares in the parts.
  [[nodiscard]] std::span<CellShare<dim, p>> operator[](int vertex)
  {
    return std::span(shares_).subspan(vertex * n_parts_, n_parts_);
  }
  [[nodiscard]] std::span<const CellShare<dim, p>> operator[](int vertex) const
  {
    return std::span(shares_).subspan(vertex * n_parts_, n_parts_);
  }

 private:
  std::size_t n_parts_;
  std::vector<CellShare<dim, p>> shares_;
};

/// Fills in `one` and `coordinates`; `sorted` is known.
template <int dim, int p>
void find_moments(PreparedCell<dim, p>& cell)
{
  const auto& hat = reference<dim, p>().hat_moment;
  cell.one = moment_of_one<dim, p>(cell.sorted);
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
