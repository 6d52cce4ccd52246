#include "tribound/mesh/quadratic_facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "tribound/mesh/describe.h"

namespace tribound::mesh
{

namespace
{

using Edge = std::array<Index, 2>;

Edge ordered(Edge edge)
{
  std::ranges::sort(edge);
  return edge;
}

/// The nodes by their edges.
template <int dim>
std::map<Edge, Point<dim>> nodes_by_edge(const MeshData<dim>& data)
{
  std::map<Edge, Point<dim>> nodes;
  for (const auto& [ends, position] : data.edge_nodes)
  {
    const auto fail = [&, &ends = ends](const std::string& problem)
    {
      throw InputError(
          data.source,
          fmt::format("the second-order edge from {} to {} has {}", describe(data.vertices[ends[0]]),
                      describe(data.vertices[ends[1]]), problem),
          "mesh again, with -order 2");
    };
    if (!position.allFinite())
      fail(fmt::format("its middle at {}, which are not finite numbers", describe(position)));
    const auto [it, is_new] = nodes.try_emplace(ordered(ends), position);
    if (!is_new && it->second != position)
      fail(fmt::format("two middles, {} and {}", describe(it->second), describe(position)));
  }
  return nodes;
}

/// Numbers the nodes in the order in which the facets name them.
template <int dim>
class Collector
{
 public:
  explicit Collector(const MeshData<dim>& data) : data_(data), nodes_(nodes_by_edge(data)) {}

  void add(const BoundaryFacet& boundary)
  {
    std::array<Index, dim> vertices = facet_vertices(data_.cells[boundary.cell], boundary.local);
    if (boundary.local % 2 != 0) std::swap(vertices[0], vertices[1]);  // see facet_geometry()
    constexpr auto& edges = local_edges<dim - 1>;
    std::array<Edge, edges.size()> ends;
    for (std::size_t e = 0; e < edges.size(); ++e)
      ends[e] = ordered({vertices[edges[e][0]], vertices[edges[e][1]]});
    if (!std::ranges::all_of(ends, [this](const Edge& edge) { return nodes_.contains(edge); })) return;
    facets_.tags.push_back(boundary.tag);
    for (const Index v : vertices) add_node({v, v}, data_.vertices[v]);
    for (const Edge& edge : ends) add_node(edge, nodes_.at(edge));
  }

  [[nodiscard]] QuadraticFacets take() { return std::move(facets_); }

 private:
  void add_node(const Edge& name, const Point<dim>& position)
  {
    const auto [it, is_new] = numbers_.try_emplace(name, static_cast<Index>(numbers_.size()));
    if (is_new) facets_.points.insert(facets_.points.end(), position.begin(), position.end());
    facets_.nodes.push_back(it->second);
  }

  const MeshData<dim>& data_;
  std::map<Edge, Point<dim>> nodes_;
  std::map<Edge, Index> numbers_;  ///< a vertex is an edge from itself to itself
  QuadraticFacets facets_;
};

}  // namespace

template <int dim>
std::shared_ptr<const QuadraticFacets> quadratic_facets(const MeshData<dim>& data,
                                                        std::span<const BoundaryFacet> boundary)
{
  Collector<dim> collector(data);
  for (const BoundaryFacet& facet : boundary)
    if (facet.tag >= 0) collector.add(facet);
  QuadraticFacets facets = collector.take();
  facets.first = first_facets<dim>(data, boundary);
  return std::make_shared<const QuadraticFacets>(std::move(facets));
}

template <int dim>
double sagitta(const QuadraticFacets& facets, int tag)
{
  constexpr auto& edges = local_edges<dim - 1>;
  constexpr double at_centre = 4.0 / 9;  // of a triangle: 4 lambda_i lambda_j
  constexpr double rounding = 1e-13;
  double largest = 0;
  double far = 0;
  for (std::size_t f = 0; f < facets.tags.size(); ++f)
  {
    if (facets.tags[f] != tag) continue;
    const Index* nodes = &facets.nodes[f * n_facet_nodes<dim>];
    const auto position = [&](int node) { return Point<dim>(&facets.points[nodes[node] * dim]); };
    Point<dim> sum = Point<dim>::Zero();
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      const Point<dim> off =
          position(static_cast<int>(dim + e)) - (position(edges[e][0]) + position(edges[e][1])) / 2;
      largest = std::max(largest, off.norm());
      far = std::max(far, position(edges[e][0]).norm());
      sum += off;
    }
    if (dim == 3) largest = std::max(largest, at_centre * sum.norm());
  }
  return largest > rounding * far ? largest : 0;
}

template std::shared_ptr<const QuadraticFacets> quadratic_facets(const MeshData<2>&,
                                                                 std::span<const BoundaryFacet>);
template std::shared_ptr<const QuadraticFacets> quadratic_facets(const MeshData<3>&,
                                                                 std::span<const BoundaryFacet>);
template double sagitta<2>(const QuadraticFacets&, int);
template double sagitta<3>(const QuadraticFacets&, int);

}  // namespace tribound::mesh
