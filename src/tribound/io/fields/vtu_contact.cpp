#include "tribound/io/fields/vtu.h"

#include <cstdint>
#include <utility>

#include "tribound/io/fields/vtk_nodes.h"
#include "tribound/io/file/vtu_file.h"

namespace tribound::io
{

namespace
{

/// The states at the nodes of all segments, segment by segment in VTK's order.
template <int dim>
std::vector<contact::ContactState<dim>> contact_nodes(const contact::NitscheForm<dim>& form,
                                                      std::span<const double> u)
{
  const contact::SegmentTables<dim> tables(form.space().basis(), form.segments(),
                                           vtk_points<dim - 1>(form.space().degree()));
  std::vector<contact::ContactState<dim>> nodes;
  nodes.reserve(form.segments().size() * tables.n_points());
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : form.contact_states(u, k, tables[k]))
      nodes.push_back(state);
  return nodes;
}

/// Point data with `n_components` numbers of type T per node, written by put_node(put, node).
template <typename T, int dim, typename PutNode>
VtuArray node_array(std::string name, int n_components, const std::vector<contact::ContactState<dim>>& nodes,
                    PutNode put_node)
{
  return vtu_array<T>(std::move(name), n_components, nodes.size(),
                      [&nodes, put_node](const auto& put)
                      {
                        for (const contact::ContactState<dim>& node : nodes) put_node(put, node);
                      });
}

template <int dim>
void add_memory(VtuGrid& grid, const std::vector<contact::ContactState<dim>>& nodes)
{
  using Node = contact::ContactState<dim>;
  grid.point_data.push_back(node_array<double>(
      "damage", 1, nodes, [](const auto& put, const Node& node) { put(node.state.damage); }));
  grid.point_data.push_back(
      node_array<double>("opening", 1, nodes, [](const auto& put, const Node& node) { put(node.opening); }));
  grid.point_data.push_back(node_array<double>("plastic_slip", 3, nodes,
                                               [](const auto& put, const Node& node)
                                               { put_vector<dim>(put, node.state.slip); }));
  grid.point_data.push_back(node_array<double>("water_pressure", 1, nodes,
                                               [](const auto& put, const Node& node) { put(node.water); }));
  grid.point_data.push_back(
      node_array<double>("effective_traction", 3, nodes,
                         [](const auto& put, const Node& node)
                         { put_vector<dim>(put, node.traction + node.water * node.normal); }));
}

}  // namespace

template <int dim>
void write_contact_vtu(const std::filesystem::path& path, const SeriesPlace& place,
                       const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  using Node = contact::ContactState<dim>;
  const auto segments = form.segments();
  const std::vector<Node> nodes = contact_nodes(form, u);

  VtuGrid grid;
  grid.time = place.number;
  grid.load_factor = place.load_factor;
  grid.n_cells = segments.size();
  grid.n_points = nodes.size();
  const std::uint64_t n_facet_nodes = vtk_nodes<dim - 1>(form.space().degree()).size();
  grid.cells = disjoint_cells(grid.n_cells, n_facet_nodes, vtk_lagrange_type<dim - 1>);
  grid.points = {node_array<double>(
      "Points", 3, nodes, [](const auto& put, const Node& node) { put_vector<dim>(put, node.point); })};
  grid.point_data = {
      node_array<double>("displacement", 3, nodes,
                         [](const auto& put, const Node& node) { put_vector<dim>(put, node.displacement); }),
      node_array<double>("contact_pressure", 1, nodes,
                         [](const auto& put, const Node& node) { put(node.pressure); }),
      node_array<double>("contact_traction", 3, nodes,
                         [](const auto& put, const Node& node) { put_vector<dim>(put, node.traction); }),
      node_array<std::int32_t>("contact_status", 1, nodes,
                               [](const auto& put, const Node& node) { put(static_cast<int>(node.status)); }),
      node_array<double>("gap", 1, nodes, [](const auto& put, const Node& node) { put(node.gap); }),
      node_array<double>("slip", 3, nodes,
                         [](const auto& put, const Node& node) { put_vector<dim>(put, node.slip); })};
  if (place.load_factor) add_memory(grid, nodes);
  grid.cell_data = {vtu_array<std::int32_t>("boundary", 1, grid.n_cells,
                                            [segments](const auto& put)
                                            {
                                              for (const auto& segment : segments)
                                                put(segment.slave.facet.tag);
                                            })};
  write_vtu(path, grid);
}

template void write_contact_vtu(const std::filesystem::path&, const SeriesPlace&,
                                const contact::NitscheForm<2>&, std::span<const double>);
template void write_contact_vtu(const std::filesystem::path&, const SeriesPlace&,
                                const contact::NitscheForm<3>&, std::span<const double>);

}  // namespace tribound::io
