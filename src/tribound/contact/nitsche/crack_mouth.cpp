#include "tribound/contact/nitsche/crack_mouth.h"

#include <algorithm>
#include <limits>

namespace tribound::contact
{

template <int dim>
CrackMouth crack_mouth(const NitscheForm<dim>& form, int tag)
{
  constexpr double rounding = 1e-9;  // of the base: points as near by symmetry
  const problem::BaseLine& line = *form.problem().contact(tag)->base;
  const Point<dim> heel(line.heel.data());
  const auto distance = [&](std::size_t i)
  {
    const bool is_here = form.segments()[i / form.n_segment_points()].slave.facet.tag == tag;
    return is_here ? (form.contact_points()[i].x - heel).norm() : std::numeric_limits<double>::infinity();
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i) nearest = std::min(nearest, distance(i));
  nearest = -form.space().mesh().ranks().max(-nearest);

  CrackMouth mouth;
  if (nearest == std::numeric_limits<double>::infinity()) return mouth;
  for (std::size_t i = 0; i < form.n_contact_points(); ++i)
  {
    if (!(distance(i) <= nearest + rounding * line.length())) continue;
    mouth.points.push_back(i);
    if (i < form.n_owned_contact_points()) ++mouth.n;
  }
  mouth.n = form.space().mesh().ranks().sum(mouth.n);
  return mouth;
}

template CrackMouth crack_mouth(const NitscheForm<2>&, int);
template CrackMouth crack_mouth(const NitscheForm<3>&, int);

}  // namespace tribound::contact
