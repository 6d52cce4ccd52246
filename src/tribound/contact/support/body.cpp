#include "tribound/contact/support/body.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tribound/mesh/describe.h"

namespace tribound::contact
{

namespace
{

/// The label of the cell of each vertex or node; n is their number.
template <class Numbers>
std::vector<int> spread(std::span<const int> cell_label, Index n, Numbers numbers_of)
{
  std::vector<int> label(n, -1);
  for (std::size_t c = 0; c < cell_label.size(); ++c)
    for (const Index i : numbers_of(static_cast<Index>(c))) label[i] = cell_label[c];
  return label;
}

}  // namespace

template <int dim>
std::vector<Body<dim>> find_bodies(const fem::LagrangeSpace<dim>& space)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const std::vector<int> cell_label = mesh::connected_parts(mesh.topology());
  if (cell_label.empty()) return {};
  std::vector<Body<dim>> bodies(std::ranges::max(cell_label) + 1);
  const std::vector<int> vertex_label = spread(
      cell_label, mesh.n_vertices(), [&](Index c) -> const auto& { return mesh.cell(c); });
  for (Index v = 0; v < mesh.n_vertices(); ++v) bodies[vertex_label[v]].vertices.push_back(v);
  for (Body<dim>& body : bodies)
  {
    for (const Index v : body.vertices) body.centre += mesh.vertex(v);
    body.centre /= static_cast<double>(body.vertices.size());
  }

  const std::vector<int> node_label =
      spread(cell_label, space.n_nodes(), [&](Index c) { return space.cell_nodes(c); });
  for (Index i = 0; i < space.n_nodes(); ++i) bodies[node_label[i]].nodes.push_back(i);
  for (std::size_t k = 0; k < mesh.boundary().size(); ++k)
  {
    Body<dim>& body = bodies[cell_label[mesh.boundary()[k].cell]];
    body.facets.push_back(mesh.boundary()[k]);
    body.numbers.push_back(k);
  }
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    bodies[cell_label[c]].cells.push_back(c);
    std::vector<int>& regions = bodies[cell_label[c]].regions;
    const auto position = std::ranges::lower_bound(regions, mesh.region(c));
    if (position == regions.end() || *position != mesh.region(c)) regions.insert(position, mesh.region(c));
  }
  return bodies;
}

template <int dim>
std::string describe(const Body<dim>& body, const problem::Problem<dim>& problem, bool several)
{
  std::vector<std::string> names;
  for (const int region : body.regions) names.push_back("\"" + problem.regions()[region].name + "\"");
  const std::string place = several ? fmt::format(" around {}", mesh::describe(body.centre)) : "";
  return fmt::format("the body{} (region{} {})", place, names.size() > 1 ? "s" : "", fmt::join(names, ", "));
}

template std::vector<Body<2>> find_bodies(const fem::LagrangeSpace<2>&);
template std::vector<Body<3>> find_bodies(const fem::LagrangeSpace<3>&);
template std::string describe(const Body<2>&, const problem::Problem<2>&, bool);
template std::string describe(const Body<3>&, const problem::Problem<3>&, bool);

}  // namespace tribound::contact
