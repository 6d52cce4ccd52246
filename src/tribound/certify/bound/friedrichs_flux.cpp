#include "tribound/certify/bound/friedrichs_flux.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tribound/base/parallel.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// -grad phi . n |F| for each facet, outward of its first cell, from the Raviart-Thomas field
/// -grad phi_h + (x - x_T) / d of the Crouzeix-Raviart solution phi_h; seen from the two cells of a facet,
/// the mean of both.
template <int dim>
std::vector<double> potential_fluxes(const mesh::Mesh<dim>& mesh, std::span<const double> means)
{
  const mesh::Topology<dim>& topology = mesh.topology();
  std::vector<double> fluxes(means.size(), 0.0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const double volume = map.measure();
    const std::array<Point<dim>, dim + 1> hat_gradients = map.barycentric_gradients();
    Point<dim> gradient = Point<dim>::Zero();
    for (int i = 0; i <= dim; ++i) gradient -= dim * means[topology.cell_facets[c][i]] * hat_gradients[i];
    for (int i = 0; i <= dim; ++i)
    {
      // |F| n = -d |T| grad lambda_i, and (x - x_T).n |F| = d |T| / (d + 1)
      const Index f = topology.cell_facets[c][i];
      const double flux = dim * volume * gradient.dot(hat_gradients[i]) + volume / (dim + 1);
      const bool first = topology.facet_cells[f][0] == c;
      fluxes[f] += (first ? flux : -flux) * (topology.facet_cells[f][1] < 0 ? 1 : 0.5);
    }
  }
  return fluxes;
}

/// Upper limits of the flux of q through each facet: infinity except on the boundary.
template <int dim>
std::vector<double> largest_fluxes(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                   std::span<const char> fixed)
{
  std::vector<double> largest(fixed.size(), std::numeric_limits<double>::infinity());
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    const Index f = mesh.topology().cell_facets[facet.cell][facet.local];
    if (fixed[f]) continue;
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    largest[f] = problem.boundary(facet.tag).is_in_norm() ? geometry.measure / geometry.diameter : 0;
  }
  return largest;
}

/// min(div q - |q|^2): div q is constant in each cell, |q| largest at a vertex. 0 where q is not finite.
template <int dim>
double smallest_value(const mesh::Mesh<dim>& mesh, std::span<const double> fluxes)
{
  const mesh::Topology<dim>& topology = mesh.topology();
  double smallest = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const auto points = mesh::points_of(mesh.vertices(), mesh.cell(c));
    const double volume = mesh::determinant<dim>(points) / mesh::factorial<dim>;
    std::array<double, dim + 1> outward;
    double divergence = 0;
    for (int i = 0; i <= dim; ++i)
    {
      const Index f = topology.cell_facets[c][i];
      outward[i] = topology.facet_cells[f][0] == c ? fluxes[f] : -fluxes[f];
      divergence += outward[i] / volume;
    }
    for (const Point<dim>& x : points)
    {
      Point<dim> q = Point<dim>::Zero();
      for (int i = 0; i <= dim; ++i) q += outward[i] / (dim * volume) * (x - points[i]);
      const double value = divergence - q.squaredNorm();
      if (!std::isfinite(value)) return 0;
      smallest = std::min(smallest, value);
    }
  }
  return smallest;
}

}  // namespace

template <int dim>
double flux_theta(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                  std::span<const char> fixed, std::span<const double> means)
{
  const std::vector<double> potential = potential_fluxes(mesh, means);
  const std::vector<double> largest = largest_fluxes(problem, mesh, fixed);
  constexpr double rounding = 1e-6;
  const double least = std::ranges::max(means) / 64;
  std::array<double, 24> thetas{};
  const int n_threads = max_threads();
  const auto on_thread = [&](int thread)
  {
    std::vector<double> fluxes(potential.size());
    for (std::size_t k = thread; k < thetas.size(); k += n_threads)
    {
      const double c = least * std::pow(1.5, k);
      for (std::size_t f = 0; f < fluxes.size(); ++f)
        fluxes[f] = std::min(potential[f] / (means[f] + c), largest[f]);
      thetas[k] = (1 - rounding) * smallest_value(mesh, fluxes);
    }
  };
  in_threads(n_threads, on_thread);
  return std::max(0.0, std::ranges::max(thetas));
}

template double flux_theta(const problem::Problem<2>&, const mesh::Mesh<2>&, std::span<const char>,
                           std::span<const double>);
template double flux_theta(const problem::Problem<3>&, const mesh::Mesh<3>&, std::span<const char>,
                           std::span<const double>);

}  // namespace tribound::certify
