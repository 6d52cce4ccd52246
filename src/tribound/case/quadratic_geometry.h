#pragma once

/// @file quadratic_geometry.h
/// Gaps and directions on a body whose true surface consists of the second-order facets of its mesh.

#include <memory>
#include <optional>

#include "tribound/mesh/quadratic_surface.h"
#include "tribound/problem/surface.h"

namespace tribound::case_file
{

/// The analogue of problem::ContactGeometry, which is for formulas. Here X is a polynomial of degree 2 on
/// each facet of the mesh that was read. Enclosures of functions of X are therefore over points of one facet.
template <int dim>
struct QuadraticGeometry
{
  std::optional<problem::Surface> obstacle{};
  std::shared_ptr<const mesh::QuadraticSurface<dim>> shape{};
  Where where{};
};

/// g(x) = phi(X(x)). Needs an obstacle.
template <int dim>
[[nodiscard]] problem::Field gap_of(const QuadraticGeometry<dim>& geometry);
/// N(x) = -grad phi(X(x)). Needs an obstacle.
template <int dim>
[[nodiscard]] problem::NormalField direction_of_obstacle(const QuadraticGeometry<dim>& geometry);
/// mesh::QuadraticSurface::normal().
template <int dim>
[[nodiscard]] problem::NormalField direction_of_shape(const QuadraticGeometry<dim>& geometry);
/// (x - X(x)) . N(x): > 0 outside the body.
template <int dim>
[[nodiscard]] problem::Field distance_of_shape(const QuadraticGeometry<dim>& geometry);

}  // namespace tribound::case_file
