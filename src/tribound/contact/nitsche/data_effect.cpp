#include "tribound/contact/nitsche/data_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tribound/contact/nitsche/given_data.h"
#include "tribound/contact/nitsche/initial_stress.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/formula.h"

namespace tribound::contact
{

namespace
{

/// An upper bound of |f| on a cell or facet; terms without a bound count as 0.
template <int k, int dim, int n>
double largest_value(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map)
{
  const std::array<double, (k + 1)* dim> vertices = corner_coordinates(map, fem::reference_simplex<k>());
  Point<n> size = Point<n>::Zero();
  for (const auto& [value, direction] : datum.terms)
  {
    std::array<problem::Enclosure, 1> range;
    value->enclose(vertices, dim, range);
    if (range[0].bounded()) size += range[0].magnitude() * direction.cwiseAbs();
  }
  return size.norm();
}

/// The effect of interferences, g < 0, at points of the segments: the stress that they cause across the body,
/// as prescribed displacements do.
template <int dim>
double effect_of_interference(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                              std::span<const ContactSegment<dim>> segments,
                              std::span<const Point<dim - 1>> points, double size, double volume)
{
  std::vector<Point<dim>> places(points.size());
  std::vector<double> gaps(points.size());
  std::array<double, 2> most{};
  auto& [stiffest, interference] = most;
  for (const ContactSegment<dim>& segment : segments)
  {
    if (!segment.contact->gap) continue;
    const problem::Material& material = problem.material(mesh.region(segment.slave.facet.cell));
    stiffest = std::max(stiffest, material.lambda + 2 * material.mu);
    const SimplexMap<dim - 1, dim> map = simplex_map(mesh, segment.slave);
    std::ranges::transform(points, places.begin(), map);
    segment.contact->gap->template evaluate<dim>(places, gaps);
    interference = std::max(interference, -std::ranges::min(gaps));
  }
  mesh.ranks().max(std::span(most));
  return stiffest * interference / size * std::sqrt(volume);
}

/// The effect of the water pressure, as of a traction: size^{1/2} ||p_w||.
template <int dim>
double effect_of_water(const mesh::Mesh<dim>& mesh, std::span<const ContactSegment<dim>> segments,
                       double size)
{
  double squares = 0;
  for (const ContactSegment<dim>& segment : segments)
  {
    if (!segment.contact->water || !is_owned(mesh, segment)) continue;
    const Datum<dim, 1> pressure{{{&segment.contact->water->pressure(), Point<1>(1.0)}}};
    const SimplexMap<dim - 1, dim> map = simplex_map(mesh, segment.slave);
    squares += segment.measure * std::pow(largest_value(pressure, map), 2);
  }
  return std::sqrt(size * mesh.ranks().sum(squares));
}

/// The effect of loads, in the dual norm: size ||f|| + size^{1/2} ||g_N|| + ||sigma_0||; plus that of
/// prescribed displacements: the stress that they cause across the body.
template <int dim>
double effect_of_loads(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, double size)
{
  std::array<double, 4> sums{};
  auto& [body, volume, traction, initial] = sums;
  std::array<double, 2> most{};
  auto& [stiffest, displacement] = most;
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const SimplexMap<dim, dim> map = simplex_map(mesh, c);
    body += map.measure * std::pow(largest_value(body_datum(problem, mesh, c), map), 2);
    volume += map.measure;
    if (const int region = mesh.region(c); problem.regions()[region].has_initial_stress())
      initial += map.measure * (std::pow(largest_value(initial_stress_datum(problem, region), map), 2) +
                                std::pow(largest_value(initial_hoop_datum(problem, region), map), 2));
    const problem::Material& material = problem.material(mesh.region(c));
    stiffest = std::max(stiffest, material.lambda + 2 * material.mu);
  }
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = problem.boundary(facet.tag);
    const SimplexMap<dim - 1, dim> map = simplex_map(mesh, facet);
    traction += map.measure * std::pow(largest_value(traction_datum(problem, mesh, facet), map), 2);
    Datum<dim> prescribed;
    for (int i = 0; i < dim; ++i)
      if (boundary.clamps(i)) prescribed.terms.push_back({&*boundary.displacement[i], Point<dim>::Unit(i)});
    displacement = std::max(displacement, largest_value(prescribed, map));
  }
  mesh.ranks().sum(std::span(sums));
  mesh.ranks().max(std::span(most));
  return size * std::sqrt(body) + std::sqrt(size * traction) + std::sqrt(initial) +
         stiffest * displacement / size * std::sqrt(volume);
}

}  // namespace

template <int dim>
double largest_effect(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                      std::span<const ContactSegment<dim>> segments, std::span<const Point<dim - 1>> points,
                      double volume)
{
  const double size = mesh::box_around(mesh).diagonal();
  const double of_loads = effect_of_loads<dim>(problem, mesh, size);
  const double of_interference = effect_of_interference<dim>(problem, mesh, segments, points, size, volume);
  return of_loads + of_interference + effect_of_water<dim>(mesh, segments, size);
}

template double largest_effect(const problem::Problem<2>&, const mesh::Mesh<2>&,
                               std::span<const ContactSegment<2>>, std::span<const Point<1>>, double);
template double largest_effect(const problem::Problem<3>&, const mesh::Mesh<3>&,
                               std::span<const ContactSegment<3>>, std::span<const Point<2>>, double);

}  // namespace tribound::contact
