#include "tribound/certify/energy/obstacle_facets.h"

#include <algorithm>
#include <cmath>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/fem/bernstein.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// [local facet][j]: the node of the cell that is node j of the facet.
template <int dim>
std::array<std::vector<int>, dim + 1> nodes_on_facets(const fem::LagrangeBasis<dim>& of_cell,
                                                      const fem::LagrangeBasis<dim - 1>& of_facet)
{
  std::array<std::vector<int>, dim + 1> result;
  for (int f = 0; f <= dim; ++f)
    for (int j = 0; j < of_facet.n_nodes(); ++j)
      for (int i = 0; i < of_cell.n_nodes(); ++i)
        if (of_cell.node(i)[f] == 0 && mesh::facet_vertices(of_cell.node(i), f) == of_facet.node(j))
          result[f].push_back(i);
  return result;
}

}  // namespace

template <int dim>
std::string obstacles_unfit(const contact::NitscheForm<dim>& form)
{
  const Ranks& ranks = form.space().mesh().ranks();
  const auto any = [&](const auto& what) { return ranks.any(std::ranges::any_of(form.segments(), what)); };
  using Segment = contact::ContactSegment<dim>;
  if (any([](const Segment& segment) { return !segment.is_obstacle_facet(); }))
    return "there is contact between bodies";
  if (any([](const Segment& segment) { return segment.varying_normal != nullptr; }))
    return "a direction of contact varies along facets";
  if (any([](const Segment& segment) { return segment.contact->water.has_value(); }))
    return "there is water in a joint";
  if (any(
          [](const Segment& segment)
          {
            const problem::FrictionCone cone = problem::cone(segment.contact->law);
            return cone.is_tied || cone.is_bonded;
          }))
    return "a contact law has a bond";
  return {};
}

template <int dim>
ObstacleFacets<dim>::ObstacleFacets(const contact::NitscheForm<dim>& form)
    : form_(form),
      basis_(form.space().degree()),
      n_(basis_.n_nodes()),
      to_values_(fem::values_from_bernstein(basis_)),
      from_values_(fem::bernstein_from_values(basis_)),
      gaps_(form.segments().size() * n_, 0.0)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto on_facets = nodes_on_facets<dim>(form.space().basis(), basis_);
  for (std::size_t k = 0; k < size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const mesh::FacetMap<dim> map = mesh::facet_map(mesh, facet.cell, facet.local);
    for (std::size_t j = 0; j < n_; ++j)
    {
      const Index node = form.space().cell_nodes(facet.cell)[on_facets[facet.local][j]];
      const Point<dim - 1> s = basis_.node_point(static_cast<int>(j));
      const Point<dim> x = node < mesh.n_vertices() ? Point<dim>(mesh.vertex(node)) : map(s);
      nodes_.push_back(node);
      nodal_gaps_.push_back(segment.gap(s, x, segment.normal));
    }
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t i = 0; i < n_; ++i)
        gaps_[k * n_ + j] += from_values_[j * n_ + i] * nodal_gaps_[k * n_ + i];
  }
}

template <int dim>
double ObstacleFacets<dim>::gap_remainder() const
{
  const auto& points = form_.facet_rule().points;
  const fem::Tabulation<dim - 1> table = basis_.tabulate(points);
  double largest = 0;
  for (std::size_t k = 0; k < size(); ++k)
    for (int q = 0; q < table.n_points; ++q)
    {
      const contact::ContactSegment<dim>& segment = form_.segments()[k];
      double rest = segment.gap(points[q], form_.contact_points(k)[q].x, segment.normal);
      for (std::size_t i = 0; i < n_; ++i) rest -= table.values_at(q)[i] * nodal_gaps_[k * n_ + i];
      largest = std::max(largest, std::abs(rest));
    }
  return largest;
}

template <int dim>
std::vector<Point<dim>> ObstacleFacets<dim>::transformed(std::size_t k, std::span<const double> matrix,
                                                         std::span<const double> by_node) const
{
  std::vector<Point<dim>> result(n_, Point<dim>::Zero());
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j)
      result[i] += matrix[i * n_ + j] * Eigen::Map<const Point<dim>>(&by_node[dim * nodes(k)[j]]);
  return result;
}

template std::string obstacles_unfit(const contact::NitscheForm<2>&);
template std::string obstacles_unfit(const contact::NitscheForm<3>&);
template class ObstacleFacets<2>;
template class ObstacleFacets<3>;

}  // namespace tribound::certify
