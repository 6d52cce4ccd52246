#include "tribound/contact/nitsche/interface_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tribound/base/error.h"

namespace tribound::contact
{

template <int dim>
SofteningMargin softening_margin(const NitscheForm<dim>& form, std::optional<int> tag)
{
  SofteningMargin margin;
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    if (tag && form.segments()[k].slave.facet.tag != *tag) continue;
    const double slope = problem::softening_slope(form.segments()[k].contact->law);
    if (slope > margin.ratio * form.segments()[k].gamma) margin = {slope / form.segments()[k].gamma, k};
  }
  return margin;
}

namespace
{

/// "the interface "base" at (1, 0)"
template <int dim>
std::string place(const NitscheForm<dim>& form, const ContactSegment<dim>& segment, const Point<dim>& x)
{
  const int tag = segment.slave.facet.tag;
  return fmt::format("the interface \"{}\" at ({:.6g})", form.space().mesh().boundary_names()[tag],
                     fmt::join(x, ", "));
}

template <int dim>
void check_gap(const NitscheForm<dim>& form, std::size_t k)
{
  constexpr double closed = 1e-8;  // relative to the size of a facet
  const ContactSegment<dim>& segment = form.segments()[k];
  for (const ContactPoint<dim>& point : form.contact_points(k))
    if (point.state.damage < 1 && point.gap > closed * segment.h)
      throw InputError(
          {}, fmt::format("{} has a gap of {:.4g} under a bond", place(form, segment, point.x), point.gap),
          "a gap of 0 where it is bonded");
}

/// Checks the constants of the law, and the conditions for its gamma_t.
template <int dim>
void check_law(const NitscheForm<dim>& form, std::size_t k)
{
  const ContactSegment<dim>& segment = form.segments()[k];
  const problem::ContactLaw& law = segment.contact->law;
  const auto fail = [&](const std::string& what, const std::string& hint)
  { throw InputError({}, place(form, segment, form.contact_points(k)[0].x) + ": " + what, hint); };
  if (const std::string fault = problem::fault(law); !fault.empty())
    fail(fault, "other constants of the law");
  const double weight = problem::tangential_weight(law);
  if (weight == 1) return;
  if (segment.varying_normal != nullptr)
    fail("a shear ratio that is not 1 goes with directions that do not vary on a facet", "shear ratio 1");
  const int p = form.space().degree();
  const double least = std::max(1.0, 0.4 * p * p) / weight;
  if (form.gamma0() < least)
    fail("the shear ratio is too small for gamma0", fmt::format("a gamma0 of {:.4g} or more", least));
}

/// Without softening, T is Lipschitz continuous in gap, threshold and water pressure with the constant 1; the
/// bound uses that for what rules miss of them.
template <int dim>
void check_data(const NitscheForm<dim>& form, std::size_t k)
{
  const ContactSegment<dim>& segment = form.segments()[k];
  if (problem::softening_slope(segment.contact->law) == 0) return;
  for (const ContactDatumPart<dim>& part : form.data().contact_parts(k))
    if (part.gap > 0 || part.strength > 0 || part.water > 0)
      throw InputError(
          {},
          fmt::format("{} softens, and its gap, threshold or water pressure is no polynomial of degree {}",
                      place(form, segment, form.contact_points(k)[0].x), form.space().degree() + 2),
          "numbers, or polynomials, also in pieces: max(0, ...)");
}

}  // namespace

template <int dim>
std::shared_ptr<const ContactHistory<dim>> history_at_first(const NitscheForm<dim>& form)
{
  const auto breaks = [](const ContactSegment<dim>& segment)
  { return segment.contact->broken && problem::cone(segment.contact->law).is_bonded; };
  const auto segments = form.segments();
  if (!form.space().mesh().ranks().any(std::ranges::any_of(segments, breaks))) return nullptr;
  std::vector<problem::InterfaceState<dim>> states;
  states.reserve(form.n_contact_points());
  for (std::size_t k = 0; k < segments.size(); ++k)
    for (const ContactPoint<dim>& point : form.contact_points(k))
    {
      states.push_back(problem::fresh_state<dim>(segments[k].contact->law));
      if (breaks(segments[k]) && (*segments[k].contact->broken)(point.x) != 0) states.back().damage = 1;
    }
  return std::make_shared<const ContactHistory<dim>>(std::move(states), form.facet_rule(),
                                                     form.space().degree() + 2);
}

namespace
{

/// Where nothing lies opposite, the effect of the water is not defined.
template <int dim>
void check_coverage(const NitscheForm<dim>& form)
{
  constexpr double rounding = 1e-8;
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto pairs = form.problem().pairs();
  std::vector<double> measures(2 * pairs.size(), 0.0);  // covered and total measure of each slave
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
    if (const int pair = form.segments()[k].pair; pair >= 0) measures[2 * pair] += form.segments()[k].measure;
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
    if (const auto* pair = form.problem().pair_of_slave(facet.tag))
      measures[2 * (pair - pairs.data()) + 1] += simplex_map(mesh, facet).measure;
  mesh.ranks().sum(std::span(measures));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].contact.water && measures[2 * i] < (1 - rounding) * measures[2 * i + 1])
      throw InputError(
          pairs[i].where,
          fmt::format("there is water in it, and the master lies opposite {:.4g} % of the slave only",
                      100 * measures[2 * i] / measures[2 * i + 1]),
          "a slave of which all lies opposite the master");
}

/// Checks own segments: constants and gaps, and whether gamma exceeds the slope.
template <int dim>
void check_laws(const NitscheForm<dim>& form)
{
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    if (!problem::cone(form.segments()[k].contact->law).is_bonded) continue;
    check_law(form, k);
    check_gap(form, k);
  }
  const SofteningMargin margin = softening_margin(form);
  if (margin.ratio < 1) return;
  const ContactSegment<dim>& segment = form.segments()[margin.segment];
  const Point<dim> centre =
      simplex_map(form.space().mesh(), segment.slave)(Point<dim - 1>::Constant(1.0 / dim));
  throw InputError(
      {},
      fmt::format("{} softens with the slope {:.4g}, and gamma = {:.4g} has to be larger",
                  place(form, segment, centre), margin.ratio * segment.gamma, segment.gamma),
      fmt::format("facets there of less than {:.4g} (now {:.4g}), or a gamma0 of more than {:.4g}",
                  segment.h / margin.ratio, segment.h, form.gamma0() * margin.ratio));
}

}  // namespace

template <int dim>
void check_interface_data(const NitscheForm<dim>& form)
{
  form.space().mesh().ranks().together(
      [&]
      {
        for (std::size_t k = 0; k < form.n_owned_segments(); ++k) check_data(form, k);
      });
}

template <int dim>
void check_interfaces(const NitscheForm<dim>& form)
{
  check_coverage(form);
  form.space().mesh().ranks().together([&] { check_laws(form); });
  check_interface_data(form);
}

template SofteningMargin softening_margin(const NitscheForm<2>&, std::optional<int>);
template SofteningMargin softening_margin(const NitscheForm<3>&, std::optional<int>);
template std::shared_ptr<const ContactHistory<2>> history_at_first(const NitscheForm<2>&);
template std::shared_ptr<const ContactHistory<3>> history_at_first(const NitscheForm<3>&);
template void check_interface_data(const NitscheForm<2>&);
template void check_interface_data(const NitscheForm<3>&);
template void check_interfaces(const NitscheForm<2>&);
template void check_interfaces(const NitscheForm<3>&);

}  // namespace tribound::contact
