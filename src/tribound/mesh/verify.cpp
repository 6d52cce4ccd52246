#include "tribound/mesh/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/marked_cell.h"

namespace tribound::mesh
{

namespace
{

/// A cell with det J below this multiple of h_T^dim has no usable reference map.
constexpr double smallest_shape = 1e-12;

/// Coordinates and cells beyond these have volumes outside the range of a double.
constexpr double largest_coordinate = 1e60;
constexpr double smallest_diameter = 1e-60;

template <int dim>
bool same_vertices(Cell<dim> a, Cell<dim> b)
{
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

template <int dim>
[[noreturn]] void throw_duplicate(const MeshData<dim>& data, Index a, Index b)
{
  throw InputError(data.source, fmt::format("{} is the same as number {}", describe_cell(data, b), a),
                   "remove the copy; in Gmsh, a surface or volume that is defined twice gives such cells, "
                   "\"Coherence;\" merges the definitions");
}

/// Names a facet with three cells or more; says so if two of them are copies of one cell.
template <int dim>
[[noreturn]] void throw_crowded_facet(const MeshData<dim>& data, const Topology<dim>& topology)
{
  for (Index c = 0;; ++c)
    for (int i = 0; i <= dim; ++i)
    {
      const Index f = topology.cell_facets[c][i];
      const auto [first, second] = topology.facet_cells[f];
      if (c == first || c == second) continue;
      for (const auto& [a, b] : {std::pair{first, second}, {first, c}, {second, c}})
        if (same_vertices<dim>(data.cells[a], data.cells[b])) throw_duplicate(data, a, b);
      throw InputError(data.source,
                       fmt::format("{} belongs to more than two cells: numbers {}, {} and {}",
                                   describe_facet<dim>(data, topology.facets[f]), first, second, c),
                       "cells overlap here; remove the overlapping part");
    }
}

/// +1 or -1: the orientation that the cell, positively oriented itself, induces on its local facet, relative
/// to the facet's vertices in ascending order.
template <int dim>
int induced_orientation(const Cell<dim>& cell, int local)
{
  const auto v = facet_vertices(cell, local);
  bool odd = (local % 2 != 0) != (v[0] > v[1]);
  if constexpr (dim == 3) odd = (odd != (v[0] > v[2])) != (v[1] > v[2]);
  return odd ? -1 : 1;
}

/// The number of cells that can be reached from the first cell around v through facets that contain v.
/// `seen[c] == v` marks cells reached; `queue` is working space.
template <int dim>
std::size_t connected_cells(const MeshData<dim>& data, const Topology<dim>& topology, Index v,
                            std::vector<Index>& seen, std::vector<Index>& queue)
{
  queue.assign(1, topology.vertex_cells[topology.vertex_cells_begin[v]]);
  seen[queue[0]] = v;
  for (std::size_t next = 0; next < queue.size(); ++next)
  {
    const Index c = queue[next];
    for (int i = 0; i <= dim; ++i)
    {
      if (data.cells[c][i] == v) continue;
      const auto [first, second] = topology.facet_cells[topology.cell_facets[c][i]];
      const Index neighbour = first == c ? second : first;
      if (neighbour < 0 || seen[neighbour] == v) continue;
      seen[neighbour] = v;
      queue.push_back(neighbour);
    }
  }
  return queue.size();
}

template <int dim>
bool ancestry_fits(const MeshData<dim>& data)
{
  const auto& [n_vertices, halved_edges] = data.ancestry;
  const auto n = static_cast<Index>(data.vertices.size());
  const Index first = n_vertices.empty() ? n : n_vertices.front();
  if (first < 0 || (!n_vertices.empty() && n_vertices.back() > n) || !std::ranges::is_sorted(n_vertices) ||
      halved_edges.size() != static_cast<std::size_t>(n - first))
    return false;
  for (Index v = first; v < n; ++v)
    for (const Index end : halved_edges[v - first])
      if (end < 0 || end >= v) return false;
  return true;
}

}  // namespace

template <int dim>
void check_arrays(const MeshData<dim>& data)
{
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  const std::size_t n_cells = data.cells.size();
  if (n_cells == 0) throw InputError(data.source, "the mesh has no cells");
  if (n_cells > most / Topology<dim>::n_cell_edges || data.vertices.size() > most)
    throw InputError(data.source, fmt::format("{} cells are too many for 32-bit numbers", n_cells));
  if (data.regions.size() != n_cells)
    throw InputError(data.source,
                     fmt::format("{} region numbers for {} cells", data.regions.size(), n_cells));
  if (!data.bisection_types.empty() && data.bisection_types.size() != n_cells)
    throw InputError(data.source,
                     fmt::format("{} bisection types for {} cells", data.bisection_types.size(), n_cells));
  if (!ancestry_fits(data))
    throw InputError(data.source, "the ancestry of the mesh does not fit its vertices");

  const auto in_range = [](Index i, std::size_t n) { return i >= 0 && static_cast<std::size_t>(i) < n; };
  for (std::size_t v = 0; v < data.vertices.size(); ++v)
    if (!data.vertices[v].allFinite())
      throw InputError(data.source,
                       fmt::format("vertex {} has coordinates {}, which are not finite numbers", v,
                                   describe(data.vertices[v])),
                       "the program that made the mesh failed there; mesh or convert again");
  for (std::size_t c = 0; c < data.bisection_types.size(); ++c)
    if (data.bisection_types[c] >= n_bisection_types<dim>)
      throw InputError(data.source, fmt::format("cell {} is of bisection type {}; there are {} types", c,
                                                data.bisection_types[c], n_bisection_types<dim>));
  for (std::size_t c = 0; c < n_cells; ++c)
  {
    if (!in_range(data.regions[c], data.region_names.size()))
      throw InputError(data.source, fmt::format("cell {} is in region number {}; there are {} regions", c,
                                                data.regions[c], data.region_names.size()));
    for (const Index v : data.cells[c])
      if (!in_range(v, data.vertices.size()))
        throw InputError(data.source, fmt::format("cell {} has the vertex number {}; there are {} vertices",
                                                  c, v, data.vertices.size()));
  }
  for (const auto& [vertices, tag] : data.facets)
  {
    if (!in_range(tag, data.boundary_names.size()))
      throw InputError(data.source, fmt::format("a facet is in boundary group number {}; there are {} groups",
                                                tag, data.boundary_names.size()));
    for (const Index v : vertices)
      if (!in_range(v, data.vertices.size()))
        throw InputError(
            data.source,
            fmt::format("a facet of group \"{}\" has the vertex number {}; there are {} vertices",
                        data.boundary_names[tag], v, data.vertices.size()));
  }
}

template <int dim>
std::optional<ShapeFault> shape_fault(const std::array<Point<dim>, dim + 1>& corners)
{
  const double h = diameter(corners);
  if (h < smallest_diameter || h > largest_coordinate)
    return ShapeFault{fmt::format("has the diameter {:.3g}, whose powers are not in the range of numbers", h),
                      "take other units of length"};
  const double det = determinant(corners);
  const double scale = dim == 2 ? h * h : h * h * h;
  if (det > smallest_shape * scale) return {};
  if (det < -smallest_shape * scale)
    return ShapeFault{
        fmt::format("is inverted: its vertices are in {} order", dim == 2 ? "clockwise" : "left-handed"),
        dim == 2 ? "list the vertices counterclockwise"
                 : "list the vertices such that the fourth lies on the side of the first three from "
                   "which they run counterclockwise"};
  return ShapeFault{fmt::format("is degenerate: its {} is {:.3g} for a diameter of {:.3g}",
                                dim == 2 ? "area" : "volume", std::abs(det) / factorial<dim>, h),
                    "mesh again with a better size, or remove duplicate points"};
}

template <int dim>
void check_shapes(const MeshData<dim>& data)
{
  for (std::size_t c = 0; c < data.cells.size(); ++c)
    if (const auto fault = shape_fault<dim>(points_of<dim>(data.vertices, data.cells[c])))
      throw InputError(data.source,
                       fmt::format("{} {}", describe_cell(data, static_cast<Index>(c)), fault->problem),
                       fault->hint);
}

template <int dim>
void check_facets(const MeshData<dim>& data, const Topology<dim>& topology)
{
  const std::size_t n_slots = data.cells.size() * (dim + 1);
  std::size_t n_counted = 0;
  for (const auto& [first, second] : topology.facet_cells) n_counted += second < 0 ? 1 : 2;
  if (n_counted != n_slots) throw_crowded_facet(data, topology);

  std::vector<signed char> orientation(topology.facets.size(), 0);
  for (std::size_t c = 0; c < data.cells.size(); ++c)
    for (int i = 0; i <= dim; ++i)
      orientation[topology.cell_facets[c][i]] +=
          static_cast<signed char>(induced_orientation<dim>(data.cells[c], i));
  for (std::size_t f = 0; f < topology.facets.size(); ++f)
  {
    const auto [first, second] = topology.facet_cells[f];
    if (second < 0 || orientation[f] == 0) continue;
    if (same_vertices<dim>(data.cells[first], data.cells[second])) throw_duplicate(data, first, second);
    throw InputError(data.source,
                     fmt::format("{} and {} overlap: they lie on the same side of their common {}",
                                 describe_cell(data, first), describe_cell(data, second),
                                 describe_facet<dim>(data, topology.facets[f])),
                     "remove one of them; the mesh is folded here");
  }
}

template <int dim>
void check_vertices(const MeshData<dim>& data, const Topology<dim>& topology, std::span<const char> which)
{
  std::vector<Index> seen(data.cells.size(), -1);
  std::vector<Index> queue;
  for (Index v = 0; v < static_cast<Index>(data.vertices.size()); ++v)
  {
    if (!which.empty() && which[v] == 0) continue;
    const auto n =
        static_cast<std::size_t>(topology.vertex_cells_begin[v + 1] - topology.vertex_cells_begin[v]);
    if (n == 0)
      throw InputError(data.source, fmt::format("{} belongs to no cell", describe_vertex(data, v)),
                       "remove it; Gmsh leaves such points out when a mesh is saved by physical groups "
                       "(Mesh.SaveAll=0)");
    if (connected_cells(data, topology, v, seen, queue) != n)
      throw InputError(
          data.source,
          fmt::format("the {} cells around {} are not connected through {}", n, describe_vertex(data, v),
                      dim == 2 ? "edges" : "faces"),
          dim == 2 ? "parts of the domain must not touch in a single point; join them along an edge "
                     "or move them apart"
                   : "parts of the domain must not touch in a single point or edge; join them across a "
                     "face or move them apart");
  }
}

template void check_arrays<2>(const MeshData<2>&);
template void check_arrays<3>(const MeshData<3>&);
template std::optional<ShapeFault> shape_fault<2>(const std::array<Point<2>, 3>&);
template std::optional<ShapeFault> shape_fault<3>(const std::array<Point<3>, 4>&);
template void check_shapes<2>(const MeshData<2>&);
template void check_shapes<3>(const MeshData<3>&);
template void check_facets<2>(const MeshData<2>&, const Topology<2>&);
template void check_facets<3>(const MeshData<3>&, const Topology<3>&);
template void check_vertices<2>(const MeshData<2>&, const Topology<2>&, std::span<const char>);
template void check_vertices<3>(const MeshData<3>&, const Topology<3>&, std::span<const char>);

}  // namespace tribound::mesh
