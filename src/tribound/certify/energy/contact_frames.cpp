#include "tribound/certify/energy/contact_frames.h"

#include <algorithm>

namespace tribound::certify
{

namespace
{

/// The rotation in their common plane that takes the unit vector a to b != -a.
template <int dim>
Tensor<dim> rotation_between(const Point<dim>& a, const Point<dim>& b)
{
  const Tensor<dim> spin = b * a.transpose() - a * b.transpose();
  return Tensor<dim>::Identity() + spin + spin * spin / (1 + a.dot(b));
}

}  // namespace

template <int dim>
ContactFrames<dim>::ContactFrames(const contact::NitscheForm<dim>& form)
    : form_(form), at_points_(basis_.tabulate(form.facet_rule().points))
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  for (const contact::ContactSegment<dim>& segment : form.segments())
  {
    const bool turns = segment.varying_normal != nullptr && !problem::cone(segment.contact->law).is_tied;
    begin_.push_back(turns ? static_cast<std::ptrdiff_t>(nodal_.size()) : -1);
    normals_.push_back(turns ? contact::normal_at_centre(mesh, segment) : segment.normal);
    if (!turns) continue;
    const auto map = contact::simplex_map(mesh, segment.slave);
    for (const Point<dim - 1>& s : basis_.node_points())
      nodal_.push_back(rotation_between<dim>(normals_.back(), segment.normal_at(map(s))));
  }
}

template <int dim>
Tensor<dim> ContactFrames<dim>::interpolated(std::size_t k, std::span<const double> basis) const
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (std::size_t i = 0; i < basis.size(); ++i) sum += basis[i] * nodal_[begin_[k] + i];
  return sum;
}

template <int dim>
Tensor<dim> ContactFrames<dim>::at(std::size_t k, const Point<dim - 1>& s) const
{
  if (!turns(k)) return Tensor<dim>::Identity();
  const fem::Tabulation<dim - 1> table = basis_.tabulate(std::span(&s, 1));
  return interpolated(k, table.values_at(0));
}

template <int dim>
double ContactFrames<dim>::remainder() const
{
  double largest = 0;
  for (std::size_t k = 0; k < begin_.size(); ++k)
    for (int q = 0; turns(k) && q < form_.n_segment_points(); ++q)
      largest = std::max(largest, (form_.contact_points(k)[q].normal - at_point(k, q) * normals_[k]).norm());
  return largest;
}

template class ContactFrames<2>;
template class ContactFrames<3>;

}  // namespace tribound::certify
