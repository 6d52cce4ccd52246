#include "tribound/contact/nitsche/springs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/base/error.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/formula.h"

namespace tribound::contact
{

namespace
{

/// K without the components that are fixed.
template <int dim>
Tensor<dim> on_free(Tensor<dim> stiffness, const problem::BoundaryCondition<dim>& boundary)
{
  for (int a = 0; a < dim; ++a)
    if (boundary.fixes(a))
    {
      stiffness.row(a).setZero();
      stiffness.col(a).setZero();
    }
  return stiffness;
}

/// Largest value and distances of a field on a facet, upper bounds; 0 where it is known only at points.
struct FieldRange
{
  double most = 0;
  double from_low = 0;   ///< from P^low
  double from_high = 0;  ///< from P^{p+2}
  bool is_low = true;    ///< in P^low
};

template <int dim>
FieldRange range_of(const problem::Field& field, const SimplexMap<dim - 1, dim>& map, int low, int high)
{
  if (!field.is_enclosed()) return {.is_low = field.degree() <= low};
  std::array<double, dim * dim> vertices;
  for (int i = 0; i < dim; ++i)
    std::ranges::copy(map(fem::reference_simplex<dim - 1>()[i]), vertices.begin() + i * dim);
  std::array<problem::Enclosure, problem::Formula::max_order + 1> storage;
  const auto taylor = std::span(storage).first(high + 2);
  field.enclose(vertices, dim, taylor);
  FieldRange result{.most = taylor[0].magnitude()};
  if (field.degree() > low) result.from_low = problem::distance_from_polynomials(taylor, low + 1);
  result.is_low = result.from_low == 0;
  if (field.degree() > high) result.from_high = problem::distance_from_polynomials(taylor, high + 1);
  if (!std::isfinite(result.most))
    throw InputError(field.where(),
                     fmt::format("may be unbounded near the point ({:.6g})", fmt::join(map.origin, ", ")),
                     "bound it, such as 1/max(x, 1e-12) for 1/x");
  return result;
}

}  // namespace

template <int dim>
Springs<dim>::Springs(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space)
    : space_(&space)
{
  if (!has_springs(problem)) return;
  rule_ = fem::quadrature<dim - 1>(fem::data_quadrature_degree(space.degree()));
  table_ = fem::tabulate_on_facets<dim>(space.basis(), rule_.points);
  const std::span<const mesh::BoundaryFacet> facets = space.mesh().boundary();
  for (std::size_t number = 0; number < facets.size(); ++number)
    if (const auto& boundary = problem.boundary(facets[number].tag); boundary.spring)
      facets_.push_back(facet(boundary, number));
}

/// The rule is exact for products of K (u - u_0) with itself if K has degree <= 2 and K u_0 degree <= p + 2,
/// and for its integrals against affine functions if both have degree <= p + 2.
template <int dim>
SpringFacet<dim> Springs<dim>::facet(const problem::BoundaryCondition<dim>& boundary,
                                     std::size_t number) const
{
  constexpr int most_of_stiffness = 2;
  const mesh::Mesh<dim>& mesh = space_->mesh();
  const mesh::BoundaryFacet& on = mesh.boundary()[number];
  const problem::Spring<dim>& spring = *boundary.spring;
  const Point<dim> normal = mesh::facet_geometry(mesh, on.cell, on.local).normal;
  const SimplexMap<dim - 1, dim> map = simplex_map(mesh, on);
  const int p = space_->degree();
  const int of_stiffness =
      std::min(most_of_stiffness, std::max(spring.normal.degree(), spring.tangential.degree()));
  const int of_rest = p + 2 - of_stiffness;
  SpringFacet<dim> result{.number = number,
                          .cell = on.cell,
                          .local = on.local,
                          .measure = map.measure,
                          .is_resolved = of_stiffness == 0};
  for (const problem::Field* field : {&spring.normal, &spring.tangential})
  {
    const FieldRange range = range_of<dim>(*field, map, most_of_stiffness, p + 2);
    result.most = std::max(result.most, range.most);
    result.stiffness.remainder = std::max(result.stiffness.remainder, range.from_low);
    result.stiffness.mean_remainder = std::max(result.stiffness.mean_remainder, range.from_high);
    result.stiffness.is_polynomial = result.stiffness.is_polynomial && range.is_low;
  }
  for (const problem::Field& field : spring.rest)
  {
    const FieldRange range = range_of<dim>(field, map, of_rest, p + 2);
    result.rest.remainder = std::hypot(result.rest.remainder, range.from_low);
    result.rest.mean_remainder = std::hypot(result.rest.mean_remainder, range.from_high);
    result.rest.is_polynomial = result.rest.is_polynomial && range.is_low;
    result.is_resolved = result.is_resolved && field.degree() <= p;
  }
  for (int q = 0; q < rule_.size(); ++q)
  {
    const Point<dim> x = map(rule_.points[q]);
    result.weights.push_back(map.measure * rule_.weights[q] * mesh::factorial<dim - 1>);
    result.stiffness.values.push_back(on_free(spring.stiffness(x, normal), boundary));
    Point<dim>& rest = result.rest.values.emplace_back();
    for (int a = 0; a < dim; ++a) rest[a] = spring.rest[a](x);
  }
  return result;
}

/// With polynomials K_h and u_0h, T = -K (u - u_0) and T_h = -K_h (u - u_0h),
/// |T - T_h| <= |K - K_h| |u - u_0h| + |K| |u_0 - u_0h|. The rule misses at most twice as much of norms and
/// integrals, as for loads (datum_moments.h).
template <int dim>
LoadRemainder Springs<dim>::remainder(const SpringFacet<dim>& facet, std::span<const double> u) const
{
  const double root = std::sqrt(facet.measure);
  double apart = 0;
  for (int q = 0; q < rule_.size(); ++q)
    apart += facet.weights[q] * (displacement(facet, u, q) - facet.rest.values[q]).squaredNorm();
  const auto missed = [&](double of_stiffness, double of_rest)
  { return 2 * (of_stiffness * (std::sqrt(apart) + of_rest * root) + facet.most * of_rest * root); };
  return {oscillation(facet, u) + missed(facet.stiffness.remainder, facet.rest.remainder),
          root * missed(facet.stiffness.mean_remainder, facet.rest.mean_remainder)};
}

/// ||T - Pi T|| by the rule, Pi the projection on P^p.
template <int dim>
double Springs<dim>::oscillation(const SpringFacet<dim>& facet, std::span<const double> u) const
{
  if (facet.is_resolved) return 0;
  const int p = space_->degree();
  const int n = fem::polynomial_dimension(dim - 1, p);
  std::vector<double> theta(static_cast<std::size_t>(n) * rule_.size());
  std::vector<Point<dim>> moments(n, Point<dim>::Zero());
  for (int q = 0; q < rule_.size(); ++q)
  {
    const std::span<double> at_q = std::span(theta).subspan(static_cast<std::size_t>(q) * n, n);
    fem::orthonormal_values<dim - 1>(p, rule_.points[q], at_q);
    for (int i = 0; i < n; ++i) moments[i] += rule_.weights[q] * at_q[i] * traction(facet, u, q);
  }
  double squares = 0;
  for (int q = 0; q < rule_.size(); ++q)
  {
    Point<dim> rest = traction(facet, u, q);
    for (int i = 0; i < n; ++i) rest -= theta[static_cast<std::size_t>(q) * n + i] * moments[i];
    squares += facet.weights[q] * rest.squaredNorm();
  }
  return std::sqrt(squares);
}

template <int dim>
bool Springs<dim>::has_polynomial_stiffness() const
{
  return !space_->mesh().ranks().any(
      std::ranges::any_of(facets_, [](const auto& facet) { return !facet.stiffness.is_polynomial; }));
}

template <int dim>
bool Springs<dim>::has_polynomial_rest() const
{
  return !space_->mesh().ranks().any(
      std::ranges::any_of(facets_, [](const auto& facet) { return !facet.rest.is_polynomial; }));
}

template <int dim>
Point<dim> Springs<dim>::force(int tag, std::span<const double> u) const
{
  const mesh::Mesh<dim>& mesh = space_->mesh();
  Point<dim> sum = Point<dim>::Zero();
  for (const SpringFacet<dim>& facet : facets_)
  {
    if (facet.number >= mesh.n_owned_boundary() || mesh.boundary()[facet.number].tag != tag) continue;
    for (int q = 0; q < rule_.size(); ++q) sum += facet.weights[q] * traction(facet, u, q);
  }
  mesh.ranks().sum(std::span(sum.data(), dim));
  return sum;
}

template <int dim>
const SpringFacet<dim>* Springs<dim>::on(std::size_t number) const
{
  const auto found = std::ranges::lower_bound(facets_, number, {}, &SpringFacet<dim>::number);
  return found == facets_.end() || found->number != number ? nullptr : &*found;
}

template <int dim>
Point<dim> Springs<dim>::displacement(const SpringFacet<dim>& facet, std::span<const double> u, int q) const
{
  return fem::value_at<dim>(space_->cell_nodes(facet.cell), u, values_at(facet, q));
}

template <int dim>
void Springs<dim>::add_forces(std::span<const double> u, std::span<double> vector) const
{
  add([&](const SpringFacet<dim>& facet, int q) -> Point<dim>
      { return facet.stiffness.values[q] * displacement(facet, u, q); },
      vector);
}

template <int dim>
void Springs<dim>::add_rest(std::span<double> vector) const
{
  add([](const SpringFacet<dim>& facet, int q) -> Point<dim>
      { return facet.stiffness.values[q] * facet.rest.values[q]; },
      vector);
}

template <int dim>
void Springs<dim>::add_products(std::span<const double> u, std::span<const double> v,
                                std::span<double> products) const
{
  for (const SpringFacet<dim>& facet : facets_)
  {
    if (facet.cell >= space_->mesh().n_owned_cells()) continue;
    for (int q = 0; q < static_cast<int>(facet.weights.size()); ++q)
      products[facet.cell] +=
          facet.weights[q] *
          displacement(facet, v, q).dot(facet.stiffness.values[q] * displacement(facet, u, q));
  }
}

template <int dim>
double Springs<dim>::energy(std::span<const double> u) const
{
  double sum = 0;
  for (const SpringFacet<dim>& facet : facets_)
  {
    if (facet.number >= space_->mesh().n_owned_boundary()) continue;
    for (int q = 0; q < rule_.size(); ++q)
      sum += facet.weights[q] * traction(facet, u, q).dot(facet.rest.values[q] - displacement(facet, u, q));
  }
  return space_->mesh().ranks().sum(sum);
}

template <int dim>
Tensor<dim> Springs<dim>::block(const SpringFacet<dim>& facet, int i, int j) const
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (std::size_t q = 0; q < facet.weights.size(); ++q)
  {
    const std::span<const double> phi = values_at(facet, static_cast<int>(q));
    sum += facet.weights[q] * phi[i] * phi[j] * facet.stiffness.values[q];
  }
  return sum;
}

template class Springs<2>;
template class Springs<3>;

}  // namespace tribound::contact
