#include "tribound/certify/bound/data_terms.h"

#include <cmath>

#include "tribound/certify/bound/constants.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

/// The mean m of the error of g_N on F is moved into the cell: div((x - P) v) = d v + (x - P) . grad v, with
/// P the vertex opposite to F, gives (m, v)_F = |F|/|T| (m, v + (x - P) . grad v / d)_T. The first term is
/// like that of a body force, the second at most |m| |F|/|T| h_T |T|^{1/2} / d ||grad v||_T.
///
/// On the meridian, with measures |.|_r and means of v with the weight r <= R: what is missed of an integral
/// of f has the affine weight r of size R, norms have R^{1/2}, and C of the trace gives |mean_F(v) -
/// mean_T(v)| <= C |F|_r^{-1/2} ||grad v||_T.
template <int dim>
DataTerms data_terms(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::DiscreteData<dim>& data = form.data();
  const Index n_cells = mesh.n_owned_cells();
  std::vector<double> missed(n_cells, 0.0);  // of the integrals of loads on the cell and its facets
  DataTerms terms{std::vector<double>(n_cells, 0.0), std::vector<double>(n_cells, 0.0), 0};
  const problem::Problem<dim>& problem = form.problem();
  for (Index c = 0; c < n_cells; ++c)
  {
    const auto [oscillation, mean] = data.body_remainder(c);
    if (oscillation == 0 && mean == 0) continue;
    const double largest = largest_weight<dim>(problem, mesh::points_of(mesh.vertices(), mesh.cell(c)));
    missed[c] = largest * mean;
    terms.osc[c] = std::sqrt(largest) * poincare_constant(mesh::cell_diameter(mesh, c)) * oscillation;
  }
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const auto [oscillation, mean] = contact::traction_remainder(form, k, u);
    if (oscillation == 0 && mean == 0) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    const double h = mesh::cell_diameter(mesh, facet.cell);
    const double volume = mesh::cell_map(mesh, facet.cell).measure();
    const double measure = mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
    const auto vertices =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
    const double largest = largest_weight<dim>(problem, vertices);
    if (largest == 0) continue;  // on the axis
    missed[facet.cell] += largest * mean;
    if (!problem.is_axisymmetric())
      terms.neu[facet.cell] +=
          trace_constant<dim>(h, measure, volume) * oscillation + h / dim * mean / std::sqrt(volume);
    else
      terms.neu[facet.cell] += meridian_trace_constant(h, measure, volume) *
                               (std::sqrt(largest) * oscillation +
                                largest * mean / std::sqrt(measure * mean_weight<dim>(problem, vertices)));
  }
  double squares = 0;
  for (Index c = 0; c < n_cells; ++c)
    if (missed[c] > 0)
      squares += missed[c] * missed[c] /
                 (mesh::cell_map(mesh, c).measure() *
                  mean_weight<dim>(problem, mesh::points_of(mesh.vertices(), mesh.cell(c))));
  terms.missed = std::sqrt(mesh.ranks().sum(squares));
  return terms;
}

template DataTerms data_terms(const contact::NitscheForm<2>&, std::span<const double>);
template DataTerms data_terms(const contact::NitscheForm<3>&, std::span<const double>);

}  // namespace tribound::certify
