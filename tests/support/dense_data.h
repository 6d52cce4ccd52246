#pragma once

/// @file dense_data.h
/// What the dense kernel (dense_patch.h) integrates: cells and facets with the values of all data at the
/// quadrature points.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "support/dense_patch.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/polynomials.h"

namespace tribound::test
{

/// One cell with everything at its volume quadrature points; stresses are written in the orthonormal
/// polynomials of the vertices in ascending order, as Stress<dim> wants them.
template <int dim>
struct DenseCell
{
  mesh::Cell<dim> vertices;  ///< ascending
  Point<dim> origin;
  Tensor<dim> inverse;                           ///< xhat = inverse (x - origin)
  double det;                                    ///< dim! |T|
  std::array<Point<dim>, dim + 1> hat_gradient;  ///< of the hat function of vertices[i]
  std::vector<Point<dim>> x;                     ///< quadrature points
  std::vector<double> weight;
  std::vector<Tensor<dim>> sigma;             ///< sigma(u^k)
  std::vector<Point<dim>> f;                  ///< body force
  std::vector<Eigen::VectorXd> phi;           ///< basis of P^p(T)
  std::vector<std::vector<Point<dim>>> dphi;  ///< its gradients

  [[nodiscard]] Point<dim> reference(const Point<dim>& point) const { return inverse * (point - origin); }
  /// Position of a vertex, or -1.
  [[nodiscard]] int find(Index v) const
  {
    const auto it = std::ranges::find(vertices, v);
    return it == vertices.end() ? -1 : static_cast<int>(it - vertices.begin());
  }
  /// psi_a at a point, a = vertices[i].
  [[nodiscard]] double hat(int i, const Point<dim>& point) const
  {
    const Point<dim> xhat = reference(point);
    return i == 0 ? 1 - xhat.sum() : xhat[i - 1];
  }
  [[nodiscard]] Eigen::VectorXd basis(int p, const Point<dim>& point) const
  {
    Eigen::VectorXd values(fem::polynomial_dimension(dim, p));
    fem::orthonormal_values<dim>(p, reference(point), std::span(values.data(), values.size()));
    return values / std::sqrt(det);
  }
};

/// A point of a rule on a facet.
template <int dim>
struct FacetPoint
{
  Point<dim> x;
  double weight;
  Eigen::VectorXd theta;  ///< basis of P^p(F)
};

/// A point where a boundary facet prescribes the traction of the patches.
template <int dim>
struct DataPoint
{
  FacetPoint<dim> at;
  std::array<Point<dim>, 2> traction;  ///< dis: g_N or T(u); lin: 0 or t^k - T(u)
};

/// A facet seen from its first cell; a boundary facet with its condition and traction.
template <int dim>
struct DenseFacet
{
  std::array<Index, dim> vertices;
  std::array<Index, 2> cells;
  Point<dim> normal;  ///< out of cells[0]
  std::vector<FacetPoint<dim>> points;
  const problem::BoundaryCondition<dim>* condition = nullptr;  ///< null inside
  std::vector<Point<dim>> traction;                            ///< g_N or T(u) at the points
  std::vector<DataPoint<dim>> data;                            ///< what t of the patches is integrated from

  [[nodiscard]] bool contains(Index v) const { return std::ranges::find(vertices, v) != vertices.end(); }
};

/// The iterate u^k with running traction t^k and the data of the problem, as the mutation leaves them.
template <int dim>
struct DenseData
{
  DenseData(const contact::NitscheForm<dim>& form, std::span<const double> u, std::span<const Point<dim>> t,
            certify::PatchStress patches, Mutation mutation);

  const mesh::Mesh<dim>& mesh;
  bool by_rows;  ///< no symmetry, constant y_a
  Mutation mutation;
  int p;
  int n;  ///< dim P^p(T)
  int m;  ///< dim P^{p-1}(T)
  std::vector<DenseCell<dim>> cells;
  std::vector<DenseFacet<dim>> facets;  ///< as numbered by the topology

  /// The first coefficient of component (r, c) in the cell number `place` of a patch.
  [[nodiscard]] int column(std::size_t place, int r, int c) const
  {
    return ((static_cast<int>(place) * dim + r) * dim + c) * n;
  }
};

}  // namespace tribound::test
