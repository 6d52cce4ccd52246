#include "tribound/io/fields/vtu.h"

#include <cstdint>
#include <utility>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/io/fields/vtk_nodes.h"
#include "tribound/io/file/vtu_file.h"

namespace tribound::io
{

namespace
{

/// What is known at a node of a contact facet.
template <int dim>
struct ContactNode
{
  contact::ContactState<dim> state;
  Point<dim> displacement;
};

/// The nodes of all contact facets, facet by facet in VTK's order.
template <int dim>
std::vector<ContactNode<dim>> contact_nodes(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const fem::FacetTabulation<dim> table =
      fem::tabulate_on_facets<dim>(space.basis(), vtk_points<dim - 1>(space.degree()));

  std::vector<ContactNode<dim>> nodes;
  nodes.reserve(form.contact_facets().size() * table.points.size());
  for (int k = 0; k < static_cast<int>(form.contact_facets().size()); ++k)
  {
    const mesh::BoundaryFacet& facet = form.contact_facets()[k].facet;
    const std::vector<contact::ContactState<dim>> states = form.contact_states(u, k, table);
    for (int q = 0; q < static_cast<int>(states.size()); ++q)
      nodes.push_back({states[q], contact::value_at<dim>(space.cell_nodes(facet.cell), u,
                                                         table.on_facet[facet.local].values_at(q))});
  }
  return nodes;
}

/// Point data with `n_components` numbers of type T per node, put by put_node(put, node).
template <typename T, int dim, typename PutNode>
VtuArray node_array(std::string name, int n_components, const std::vector<ContactNode<dim>>& nodes,
                    PutNode put_node)
{
  return vtu_array<T>(std::move(name), n_components, nodes.size(),
                      [&nodes, put_node](const auto& put)
                      {
                        for (const ContactNode<dim>& node : nodes) put_node(put, node);
                      });
}

}  // namespace

template <int dim>
void write_contact_vtu(const std::filesystem::path& path, int level, const contact::NitscheForm<dim>& form,
                       std::span<const double> u)
{
  using Node = ContactNode<dim>;
  const auto facets = form.contact_facets();
  const std::vector<Node> nodes = contact_nodes(form, u);

  VtuGrid grid;
  grid.time = level;
  grid.n_cells = facets.size();
  grid.n_points = nodes.size();
  const std::uint64_t n_facet_nodes = vtk_nodes<dim - 1>(form.space().degree()).size();
  grid.cells = disjoint_cells(grid.n_cells, n_facet_nodes, vtk_lagrange_type<dim - 1>);
  grid.points = {node_array<double>(
      "Points", 3, nodes, [](const auto& put, const Node& node) { put_vector<dim>(put, node.state.point); })};
  grid.point_data = {
      node_array<double>("displacement", 3, nodes,
                         [](const auto& put, const Node& node) { put_vector<dim>(put, node.displacement); }),
      node_array<double>("contact_pressure", 1, nodes,
                         [](const auto& put, const Node& node) { put(node.state.pressure); }),
      node_array<double>("contact_traction", 3, nodes,
                         [](const auto& put, const Node& node)
                         { put_vector<dim>(put, node.state.traction); }),
      node_array<std::int32_t>("contact_status", 1, nodes,
                               [](const auto& put, const Node& node)
                               { put(static_cast<int>(node.state.status)); }),
      node_array<double>("gap", 1, nodes, [](const auto& put, const Node& node) { put(node.state.gap); }),
      node_array<double>("slip", 3, nodes,
                         [](const auto& put, const Node& node) { put_vector<dim>(put, node.state.slip); })};
  grid.cell_data = {vtu_array<std::int32_t>("boundary", 1, grid.n_cells,
                                            [facets](const auto& put)
                                            {
                                              for (const auto& facet : facets) put(facet.facet.tag);
                                            })};
  write_vtu(path, grid);
}

template void write_contact_vtu(const std::filesystem::path&, int, const contact::NitscheForm<2>&,
                                std::span<const double>);
template void write_contact_vtu(const std::filesystem::path&, int, const contact::NitscheForm<3>&,
                                std::span<const double>);

}  // namespace tribound::io
