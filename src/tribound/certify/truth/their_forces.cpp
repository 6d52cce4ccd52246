#include "tribound/certify/truth/their_forces.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "tribound/fem/evaluation.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// s n at a point of a facet of a boundary.
template <int dim>
struct FacetTraction
{
  std::size_t facet;
  double weight;
  Point<dim> x;
  Point<dim> traction;
  Point<dim> normal;
};

/// Calls use(FacetTraction) at the points of a rule on the facets of boundaries.
template <int dim, class Use>
void for_each_traction(const fem::LagrangeSpace<dim>& their_space, std::span<const Tensor<dim>> stress,
                       int degree, const Use& use)
{
  const mesh::Mesh<dim>& mesh = their_space.mesh();
  const auto n_nodes = static_cast<std::size_t>(their_space.basis().n_nodes());
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(degree);
  const fem::FacetTabulation<dim> tables = fem::tabulate_on_facets<dim>(their_space.basis(), rule.points);
  for (std::size_t f = 0; f < mesh.boundary().size(); ++f)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[f];
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    const fem::Tabulation<dim>& table = tables.on_facet[facet.local];
    const mesh::FacetMap<dim> map = mesh::facet_map(mesh, facet.cell, facet.local);
    for (int q = 0; q < rule.size(); ++q)
    {
      Tensor<dim> s = Tensor<dim>::Zero();
      for (std::size_t i = 0; i < n_nodes; ++i) s += table.values_at(q)[i] * stress[n_nodes * facet.cell + i];
      use(FacetTraction<dim>{f, rule.weights[q] * geometry.det(), map(rule.points[q]), s * geometry.normal,
                             geometry.normal});
    }
  }
}

}  // namespace

template <int dim>
std::vector<Point<dim>> boundary_forces(const fem::LagrangeSpace<dim>& their_space,
                                        std::span<const Tensor<dim>> stress, bool is_axisymmetric)
{
  const mesh::Mesh<dim>& mesh = their_space.mesh();
  std::vector<Point<dim>> forces(mesh.boundary_names().size(), Point<dim>::Zero());
  for_each_traction<dim>(their_space, stress, their_space.degree() + (is_axisymmetric ? 1 : 0),
                         [&](const FacetTraction<dim>& at)
                         {
                           if (const int tag = mesh.boundary()[at.facet].tag; tag >= 0)
                             forces[tag] += at.weight * (is_axisymmetric ? at.x[0] : 1.0) * at.traction;
                         });
  if (is_axisymmetric)
    for (Point<dim>& force : forces)
    {
      force *= 2 * std::numbers::pi;
      force[0] = 0;
    }
  return forces;
}

template <int dim>
Tension tension(const fem::LagrangeSpace<dim>& their_space, std::span<const Tensor<dim>> stress,
                std::span<const std::size_t> facets)
{
  Tension result;
  std::optional<std::size_t> last;
  for_each_traction<dim>(their_space, stress, their_space.degree(),
                         [&](const FacetTraction<dim>& at)
                         {
                           const double pull = at.traction.dot(at.normal);
                           if (!std::ranges::binary_search(facets, at.facet) || pull <= 0) return;
                           result.largest = std::max(result.largest, pull);
                           if (last != at.facet) ++result.n_facets;
                           last = at.facet;
                         });
  return result;
}

template std::vector<Point<2>> boundary_forces(const fem::LagrangeSpace<2>&, std::span<const Tensor<2>>,
                                               bool);
template std::vector<Point<3>> boundary_forces(const fem::LagrangeSpace<3>&, std::span<const Tensor<3>>,
                                               bool);
template Tension tension(const fem::LagrangeSpace<2>&, std::span<const Tensor<2>>,
                         std::span<const std::size_t>);
template Tension tension(const fem::LagrangeSpace<3>&, std::span<const Tensor<3>>,
                         std::span<const std::size_t>);

}  // namespace tribound::certify
