#include "tribound/doctor/pair_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/doctor/contact_facts.h"
#include "tribound/mesh/geometry.h"

namespace tribound::doctor
{

namespace
{

template <int dim>
void add_segment(const contact::NitscheForm<dim>& form, std::size_t k, mesh::BoundingBox<dim>& box,
                 PairFacts& facts)
{
  const contact::ContactSegment<dim>& segment = form.segments()[k];
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::SimplexMap<dim - 1, dim> slave = contact::simplex_map(mesh, segment.slave);
  const contact::SimplexMap<dim - 1, dim> master = contact::simplex_map(mesh, *segment.master);
  ++facts.segments;
  facts.covered_share += segment.measure;
  for (const contact::ContactPoint<dim>& point : form.contact_points(k))
    facts.smallest_gap = std::min(facts.smallest_gap, std::abs(point.gap) / segment.h);
  const double stretch = std::max(master.measure / slave.measure, slave.measure / master.measure);
  if (stretch > facts.stretch)
  {
    facts.stretch = stretch;
    facts.stretch_at = place<dim>(slave(Point<dim - 1>::Constant(1.0 / dim)));
  }
  for (const Point<dim - 1>& s : fem::reference_simplex<dim - 1>())
  {
    box.add(slave(s));
    const double distance = (master(s) - slave(s)).norm();
    if (distance <= facts.distance) continue;
    facts.distance = distance;
    facts.distance_at = place<dim>(slave(s));
  }
}

}  // namespace

template <int dim>
std::vector<PairFacts> pair_facts(const contact::NitscheForm<dim>& form)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::vector<PairFacts> result;
  for (const problem::ContactPair<dim>& pair : form.problem().pairs())
  {
    PairFacts& facts = result.emplace_back();
    facts.name =
        fmt::format("\"{}\" on \"{}\"", fmt::join(pair.slave, "\", \""), fmt::join(pair.master, "\", \""));
    facts.is_tied = cone(pair.contact.law).is_tied;
    facts.geometric_gap = !pair.contact.gap;
    facts.smallest_gap = std::numeric_limits<double>::infinity();
    mesh::BoundingBox<dim> box;
    for (std::size_t k = 0; k < form.segments().size(); ++k)
      if (form.segments()[k].pair == static_cast<int>(result.size()) - 1) add_segment(form, k, box, facts);
    facts.size = box.diagonal();
    double slave = 0;
    for (const std::size_t number : mesh::facets_named(mesh, pair.slave))
      slave += contact::simplex_map(mesh, mesh.boundary()[number]).measure;
    facts.covered_share /= slave;
  }
  for (const auto& [k, l] : contact_neighbours(form))
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    if (segment.pair < 0) continue;
    PairFacts& facts = result[segment.pair];
    const auto outward = [&mesh](const mesh::BoundaryFacet& facet)
    { return mesh::facet_geometry(mesh, facet.cell, facet.local).normal; };
    const double turn =
        degrees_between<dim>(outward(segment.slave.facet), outward(form.segments()[l].slave.facet));
    if (turn <= facts.turn) continue;
    facts.turn = turn;
    facts.turn_at =
        place<dim>(contact::simplex_map(mesh, segment.slave)(Point<dim - 1>::Constant(1.0 / dim)));
  }
  return result;
}

template std::vector<PairFacts> pair_facts(const contact::NitscheForm<2>&);
template std::vector<PairFacts> pair_facts(const contact::NitscheForm<3>&);

}  // namespace tribound::doctor
