#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

template <int dim>
ContactResultants<dim> contact_resultants(const NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                          int tag)
{
  ContactResultants<dim> sum;
  Point<dim> tangential = Point<dim>::Zero();
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
  {
    if (tag >= 0 && form.segments()[i / form.n_segment_points()].slave.facet.tag != tag) continue;
    const auto& [x, weight, n, gap, strength, water, state] = form.contact_points()[i];
    const Point<dim> t_t = t[i] - t[i].dot(n) * n;
    sum.force += weight * t[i];
    sum.normal += weight * t[i].dot(n);
    sum.abs_tangential += weight * t_t.norm();
    sum.abs_normal += weight * std::abs(t[i].dot(n));
    tangential += weight * t_t;
    if constexpr (dim == 2) sum.tangential += weight * (-n[1] * t[i][0] + n[0] * t[i][1]);
  }
  std::array<double, 2 * dim + 4> sums{sum.normal, sum.tangential, sum.abs_tangential, sum.abs_normal};
  std::ranges::copy(sum.force, sums.begin() + 4);
  std::ranges::copy(tangential, sums.begin() + 4 + dim);
  form.space().mesh().ranks().sum(std::span(sums));
  for (double& of_body : sums) of_body *= form.problem().full_circle();
  sum.normal = sums[0];
  sum.tangential = sums[1];
  sum.abs_tangential = sums[2];
  sum.abs_normal = sums[3];
  std::copy_n(sums.begin() + 4, dim, sum.force.data());
  std::copy_n(sums.begin() + 4 + dim, dim, tangential.data());
  if constexpr (dim == 3) sum.tangential = tangential.norm();
  return sum;
}

template ContactResultants<2> contact_resultants(const NitscheForm<2>&, std::span<const Point<2>>, int);
template ContactResultants<3> contact_resultants(const NitscheForm<3>&, std::span<const Point<3>>, int);

}  // namespace tribound::contact
