#pragma once

/// @file spring_facet.h
/// The data of springs on one boundary facet.

#include <cstddef>
#include <vector>

#include "tribound/fem/quadrature.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A datum of springs at the points of a facet.
template <class Value>
struct SpringDatum
{
  std::vector<Value> values{};
  double remainder = 0;       ///< >= what products of K (u - u_0) with itself see of its distance from P^m
  double mean_remainder = 0;  ///< >= its distance from P^{p+2}
  bool is_polynomial = true;  ///< of degree m
};

/// K and u_0 on a boundary facet, at the points of the rule exact to data_exactness(). Components
/// that Gamma_D fixes have no spring: K is restricted to the others.
template <int dim>
struct SpringFacet
{
  std::size_t number;  ///< in Mesh::boundary()
  Index cell;
  int local;
  double measure;
  double most = 0;                       ///< >= |K|
  bool is_resolved;                      ///< K (u - u_0) is in P^p
  std::vector<double> weights{};         ///< of the rule, times measure, on a meridian times r
  SpringDatum<Tensor<dim>> stiffness{};  ///< m = 2
  SpringDatum<Point<dim>> rest{};        ///< m = p + 2, less the degree of K
  bool is_nonnegative = true;            ///< K, everywhere on the facet; known if K has degree 2
};

/// The spring of a problem on the facet with this number, for displacements of degree p. The rule is exact
/// for products of K (u - u_0) with itself if K has degree <= 2 and K u_0 degree <= p + 2, and for its
/// integrals against affine functions if both have degree <= p + 2. Throws InputError where K is negative at
/// a point or may be unbounded.
template <int dim>
[[nodiscard]] SpringFacet<dim> spring_facet(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                            std::size_t number, int degree,
                                            const fem::Quadrature<dim - 1>& rule);

}  // namespace tribound::contact
