#include "tribound/mesh/import/survey.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <variant>

#include "tribound/mesh/geometry.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

/// The area of a triangle, the length of a segment.
template <int dim>
double facet_measure(const MeshData<dim>& data, const std::array<Index, dim>& facet)
{
  const auto edge = [&](int i) { return Point<dim>(data.vertices[facet[i]] - data.vertices[facet[0]]); };
  if constexpr (dim == 2)
    return edge(1).norm();
  else
    return edge(1).cross(edge(2)).norm() / 2;
}

/// The cells of every body, with the facets of groups on its boundary.
template <int dim>
std::vector<MeshData<dim>> bodies_of(const MeshData<dim>& data, const Topology<dim>& topology)
{
  const std::vector<int> body = connected_parts(topology);
  const int n = body.empty() ? 0 : 1 + *std::ranges::max_element(body);
  std::vector<MeshData<dim>> bodies(n);
  for (MeshData<dim>& part : bodies) static_cast<MeshLabels&>(part) = data;
  std::vector<Index> number(data.vertices.size(), -1);
  std::vector<std::vector<Index>> cells(n);
  for (std::size_t c = 0; c < body.size(); ++c) cells[body[c]].push_back(static_cast<Index>(c));
  std::vector<std::vector<const TaggedFacet<dim>*>> facets(n);
  for (const TaggedFacet<dim>& tagged : data.facets)
    facets[body[topology.facet_cells[topology.facet(tagged.vertices)][0]]].push_back(&tagged);
  for (int b = 0; b < n; ++b)
  {
    MeshData<dim>& part = bodies[b];
    for (const Index c : cells[b])
    {
      Cell<dim>& cell = part.cells.emplace_back(data.cells[c]);
      part.regions.push_back(data.regions[c]);
      for (Index& v : cell)
      {
        if (number[v] < 0)
        {
          number[v] = static_cast<Index>(part.vertices.size());
          part.vertices.push_back(data.vertices[v]);
        }
        v = number[v];
      }
    }
    for (const TaggedFacet<dim>* tagged : facets[b])
      for (Index& v : part.facets.emplace_back(*tagged).vertices) v = number[v];
    for (const Index c : cells[b])  // another body may share a vertex
      for (const Index v : data.cells[c]) number[v] = -1;
  }
  return bodies;
}

template <int dim>
Survey survey(MeshData<dim> data)
{
  check_arrays(data);
  check_shapes(data);
  const Topology<dim> topology = build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  check_facets(data, topology);
  Survey found{dim, data.vertices.size(), data.cells.size()};
  for (const std::string& name : data.region_names) found.regions.push_back({name});
  for (const std::string& name : data.boundary_names) found.boundaries.push_back({name});
  for (std::size_t c = 0; c < data.cells.size(); ++c)
  {
    SurveyedGroup& region = found.regions[data.regions[c]];
    ++region.n;
    region.measure += determinant(points_of<dim>(data.vertices, data.cells[c])) / factorial<dim>;
  }
  std::erase_if(data.facets,
                [&](const TaggedFacet<dim>& tagged)
                {
                  SurveyedGroup& group = found.boundaries[tagged.tag];
                  const Index f = topology.facet(tagged.vertices);
                  ++group.n;
                  group.measure += facet_measure<dim>(data, tagged.vertices);
                  const bool is_inside = f >= 0 && topology.facet_cells[f][1] >= 0;
                  group.is_inside = group.is_inside || is_inside;
                  return is_inside;
                });
  (void)find_boundary(data, topology);
  check_vertices(data, topology);
  std::vector<MeshData<dim>> bodies = bodies_of(data, topology);
  found.n_bodies = bodies.size();
  for (MeshData<dim>& body : bodies) (void)Mesh<dim>(std::move(body));
  return found;
}

}  // namespace

Survey survey(const SimplicialMesh& mesh)
{
  return std::visit([](const auto& data) { return survey(data); }, mesh.data);
}

}  // namespace tribound::mesh
