#include "tribound/doctor/damage_facts.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "tribound/contact/nitsche/interface_check.h"

namespace tribound::doctor
{

namespace
{

/// A facet of a slave, all its segments together.
struct FacetDamage
{
  double measure = 0;
  double softened = 0;  ///< measure of the points where 0 < D < 1
  bool is_broken = true;
};

using DamageByFacet = std::map<std::pair<Index, int>, FacetDamage>;  // by cell and local number

template <int dim>
DamageByFacet damage_by_facet(const contact::NitscheForm<dim>& form,
                              std::span<const SegmentStates<dim>> states, int tag)
{
  DamageByFacet facets;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    if (segment.slave.facet.tag != tag) continue;
    FacetDamage& facet = facets[{segment.slave.facet.cell, segment.slave.facet.local}];
    const auto points = form.contact_points(k);
    for (std::size_t q = 0; q < points.size(); ++q)
    {
      const double damage = states[k][q].state.damage;
      facet.measure += points[q].weight;
      if (damage > 0 && damage < 1) facet.softened += points[q].weight;
      facet.is_broken = facet.is_broken && damage >= 1;
    }
  }
  return facets;
}

/// Vertices (2D) or edges (3D) between broken and other facets.
template <int dim>
int count_fronts(const mesh::Mesh<dim>& mesh, const DamageByFacet& facets)
{
  std::map<std::array<Index, dim - 1>, bool> waiting;  // whether the first adjacent facet is broken
  int fronts = 0;
  for (const auto& [number, facet] : facets)
  {
    const auto vertices = mesh::facet_vertices(mesh.cell(number.first), number.second);
    for (int left_out = 0; left_out < dim; ++left_out)
    {
      std::array<Index, dim - 1> ridge = mesh::facet_vertices(vertices, left_out);
      std::ranges::sort(ridge);
      const auto [other, is_new] = waiting.try_emplace(ridge, facet.is_broken);
      if (!is_new && other->second != facet.is_broken) ++fronts;
    }
  }
  return fronts;
}

template <int dim>
std::optional<double> process_zone(const mesh::Mesh<dim>& mesh, const DamageByFacet& facets)
{
  double softened = 0;
  double measure = 0;
  int n_softened = 0;
  for (const auto& [number, facet] : facets)
  {
    if (facet.softened == 0) continue;
    softened += facet.softened;
    measure += facet.measure;
    ++n_softened;
  }
  const int fronts = n_softened > 0 ? count_fronts(mesh, facets) : 0;
  if (fronts == 0) return std::nullopt;
  return softened / (measure / n_softened * fronts * (dim - 1));
}

}  // namespace

template <int dim>
DamageFacts damage_facts(const contact::NitscheForm<dim>& form, std::span<const SegmentStates<dim>> states,
                         int tag)
{
  DamageFacts facts;
  const auto* const joint = std::get_if<problem::JointLaw>(&form.problem().contact(tag)->law);
  if (joint && joint->tension.strength == 0) facts.open_cohesion = joint->cohesion;
  const contact::SofteningMargin margin = contact::softening_margin(form, tag);
  if (margin.ratio == 0) return facts;
  const contact::ContactSegment<dim>& segment = form.segments()[margin.segment];
  facts.softening = {.slope = problem::softening_slope(segment.contact->law),
                     .gamma = segment.gamma,
                     .h = segment.h,
                     .where = place<dim>(form.contact_points(margin.segment)[0].x)};
  facts.process_zone = process_zone(form.space().mesh(), damage_by_facet(form, states, tag));
  return facts;
}

template DamageFacts damage_facts(const contact::NitscheForm<2>&, std::span<const SegmentStates<2>>, int);
template DamageFacts damage_facts(const contact::NitscheForm<3>&, std::span<const SegmentStates<3>>, int);

}  // namespace tribound::doctor
