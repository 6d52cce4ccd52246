#include "tribound/mesh/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "tribound/mesh/geometry.h"

namespace tribound::mesh
{

namespace
{

/// The octahedron between the middles of a tetrahedron's edges, by local edges: a diagonal, then the other
/// four corners in the order in which they run around it, right-handed.
constexpr std::array<std::array<int, 6>, 3> octahedron_diagonals{
    {{0, 5, 1, 2, 4, 3}, {1, 4, 2, 0, 3, 5}, {2, 3, 0, 1, 5, 4}}};

/// Vertices of the refined mesh on one cell: the middles of its local edges.
template <int dim>
using EdgeMiddles = std::array<Index, Topology<dim>::n_cell_edges>;

template <int dim>
Index middle_between(const EdgeMiddles<dim>& middles, int a, int b)
{
  const auto edge = std::ranges::find(local_edges<dim>, std::array{std::min(a, b), std::max(a, b)});
  return middles[edge - local_edges<dim>.begin()];
}

/// The children of a cell, or of one of its facets, at its vertices: each is the whole, halved towards the
/// vertex. `corners`: local vertices.
template <int dim, std::size_t n, class Visit>
void for_each_corner_child(const Cell<dim>& cell, const EdgeMiddles<dim>& middles,
                           const std::array<int, n>& corners, const Visit& visit)
{
  for (const int corner : corners)
  {
    std::array<Index, n> child;
    for (std::size_t j = 0; j < n; ++j)
      child[j] = corners[j] == corner ? cell[corner] : middle_between<dim>(middles, corner, corners[j]);
    visit(child);
  }
}

/// The triangle between the middles of three edges, oriented as (a, b, c).
template <int dim>
std::array<Index, 3> middle_triangle(const EdgeMiddles<dim>& middles, const std::array<int, 3>& corners)
{
  const auto& [a, b, c] = corners;
  return {middle_between<dim>(middles, b, c), middle_between<dim>(middles, c, a),
          middle_between<dim>(middles, a, b)};
}

/// The shortest diagonal of the octahedron; among equal ones that with the end that comes first in space,
/// which makes Kuhn's tetrahedra again of those of a box. Neither round-off nor the numbering may decide.
const std::array<int, 6>& shortest_diagonal(std::span<const Point<3>> vertices, const EdgeMiddles<3>& middles)
{
  constexpr double clearly_shorter = 1 - 1e-12;
  const std::array<int, 6>* best = nullptr;
  double shortest = std::numeric_limits<double>::infinity();
  Point<3> first_end = Point<3>::Zero();
  for (const auto& candidate : octahedron_diagonals)
  {
    Point<3> from = vertices[middles[candidate[0]]];
    Point<3> to = vertices[middles[candidate[1]]];
    if (comes_before(to, from)) std::swap(from, to);
    const double length = (to - from).squaredNorm();
    const bool as_short = best && length < shortest / clearly_shorter && comes_before(from, first_end);
    if (length >= clearly_shorter * shortest && !as_short) continue;
    shortest = std::min(shortest, length);
    first_end = from;
    best = &candidate;
  }
  return *best;
}

template <int dim>
void add_children(const Cell<dim>& cell, const EdgeMiddles<dim>& middles, MeshData<dim>& data)
{
  const auto add = [&](const Cell<dim>& child) { data.cells.push_back(child); };
  if constexpr (dim == 2)
  {
    constexpr std::array corners{0, 1, 2};
    for_each_corner_child<dim>(cell, middles, corners, add);
    add(middle_triangle<dim>(middles, corners));
  }
  else
  {
    for_each_corner_child<dim>(cell, middles, std::array{0, 1, 2, 3}, add);
    const auto& [from, to, a, b, c, d] = shortest_diagonal(data.vertices, middles);
    for (const auto& [i, j] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
      add({middles[from], middles[to], middles[i], middles[j]});
  }
}

template <int dim>
void add_facet_children(const Cell<dim>& cell, const EdgeMiddles<dim>& middles, const BoundaryFacet& facet,
                        MeshData<dim>& data)
{
  const auto add = [&](const std::array<Index, dim>& child) { data.facets.push_back({child, facet.tag}); };
  std::array<int, dim> corners;
  for (int j = 0; j < dim; ++j) corners[j] = j < facet.local ? j : j + 1;
  for_each_corner_child<dim>(cell, middles, corners, add);
  if constexpr (dim == 3) add(middle_triangle<dim>(middles, corners));
}

template <int dim>
Mesh<dim> refine_once(const Mesh<dim>& mesh)
{
  const Topology<dim>& topology = mesh.topology();
  MeshData<dim> data{mesh.labels()};
  data.vertices.assign(mesh.vertices().begin(), mesh.vertices().end());
  for (const auto& [a, b] : topology.edges) data.vertices.push_back(0.5 * (mesh.vertex(a) + mesh.vertex(b)));

  const auto middles = [&](Index cell)
  {
    EdgeMiddles<dim> vertices;
    for (std::size_t e = 0; e < vertices.size(); ++e)
      vertices[e] = mesh.n_vertices() + topology.cell_edges[cell][e];
    return vertices;
  };
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    add_children<dim>(mesh.cell(c), middles(c), data);
    data.regions.resize(data.cells.size(), mesh.region(c));
  }
  for (const BoundaryFacet& facet : mesh.boundary())
    if (facet.tag >= 0) add_facet_children<dim>(mesh.cell(facet.cell), middles(facet.cell), facet, data);

  return Mesh<dim>(std::move(data));
}

}  // namespace

template <int dim>
EntityCounts count_after_refinement(const Mesh<dim>& mesh, int times)
{
  const Topology<dim>& topology = mesh.topology();
  EntityCounts n{static_cast<double>(mesh.n_vertices()), static_cast<double>(topology.edges.size()),
                 static_cast<double>(topology.facets.size()), static_cast<double>(mesh.n_cells())};
  for (int i = 0; i < times; ++i)
  {
    if constexpr (dim == 2)
    {
      const double edges = 2 * n.edges + 3 * n.cells;
      n = {n.vertices + n.edges, edges, edges, 4 * n.cells};
    }
    else
      n = {n.vertices + n.edges, 2 * n.edges + 3 * n.facets + n.cells, 4 * n.facets + 8 * n.cells,
           8 * n.cells};
  }
  return n;
}

template <int dim>
Refined<dim> refine_uniformly(const Mesh<dim>& mesh, int times)
{
  assert(times >= 1);
  const double n_cells = count_after_refinement(mesh, times).cells;
  if (n_cells * Topology<dim>::n_cell_edges > std::numeric_limits<Index>::max())
    throw InputError(mesh.source(),
                     fmt::format("refined uniformly {} times, the mesh has {:.3g} cells: too many for 32-bit "
                                 "numbers",
                                 times, n_cells),
                     "refine fewer times, or take a coarser mesh");
  Mesh<dim> refined = refine_once(mesh);
  for (int i = 1; i < times; ++i) refined = refine_once(refined);
  return {std::move(refined), times};
}

template EntityCounts count_after_refinement(const Mesh<2>&, int);
template EntityCounts count_after_refinement(const Mesh<3>&, int);
template Refined<2> refine_uniformly(const Mesh<2>&, int);
template Refined<3> refine_uniformly(const Mesh<3>&, int);

}  // namespace tribound::mesh
