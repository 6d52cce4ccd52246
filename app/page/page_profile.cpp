#include "app/page/page_profile.h"

#include <algorithm>

#include "tribound/fem/evaluation.h"
#include "tribound/io/fields/contact_line.h"
#include "tribound/mesh/bodies.h"

namespace tribound::app
{

namespace
{

/// n + 1 points from 0 to 1.
std::vector<Point<1>> even_points(std::size_t n)
{
  std::vector<Point<1>> points;
  for (std::size_t i = 0; i <= n; ++i) points.emplace_back(static_cast<double>(i) / static_cast<double>(n));
  return points;
}

void add_point(ContactProfile& profile, const contact::ContactState<2>& state, double arc)
{
  const Point<2> tangent(-state.normal[1], state.normal[0]);
  profile.arc.push_back(arc);
  profile.points.insert(profile.points.end(), state.point.begin(), state.point.end());
  profile.displacement.insert(profile.displacement.end(), state.displacement.begin(),
                              state.displacement.end());
  profile.normal.insert(profile.normal.end(), state.normal.begin(), state.normal.end());
  profile.pressure.push_back(state.pressure);
  profile.friction.push_back(state.traction.dot(tangent));
  profile.limit.push_back(state.limit);
  profile.gap.push_back(state.gap);
  profile.slip.push_back(state.slip.dot(tangent));
  profile.status.push_back(static_cast<Index>(state.status));
}

/// The history of a joint, and its water pressure.
void add_joint(ContactProfile& profile, const problem::Contact& contact,
               const contact::ContactState<2>& state)
{
  if (cone(contact.law).is_bonded)
  {
    profile.damage.push_back(state.state.damage);
    profile.opening.push_back(state.opening);
  }
  if (contact.water) profile.water.push_back(state.water);
}

/// Pi(x) for point number q of the table.
void add_opposite(ContactProfile& profile, const contact::NitscheForm<2>& form, std::span<const double> u,
                  const contact::SegmentSide<2>& master, const contact::SegmentTable<2>& table, std::size_t q)
{
  const Point<2> point = contact::simplex_map(form.space().mesh(), master)(table.points[q]);
  const Point<2> displacement = fem::value_at<2>(form.space().cell_nodes(master.facet.cell), u,
                                                 table.master->values_at(static_cast<int>(q)));
  profile.opposite.insert(profile.opposite.end(), point.begin(), point.end());
  profile.opposite_displacement.insert(profile.opposite_displacement.end(), displacement.begin(),
                                       displacement.end());
}

ContactProfile contact_profile(const contact::NitscheForm<2>& form, std::span<const double> u,
                               std::span<const int> body_of, int tag, std::size_t n_points)
{
  ContactProfile profile;
  profile.tag = tag;
  const std::vector<io::ChainLink> links = io::contact_chains(form, tag);
  if (links.empty()) return profile;
  const std::size_t n = std::clamp<std::size_t>(n_points / links.size(), form.space().degree(), 16);
  const std::vector<Point<1>> points = even_points(n);
  const contact::SegmentTables<2> tables(form.space().basis(), form.segments(), points);
  for (const io::ChainLink& link : links)
  {
    const contact::ContactSegment<2>& segment = form.segments()[link.segment];
    const std::vector<contact::ContactState<2>> states =
        form.contact_states(u, link.segment, tables[link.segment]);
    for (std::size_t i = 0; i <= n; ++i)
    {
      const std::size_t q = link.reversed ? n - i : i;
      add_point(profile, states[q], link.arc + segment.measure * points[i][0]);
      add_joint(profile, *segment.contact, states[q]);
      profile.bodies.push_back(body_of[segment.slave.facet.cell]);
      if (!segment.master) continue;
      add_opposite(profile, form, u, *segment.master, tables[link.segment], q);
      profile.opposite_bodies.push_back(body_of[segment.master->facet.cell]);
    }
  }
  return profile;
}

}  // namespace

std::vector<ContactProfile> contact_profiles(const contact::NitscheForm<2>& form, std::span<const double> u,
                                             std::size_t n_points)
{
  const std::vector<int> body_of = mesh::number_bodies(form.space().mesh()).of_cell;
  std::vector<ContactProfile> profiles;
  const auto boundaries = form.problem().boundaries();
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
    if (form.problem().contact(tag) != nullptr)
      profiles.push_back(contact_profile(form, u, body_of, tag, n_points));
  return profiles;
}

}  // namespace tribound::app
