#pragma once

/// @file evaluation.h
/// Integration and evaluation on cells and facets: the points of a rule in space with their weights, and
/// finite element functions from tabulated basis functions.
///
///     for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
///       integral += dx * f(x);

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::fem
{

/// A point of a rule on a cell or facet.
template <int dim>
struct QuadraturePoint
{
  int q;         ///< number in the rule
  Point<dim> x;  ///< in space
  double dx;     ///< weight of the rule times the determinant of the map
};

/// The points of a rule under an affine map, to be looped over. Keeps a reference to the rule.
template <typename Map, int k, int dim>
class MappedPoints
{
 public:
  MappedPoints(const Map& map, double det, const Quadrature<k>& rule) : map_(map), det_(det), rule_(&rule) {}

  class Iterator
  {
   public:
    Iterator(const MappedPoints* points, int q) : points_(points), q_(q) {}
    QuadraturePoint<dim> operator*() const { return (*points_)[q_]; }
    Iterator& operator++()
    {
      ++q_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return q_ == other.q_; }

   private:
    const MappedPoints* points_;
    int q_;
  };

  [[nodiscard]] QuadraturePoint<dim> operator[](int q) const
  {
    return {q, map_(rule_->points[q]), det_ * rule_->weights[q]};
  }
  [[nodiscard]] int size() const { return rule_->size(); }
  [[nodiscard]] Iterator begin() const { return {this, 0}; }
  [[nodiscard]] Iterator end() const { return {this, size()}; }

 private:
  Map map_;
  double det_;
  const Quadrature<k>* rule_;
};

/// The points of a rule on a cell.
template <int dim>
[[nodiscard]] MappedPoints<mesh::CellMap<dim>, dim, dim> cell_points(const mesh::CellMap<dim>& map,
                                                                     const Quadrature<dim>& rule)
{
  return {map, map.det, rule};
}

/// The points of a rule on facet `local` of a cell.
template <int dim>
[[nodiscard]] MappedPoints<mesh::FacetMap<dim>, dim - 1, dim> facet_points(const mesh::Mesh<dim>& mesh,
                                                                           Index cell, int local,
                                                                           const Quadrature<dim - 1>& rule)
{
  return {mesh::facet_map(mesh, cell, local), mesh::facet_geometry(mesh, cell, local).det(), rule};
}

/// The points of the reference facet as points of the reference cell, on its facet `local`.
template <int dim>
[[nodiscard]] std::vector<Point<dim>> points_on_facet(int local, std::span<const Point<dim - 1>> points)
{
  std::vector<Point<dim>> in_cell;
  in_cell.reserve(points.size());
  for (const Point<dim - 1>& s : points) in_cell.push_back(mesh::facet_to_cell<dim>(local, s));
  return in_cell;
}

/// A vector field in a cell, from tabulated values of the basis functions at one point.
template <int dim>
[[nodiscard]] Point<dim> value_at(std::span<const Index> nodes, std::span<const double> u,
                                  std::span<const double> values)
{
  Point<dim> result = Point<dim>::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int a = 0; a < dim; ++a) result[a] += u[static_cast<std::size_t>(dim) * nodes[i] + a] * values[i];
  return result;
}

/// Its gradient, from tabulated reference gradients at one point.
template <int dim>
[[nodiscard]] Tensor<dim> gradient_at(std::span<const Index> nodes, std::span<const double> u,
                                      std::span<const Point<dim>> reference_gradients,
                                      const Tensor<dim>& inverse_transpose)
{
  Tensor<dim> reference = Tensor<dim>::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int a = 0; a < dim; ++a)
      reference.row(a) +=
          u[static_cast<std::size_t>(dim) * nodes[i] + a] * reference_gradients[i].transpose();
  return reference * inverse_transpose.transpose();
}

/// vector_i += f . phi_i for the basis functions of a cell with the given values at one point.
template <int dim>
void add_at_point(std::span<const Index> nodes, std::span<const double> values, const Point<dim>& f,
                  std::span<double> vector)
{
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int a = 0; a < dim; ++a) vector[static_cast<std::size_t>(dim) * nodes[i] + a] += values[i] * f[a];
}

}  // namespace tribound::fem
