#include "tribound/certify/bound/contact_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <unordered_map>
#include <vector>

#include "tribound/mesh/geometry.h"
#include "tribound/mesh/quadratic_facets.h"

namespace tribound::certify
{

namespace
{

constexpr double corner = 45;  // degrees

template <int dim>
double degrees_between(const Point<dim>& a, const Point<dim>& b)
{
  return 2 * std::asin(std::min(1.0, (a - b).norm() / 2)) * 180 / std::numbers::pi;
}

/// Normal and direction of a facet at one of its vertices.
template <int dim>
struct AtVertex
{
  int tag;
  std::size_t facet;
  Point<dim> normal;
  Point<dim> direction;
};

/// The largest sagitta of the boundaries that have segments on this rank.
template <int dim>
double straightened(const contact::NitscheForm<dim>& form)
{
  const auto& facets = form.space().mesh().labels().quadratic_facets;
  if (!facets) return 0;
  std::set<int> tags;
  for (const contact::ContactSegment<dim>& segment : form.segments())
    if (!segment.contact->true_surface && !cone(segment.contact->law).is_tied)
      tags.insert(segment.slave.facet.tag);
  double largest = 0;
  for (const int tag : tags) largest = std::max(largest, mesh::sagitta<dim>(*facets, tag));
  return largest;
}

}  // namespace

template <int dim>
ContactGeometryFacts contact_geometry(const contact::NitscheForm<dim>& form)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  ContactGeometryFacts facts;
  std::unordered_map<Index, std::vector<AtVertex<dim>>> at;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const problem::Contact& contact = *segment.contact;
    if (cone(contact.law).is_tied) continue;
    facts.has_shape = facts.has_shape || contact.true_surface;
    facts.has_direction = facts.has_direction || contact.normal;
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const Point<dim> normal = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
    const auto look = [&](const Point<dim>& x, const Point<dim>& direction)
    {
      facts.off_normal = std::max(facts.off_normal, degrees_between<dim>(normal, direction));
      if (contact.true_surface) facts.sagitta = std::max(facts.sagitta, std::abs((*contact.true_surface)(x)));
    };
    for (const contact::ContactPoint<dim>& point : form.contact_points(k)) look(point.x, point.normal);
    const contact::SimplexMap<dim - 1, dim> map = contact::simplex_map(mesh, segment.slave);
    const Point<dim> centre = map(Point<dim - 1>::Constant(1.0 / dim));
    look(centre, segment.normal_at(centre));
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
    {
      const Point<dim> direction = segment.normal_at(mesh.vertex(v));
      look(mesh.vertex(v), direction);
      for (const AtVertex<dim>& other : at[v])
      {
        const double turn = degrees_between<dim>(normal, other.normal);
        if (other.tag != facet.tag || other.facet == segment.slave.number || turn > corner) continue;
        facts.turn = std::max(facts.turn, turn);
        facts.jump = std::max(facts.jump, degrees_between<dim>(direction, other.direction));
      }
      at[v].push_back({facet.tag, segment.slave.number, normal, direction});
    }
  }
  std::array<double, 7> all{static_cast<double>(facts.has_shape),
                            static_cast<double>(facts.has_direction),
                            facts.sagitta,
                            straightened(form),
                            facts.turn,
                            facts.jump,
                            facts.off_normal};
  mesh.ranks().max(std::span(all));
  return {all[0] > 0, all[1] > 0, all[2], all[3], all[4], all[5], all[6]};
}

template ContactGeometryFacts contact_geometry(const contact::NitscheForm<2>&);
template ContactGeometryFacts contact_geometry(const contact::NitscheForm<3>&);

}  // namespace tribound::certify
