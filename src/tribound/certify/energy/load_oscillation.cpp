#include "tribound/certify/energy/load_oscillation.h"

#include <algorithm>
#include <cmath>

#include "tribound/certify/bound/poincare_korn.h"

namespace tribound::certify
{

template <int dim>
std::vector<double> load_oscillation(const contact::NitscheForm<dim>& form)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::DiscreteData<dim>& data = form.data();
  std::vector<double> result(mesh.n_owned_cells(), 0.0);
  const auto constants = [&](Index cell)
  { return poincare_korn<dim>(mesh::points_of(mesh.vertices(), mesh.cell(cell))); };
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
    if (const double norm = data.body_remainder(c).oscillation; norm > 0)
      result[c] = constants(c).cell * norm;
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const double norm = data.traction_remainder(k).oscillation;
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    if (norm > 0) result[facet.cell] += constants(facet.cell).facets[facet.local] * norm;
  }
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
    if (result[c] > 0)
    {
      const problem::Material& material = form.problem().material(mesh.region(c));
      result[c] /= std::sqrt(std::min(2 * material.mu, 2 * material.mu + dim * material.lambda));
    }
  return result;
}

template std::vector<double> load_oscillation(const contact::NitscheForm<2>&);
template std::vector<double> load_oscillation(const contact::NitscheForm<3>&);

}  // namespace tribound::certify
