#include "tribound/contact/nitsche/softening.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "tribound/base/error.h"

namespace tribound::contact
{

template <int dim>
SofteningMargin softening_margin(const NitscheForm<dim>& form)
{
  SofteningMargin margin;
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const double slope = problem::softening_slope(form.segments()[k].contact->law);
    if (slope > margin.ratio * form.segments()[k].gamma) margin = {slope / form.segments()[k].gamma, k};
  }
  return margin;
}

template <int dim>
void check_softening(const NitscheForm<dim>& form)
{
  const SofteningMargin margin = softening_margin(form);
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  if (margin.ratio < 1) return;
  const ContactSegment<dim>& segment = form.segments()[margin.segment];
  const Point<dim> centre = simplex_map(mesh, segment.slave)(Point<dim - 1>::Constant(1.0 / dim));
  throw InputError(
      {},
      fmt::format("the interface \"{}\" softens with the slope {:.4g} at ({:.6g}), where gamma = {:.4g} "
                  "has to be larger",
                  mesh.boundary_names()[segment.slave.facet.tag], margin.ratio * segment.gamma,
                  fmt::join(centre, ", "), segment.gamma),
      fmt::format("facets there of less than {:.4g} (now {:.4g}), or a gamma0 of more than {:.4g}",
                  segment.h / margin.ratio, segment.h, form.gamma0() * margin.ratio));
}

template SofteningMargin softening_margin(const NitscheForm<2>&);
template SofteningMargin softening_margin(const NitscheForm<3>&);
template void check_softening(const NitscheForm<2>&);
template void check_softening(const NitscheForm<3>&);

}  // namespace tribound::contact
