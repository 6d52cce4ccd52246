#include "tribound/certify/bound/data_terms.h"

#include <cmath>

#include "tribound/certify/bound/constants.h"
#include "tribound/contact/nitsche/residual.h"

namespace tribound::certify
{

/// The mean m of the error of g_N on F is moved into the cell: div((x - P) v) = d v + (x - P) . grad v, with
/// P the vertex opposite to F, gives (m, v)_F = |F|/|T| (m, v + (x - P) . grad v / d)_T. The first term is
/// like that of a body force, the second at most |m| |F|/|T| h_T |T|^{1/2} / d ||grad v||_T.
template <int dim>
DataTerms data_terms(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::DiscreteData<dim>& data = form.data();
  const Index n_cells = mesh.n_owned_cells();
  std::vector<double> missed(n_cells, 0.0);  // of the integrals of loads on the cell and its facets
  DataTerms terms{std::vector<double>(n_cells, 0.0), std::vector<double>(n_cells, 0.0), 0};
  for (Index c = 0; c < n_cells; ++c)
  {
    const auto [oscillation, mean] = data.body_remainder(c);
    missed[c] = mean;
    if (oscillation > 0) terms.osc[c] = poincare_constant(mesh::cell_diameter(mesh, c)) * oscillation;
  }
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const auto [oscillation, mean] = contact::traction_remainder(form, k, u);
    if (oscillation == 0 && mean == 0) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    const double h = mesh::cell_diameter(mesh, facet.cell);
    const double volume = mesh::cell_map(mesh, facet.cell).measure();
    const double measure = mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
    missed[facet.cell] += mean;
    terms.neu[facet.cell] +=
        trace_constant<dim>(h, measure, volume) * oscillation + h / dim * mean / std::sqrt(volume);
  }
  double squares = 0;
  for (Index c = 0; c < n_cells; ++c)
    if (missed[c] > 0) squares += missed[c] * missed[c] / mesh::cell_map(mesh, c).measure();
  terms.missed = std::sqrt(mesh.ranks().sum(squares));
  return terms;
}

template DataTerms data_terms(const contact::NitscheForm<2>&, std::span<const double>);
template DataTerms data_terms(const contact::NitscheForm<3>&, std::span<const double>);

}  // namespace tribound::certify
