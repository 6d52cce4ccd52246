#pragma once

/// @file foreign_nodes.h
/// Where the nodes of another program's simplices are, and the functions that belong to them. Internal to
/// foreign_solution.cpp.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/import/simplex_nodes.h"

namespace tribound::certify
{

/// A value as a sum of weights times values at the nodes of an element.
using ValueRule = std::vector<std::pair<int, double>>;

/// Weights from here on are not rounding, which must not ask for a value that nothing depends on.
inline constexpr double no_weight = 1e-13;

template <int dim>
using Barycentric = std::array<double, dim + 1>;

/// The point `y` of the reference simplex.
template <int dim>
Barycentric<dim> barycentric(const Point<dim>& y)
{
  Barycentric<dim> lambda;
  lambda[0] = 1 - y.sum();
  std::ranges::copy(y, lambda.begin() + 1);
  return lambda;
}

/// x = x_0 + J xhat in a simplex with these corners.
template <int dim>
Point<dim> coordinates(const std::array<Point<dim>, dim + 1>& corners, const Point<dim>& x)
{
  Tensor<dim> jacobian;
  for (int j = 0; j < dim; ++j) jacobian.col(j) = corners[j + 1] - corners[0];
  const Tensor<dim> cofactor = mesh::cofactor<dim>(jacobian);
  return cofactor.transpose() * (x - corners[0]) / jacobian.col(0).dot(cofactor.col(0));
}

/// The nodes of a block of simplices. They are equidistant; of order 3 and 4 they may have other places that
/// are the same in all elements, such as those of Gauss and Lobatto in FEniCSx. Else the elements are curved.
template <int dim>
class ForeignNodes
{
 public:
  /// `nodes`: of the whole file. Nodes within the tolerance of their places count as there.
  ForeignNodes(const mesh::ElementBlock& block, std::span<const Point<dim>> nodes, double tolerance)
      : block_(block), nodes_(nodes), lattice_(mesh::simplex_nodes(block.type))
  {
    const int order = mesh::order_of(block.type);
    std::vector<Barycentric<dim>> places(lattice_.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      for (int v = 0; v <= dim; ++v) places[i][v] = static_cast<double>(lattice_[i][v]) / order;
    curved_distance_ = largest_distance(places);
    if (order < 3 || curved_distance_ <= tolerance) return;
    places = mean_places();
    if (!are_on_their_faces(places) || !(largest_distance(places) <= tolerance)) return;
    const Eigen::MatrixXd functions = functions_at(places);
    constexpr double too_large = 1e6;  // where nodes lie at one place
    if (!functions.allFinite() || functions.cwiseAbs().maxCoeff() > too_large) return;
    curved_distance_ = 0;
    functions_ = functions;
  }

  /// Of a node from its place in the straight element.
  [[nodiscard]] double curved_distance() const { return curved_distance_; }
  [[nodiscard]] bool are_equidistant() const { return functions_.size() == 0; }

  [[nodiscard]] ValueRule rule(const Barycentric<dim>& lambda) const
  {
    std::vector<double> weights(lattice_.size(), 0);
    for (std::size_t a = 0; a < lattice_.size(); ++a)
    {
      const double value = mesh::shape_function(lattice_[a], lambda);
      if (are_equidistant())
        weights[a] = value;
      else if (std::abs(value) > no_weight)
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] += value * functions_(a, i);
    }
    ValueRule rule;
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (std::abs(weights[i]) > no_weight) rule.emplace_back(static_cast<int>(i), weights[i]);
    return rule;
  }

 private:
  [[nodiscard]] std::array<Point<dim>, dim + 1> corners_of(std::size_t element) const
  {
    std::array<Point<dim>, dim + 1> corners;
    for (int v = 0; v <= dim; ++v) corners[v] = nodes_[block_.element(element)[v]];
    return corners;
  }

  [[nodiscard]] double largest_distance(std::span<const Barycentric<dim>> places) const
  {
    double largest = 0;
    for (std::size_t e = 0; e < block_.size(); ++e)
    {
      const auto corners = corners_of(e);
      for (std::size_t i = 0; i < places.size(); ++i)
      {
        Point<dim> place = Point<dim>::Zero();
        for (int v = 0; v <= dim; ++v) place += places[i][v] * corners[v];
        largest = std::max(largest, (nodes_[block_.element(e)[i]] - place).norm());
      }
    }
    return largest;
  }

  [[nodiscard]] std::vector<Barycentric<dim>> mean_places() const
  {
    std::vector<Barycentric<dim>> places(lattice_.size(), Barycentric<dim>{});
    for (std::size_t e = 0; e < block_.size(); ++e)
    {
      const auto corners = corners_of(e);
      for (std::size_t i = 0; i < places.size(); ++i)
      {
        const auto lambda = barycentric<dim>(coordinates<dim>(corners, nodes_[block_.element(e)[i]]));
        for (int v = 0; v <= dim; ++v) places[i][v] += lambda[v] / static_cast<double>(block_.size());
      }
    }
    return places;
  }

  /// Whether those of corners, edges and faces are on these and nowhere else, so that the element is the
  /// simplex.
  [[nodiscard]] bool are_on_their_faces(std::span<const Barycentric<dim>> places) const
  {
    constexpr double nearly_zero = 1e-3;
    for (std::size_t i = 0; i < places.size(); ++i)
      for (int v = 0; v <= dim; ++v)
        if (!(lattice_[i][v] == 0 ? std::abs(places[i][v]) < nearly_zero : places[i][v] > nearly_zero))
          return false;
    return true;
  }

  /// The functions of nodes at these places.
  [[nodiscard]] Eigen::MatrixXd functions_at(std::span<const Barycentric<dim>> places) const
  {
    const auto n = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd values(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index a = 0; a < n; ++a) values(i, a) = mesh::shape_function(lattice_[a], places[i]);
    return inverse_of(values);
  }

  const mesh::ElementBlock& block_;
  std::span<const Point<dim>> nodes_;
  const std::vector<mesh::NodeIndex>& lattice_;
  double curved_distance_ = 0;
  Eigen::MatrixXd functions_{};  ///< at the equidistant places, one per column; empty: those of these places
};

}  // namespace tribound::certify
