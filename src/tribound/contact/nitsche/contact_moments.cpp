#include "tribound/contact/nitsche/contact_moments.h"

#include <algorithm>
#include <array>

namespace tribound::contact
{

Point<1> moment(const Point<2>& arm, const Point<2>& force)
{
  return Point<1>(arm[0] * force[1] - arm[1] * force[0]);
}

Point<3> moment(const Point<3>& arm, const Point<3>& force)
{
  return mesh::cross(arm, force);
}

template <int dim>
ContactMoments<dim> contact_moments(const NitscheForm<dim>& form, std::span<const Point<dim>> t, int tag)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  ContactMoments<dim> sum;
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
  {
    const ContactSegment<dim>& segment = form.segments()[i / form.n_segment_points()];
    if (tag >= 0 && segment.slave.facet.tag != tag) continue;
    const ContactPoint<dim>& point = form.contact_points()[i];
    const Point<dim> force = point.weight * t[i];
    sum.slave += moment(point.x, force);
    sum.scale += point.x.norm() * force.norm();
    if (!segment.master) continue;
    const Point<dim> opposite =
        simplex_map(mesh, *segment.master)(form.facet_rule().points[i % form.n_segment_points()]);
    sum.master -= moment(opposite, force);
  }
  constexpr int n = ContactMoments<dim>::Moment::RowsAtCompileTime;
  std::array<double, 2 * n + 1> sums;
  std::ranges::copy(sum.slave, sums.begin());
  std::ranges::copy(sum.master, sums.begin() + n);
  sums.back() = sum.scale;
  mesh.ranks().sum(std::span(sums));
  std::copy_n(sums.begin(), n, sum.slave.data());
  std::copy_n(sums.begin() + n, n, sum.master.data());
  sum.scale = sums.back();
  return sum;
}

template ContactMoments<2> contact_moments(const NitscheForm<2>&, std::span<const Point<2>>, int);
template ContactMoments<3> contact_moments(const NitscheForm<3>&, std::span<const Point<3>>, int);

}  // namespace tribound::contact
