#include "tribound/doctor/path_facts.h"

#include <utility>

#include "tribound/contact/support/rigid_motion.h"

namespace tribound::doctor
{

template <int dim>
std::optional<LoadBeyondContact> load_beyond_contact(const problem::Problem<dim>& problem,
                                                     const fem::LagrangeSpace<dim>& space,
                                                     std::span<const double> load_factors)
{
  for (const double t : load_factors)
    if (std::string why = contact::why_not_held(problem.at(t), space); !why.empty())
      return LoadBeyondContact{t, std::move(why)};
  return {};
}

template std::optional<LoadBeyondContact> load_beyond_contact(const problem::Problem<2>&,
                                                              const fem::LagrangeSpace<2>&,
                                                              std::span<const double>);
template std::optional<LoadBeyondContact> load_beyond_contact(const problem::Problem<3>&,
                                                              const fem::LagrangeSpace<3>&,
                                                              std::span<const double>);

}  // namespace tribound::doctor
