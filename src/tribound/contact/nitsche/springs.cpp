#include "tribound/contact/nitsche/springs.h"

#include <algorithm>
#include <cmath>

#include "tribound/fem/polynomials.h"

namespace tribound::contact
{

template <int dim>
Springs<dim>::Springs(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space)
    : space_(&space)
{
  if (!problem.has_springs()) return;
  rule_ = fem::quadrature<dim - 1>(data_exactness(problem, space.degree()));
  table_ = fem::tabulate_on_facets<dim>(space.basis(), rule_.points);
  const mesh::Mesh<dim>& mesh = space.mesh();
  mesh.ranks().together(
      [&]
      {
        for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
          if (problem.boundary(mesh.boundary()[number].tag).spring)
            facets_.push_back(spring_facet(problem, mesh, number, space.degree(), rule_));
      });
}

template <int dim>
double Springs<dim>::plain_weight(const SpringFacet<dim>& facet, int q) const
{
  return facet.measure * rule_.weights[q] * mesh::factorial<dim - 1>;
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
    apart += plain_weight(facet, q) * (displacement(facet, u, q) - facet.rest.values[q]).squaredNorm();
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
    squares += plain_weight(facet, q) * rest.squaredNorm();
  }
  return std::sqrt(squares);
}

template <int dim>
std::string Springs<dim>::why_unclear() const
{
  const Ranks& ranks = space_->mesh().ranks();
  const auto on_any = [&](const auto& condition)
  { return ranks.any(std::ranges::any_of(facets_, condition)); };
  if (on_any([](const SpringFacet<dim>& facet) { return !facet.stiffness.is_polynomial; }))
    return "the stiffness of a spring is no polynomial of degree 2";
  if (on_any([](const SpringFacet<dim>& facet) { return !facet.is_nonnegative; }))
    return "the stiffness of a spring is negative somewhere";
  return {};
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
