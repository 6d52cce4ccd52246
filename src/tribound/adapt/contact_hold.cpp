#include "tribound/adapt/contact_hold.h"

#include <fmt/format.h>

#include <algorithm>

#include "tribound/certify/energy/free_motions.h"
#include "tribound/contact/support/rigid_motion.h"

namespace tribound::adapt
{

template <int dim>
std::string words_of_hold(const contact::NitscheForm<dim>& form)
{
  if (std::ranges::any_of(form.problem().contacts(), &problem::Contact::is_bilateral)) return {};
  if (certify::FreeMotions<dim>(form.problem(), form.space().mesh()).size() == 0) return {};
  return "; the contact that holds a body may have opened or slid";
}

template <int dim>
std::string words_of_statics(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                             double t)
{
  if (space.mesh().partition()) return {};
  const std::string why = contact::why_not_held(problem, space);
  return why.empty() ? why : fmt::format("; at t = {:.9g} {}", t, why);
}

template std::string words_of_hold(const contact::NitscheForm<2>&);
template std::string words_of_hold(const contact::NitscheForm<3>&);
template std::string words_of_statics(const problem::Problem<2>&, const fem::LagrangeSpace<2>&, double);
template std::string words_of_statics(const problem::Problem<3>&, const fem::LagrangeSpace<3>&, double);

}  // namespace tribound::adapt
