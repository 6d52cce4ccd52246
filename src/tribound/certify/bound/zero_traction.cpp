#include "tribound/certify/bound/zero_traction.h"

#include <algorithm>
#include <array>

namespace tribound::certify
{

namespace
{

/// Whether the formula of the gap is proved to be nonnegative on a part of a segment.
template <int dim>
bool is_gap(const problem::Field& gap, const contact::SimplexMap<dim - 1, dim>& map,
            const fem::Part<dim - 1>& part)
{
  std::array<problem::Enclosure, 1> range;
  gap.enclose(contact::corner_coordinates(map, part), dim, range);
  return range[0].bounded() && range[0].lower >= 0;
}

}  // namespace

template <int dim>
bool has_no_traction_at_rest(const contact::NitscheForm<dim>& form, std::size_t k)
{
  const contact::ContactSegment<dim>& segment = form.segments()[k];
  const problem::Contact& contact = *segment.contact;
  const bool remembers = std::ranges::any_of(form.contact_points(k),
                                             [](const auto& point) { return !point.state.slip.isZero(0); });
  const problem::FrictionCone law = problem::cone(contact.law);
  if (remembers || contact.water || law.is_bilateral || law.is_bonded) return false;
  const contact::SimplexMap<dim - 1, dim> map = contact::simplex_map(form.space().mesh(), segment.slave);
  const fem::Part<dim - 1> whole = fem::reference_simplex<dim - 1>();
  if (contact.gap)
  {
    const auto parts = form.data().contact_parts(k);
    return parts.empty() ? is_gap<dim>(*contact.gap, map, whole)
                         : std::ranges::all_of(parts, [&](const contact::ContactDatumPart<dim>& data)
                                               { return is_gap<dim>(*contact.gap, map, data.part); });
  }
  // Between flat facets it is affine.
  return segment.varying_normal == nullptr &&
         std::ranges::all_of(
             whole, [&](const Point<dim - 1>& s) { return segment.gap(s, map(s), segment.normal) >= 0; });
}

template bool has_no_traction_at_rest(const contact::NitscheForm<2>&, std::size_t);
template bool has_no_traction_at_rest(const contact::NitscheForm<3>&, std::size_t);

}  // namespace tribound::certify
