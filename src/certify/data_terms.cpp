#include "certify/data_terms.h"

#include <cmath>
#include <numbers>
#include <span>

#include "fem/polynomials.h"
#include "fem/quadrature.h"

namespace tribound
{

namespace
{

/// The projection of vector functions on P^degree of the reference k-simplex, by a rule.
template <int k, int dim>
class Projection
{
 public:
  Projection(int degree, const Quadrature<k>& rule)
      : rule_(rule), n_(polynomial_dimension(k, degree)), basis_(static_cast<std::size_t>(n_) * rule.size())
  {
    for (int q = 0; q < rule.size(); ++q)
      orthonormal_values<k>(degree, rule.points[q],
                            std::span(basis_).subspan(static_cast<std::size_t>(q) * n_, n_));
  }

  /// The integral of |g - Pi g|^2 over the reference simplex, g given at the points of the rule.
  [[nodiscard]] double squared_remainder(std::span<const Point<dim>> g) const
  {
    std::vector<Point<dim>> projection(n_, Point<dim>::Zero());
    for (int q = 0; q < rule_.size(); ++q)
      for (int j = 0; j < n_; ++j) projection[j] += rule_.weights[q] * basis_[q * n_ + j] * g[q];
    double sum = 0;
    for (int q = 0; q < rule_.size(); ++q)
    {
      Point<dim> difference = g[q];
      for (int j = 0; j < n_; ++j) difference -= basis_[q * n_ + j] * projection[j];
      sum += rule_.weights[q] * difference.squaredNorm();
    }
    return sum;
  }

 private:
  const Quadrature<k>& rule_;
  int n_;
  std::vector<double> basis_;  ///< [q * n + j]
};

template <int dim>
std::vector<double> oscillation(const NitscheForm<dim>& form)
{
  const Mesh<dim>& mesh = form.space().mesh();
  const int p = form.space().degree();
  const Quadrature<dim> rule = quadrature<dim>(data_quadrature_degree(p));
  const Projection<dim, dim> projection(p - 1, rule);
  std::vector<double> osc(mesh.n_cells(), 0.0);
  std::vector<Point<dim>> f(rule.size());
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    if (form.problem().body_force_is_constant(mesh.region(c))) continue;
    const CellMap<dim> map = cell_map(mesh, c);
    for (int q = 0; q < rule.size(); ++q)
      f[q] = form.problem().body_force(mesh.region(c), map(rule.points[q]));
    osc[c] = cell_diameter(mesh, c) / std::numbers::pi * std::sqrt(map.det * projection.squared_remainder(f));
  }
  return osc;
}

/// C_{T,F} = h_T (|F|/|T| (1/pi^2 + 2/(d pi)))^{1/2}.
template <int dim>
double trace_constant(double h, double facet_measure, double volume)
{
  constexpr double pi = std::numbers::pi;
  return h * std::sqrt(facet_measure / volume * (1 / (pi * pi) + 2 / (dim * pi)));
}

template <int dim>
std::vector<double> neumann_terms(const NitscheForm<dim>& form)
{
  const Mesh<dim>& mesh = form.space().mesh();
  const Quadrature<dim - 1>& rule = form.facet_rule();
  const Projection<dim - 1, dim> projection(form.space().degree(), rule);
  std::vector<double> neu(mesh.n_cells(), 0.0);
  std::vector<Point<dim>> g(rule.size());
  for (const BoundaryFacet& facet : mesh.boundary())
  {
    const BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    if (!boundary.is_loaded()) continue;
    const CellMap<dim> map = cell_map(mesh, facet.cell);
    const FacetGeometry<dim> geometry = facet_geometry(mesh, facet.cell, facet.local);
    for (int q = 0; q < rule.size(); ++q)
      g[q] = boundary.load(map(facet_to_cell<dim>(facet.local, rule.points[q])), geometry.normal);
    const double scale = geometry.measure * (dim - 1);  // |F| / |reference facet|
    neu[facet.cell] +=
        trace_constant<dim>(cell_diameter(mesh, facet.cell), geometry.measure, map.det / (dim == 2 ? 2 : 6)) *
        std::sqrt(scale * projection.squared_remainder(g));
  }
  return neu;
}

}  // namespace

template <int dim>
DataTerms data_terms(const NitscheForm<dim>& form)
{
  return {oscillation(form), neumann_terms(form)};
}

template DataTerms data_terms(const NitscheForm<2>&);
template DataTerms data_terms(const NitscheForm<3>&);

}  // namespace tribound
