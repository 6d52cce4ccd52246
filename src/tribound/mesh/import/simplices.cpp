#include "tribound/mesh/import/simplices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/cell_sets.h"
#include "tribound/mesh/import/node_sets.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

template <std::size_t n>
bool are_distinct(const std::array<Index, n>& vertices)
{
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (vertices[i] == vertices[j]) return false;
  return true;
}

/// The place of the smallest number.
std::size_t lowest(std::span<const Index> vertices)
{
  return std::ranges::min_element(vertices) - vertices.begin();
}

/// The one or two simplices of a face or of a facet, through its smallest vertex.
template <int n, class Emit>
void cut_face(std::span<const Index> corners, const Emit& emit)
{
  if constexpr (n == 2)
    emit(std::array{corners[0], corners[1]});
  else if (corners.size() == 3)
    emit(std::array{corners[0], corners[1], corners[2]});
  else
  {
    const std::size_t k = lowest(corners);
    const auto at = [&](std::size_t i) { return corners[(k + i) % 4]; };
    for (std::size_t i = 1; i < 3; ++i)
      if (const std::array triangle = {at(0), at(i), at(i + 1)}; are_distinct(triangle)) emit(triangle);
  }
}

/// The simplices of a cell: those of its faces without its smallest vertex, joined to that. Their vertices
/// are in positive order where those of the cell are.
template <int dim, class Emit>
void cut_cell(const ShapeTable& table, std::span<const Index> corners, const Emit& emit)
{
  Cell<dim> cell;
  if (table.n_corners == dim + 1)
  {
    std::copy_n(corners.begin(), dim + 1, cell.begin());
    emit(cell);
    return;
  }
  const Index apex = corners[lowest(corners)];
  for (const FaceCorners& face : std::span(table.faces).first(table.n_faces))
  {
    std::array<Index, 4> vertices{};
    for (int i = 0; i < face.n; ++i) vertices[i] = corners[face.corners[i]];
    const auto of_face = std::span<const Index>(vertices).first(face.n);
    if (std::ranges::find(of_face, apex) != of_face.end()) continue;
    cut_face<dim>(of_face,
                  [&](const std::array<Index, dim>& simplex)
                  {
                    std::ranges::copy(simplex, cell.begin());
                    cell[dim] = apex;
                    if (are_distinct(cell)) emit(cell);
                  });
  }
}

template <int dim>
class Converter
{
 public:
  explicit Converter(ImportedMesh mesh) : mesh_(std::move(mesh)) {}

  SimplicialMesh convert(bool all_middles)
  {
    data_.source = mesh_.source;
    if constexpr (dim == 2) check_plane();
    add_node_sets(mesh_, notes_);
    number_vertices();
    find_regions();
    std::size_t first = 0;
    for (const ElementBlock& block : mesh_.cells)
    {
      add_cells(block, first);
      first += block.size();
    }
    for (const FacetSet& set : mesh_.facet_sets) add_facets(set);
    note_order();
    if (all_middles) add_all_middles();
    if (!mesh_.source.file.empty())
      for (std::string& note : notes_) note.insert(0, mesh_.source.file + ": ");
    return {std::move(data_), std::move(notes_)};
  }

 private:
  [[nodiscard]] std::string describe_node(Index node) const
  {
    return fmt::format("node {} at {}", mesh_.node_numbers[node], describe(mesh_.nodes[node]));
  }
  void check_plane() const;
  void number_vertices();
  void find_regions();
  void add_cells(const ElementBlock& block, std::size_t first);
  void check_shapes(const ElementBlock& block, std::size_t first_cell,
                    std::span<const Index> element_of_cell) const;
  void add_facets(const FacetSet& set);
  void note_order();
  void add_all_middles();
  void add_edge_nodes(const ElementBlock& block, std::span<const Index> element);
  /// The vertex numbers of the corners of an element, until the next call.
  [[nodiscard]] std::span<const Index> corners_of(const ShapeTable& table, std::span<const Index> element)
  {
    for (int i = 0; i < table.n_corners; ++i) corners_[i] = vertex_of_node_[element[i]];
    return std::span<const Index>(corners_).first(table.n_corners);
  }

  ImportedMesh mesh_;
  MeshData<dim> data_;
  std::vector<std::string> notes_;
  std::vector<Index> vertex_of_node_;
  std::vector<int> region_of_cell_;  ///< per imported cell
  std::array<Index, 8> corners_{};
};

/// A plane mesh lies in z = 0, to 1e-12 of its size.
template <int dim>
void Converter<dim>::check_plane() const
{
  double size = 0.0;
  for (const ElementBlock& block : mesh_.cells)
    for (const Index node : block.nodes)
      size = std::max(size, mesh_.nodes[node].template lpNorm<Eigen::Infinity>());
  for (const ElementBlock& block : mesh_.cells)
    for (const Index node : block.nodes)
      if (!(std::abs(mesh_.nodes[node][2]) <= 1e-12 * size))
        throw InputError(
            mesh_.source,
            fmt::format("the mesh has no solids, and {} is not in the plane z = 0", describe_node(node)),
            "2D meshes lie in z = 0; a 3D problem needs the tetrahedra or hexahedra of its volume");
}

template <int dim>
void Converter<dim>::number_vertices()
{
  constexpr Index unused = -2;
  constexpr Index middle = -1;
  std::vector<Index>& number = vertex_of_node_;
  number.assign(mesh_.nodes.size(), unused);
  const auto mark = [&](const ElementBlock& block)
  {
    const int n_corners = table_of(block.type.shape).n_corners;
    for (std::size_t e = 0; e < block.size(); ++e)
      for (int i = 0; i < block.type.n_nodes; ++i)
      {
        Index& of_node = number[block.element(e)[i]];
        of_node = std::max(of_node, i < n_corners ? 0 : middle);
      }
  };
  for (const ElementBlock& block : mesh_.cells) mark(block);
  for (const FacetSet& set : mesh_.facet_sets) std::ranges::for_each(set.facets, mark);

  const auto n_unused = std::ranges::count(number, unused);
  if (n_unused > 0)
  {
    const auto example = static_cast<Index>(std::ranges::find(number, unused) - number.begin());
    notes_.push_back(fmt::format("{} of {} nodes belong to no element and are left out, such as {}", n_unused,
                                 number.size(), describe_node(example)));
  }
  data_.vertices.reserve(std::ranges::count(number, 0));
  for (std::size_t node = 0; node < number.size(); ++node)
  {
    if (number[node] < 0) continue;
    number[node] = static_cast<Index>(data_.vertices.size());
    data_.vertices.push_back(mesh_.nodes[node].template head<dim>());
  }
}

template <int dim>
void Converter<dim>::find_regions()
{
  std::size_t n_cells = 0;
  for (const ElementBlock& block : mesh_.cells) n_cells += block.size();
  region_of_cell_.assign(n_cells, mesh_.cell_sets.empty() ? 0 : -1);
  for (const CellSet& set : mesh_.cell_sets)
  {
    const auto region = static_cast<int>(data_.region_names.size());
    data_.region_names.push_back(set.name);
    for (const Index cell : set.cells)
    {
      if (const int other = region_of_cell_[cell]; other >= 0 && other != region)
        throw InputError(mesh_.source,
                         fmt::format("element {} is in two regions, \"{}\" and \"{}\"",
                                     number_of_cell(mesh_, cell), data_.region_names[other], set.name),
                         "every element is in one region: take it out of the other");
      region_of_cell_[cell] = region;
    }
  }
  if (mesh_.cell_sets.empty()) data_.region_names = {"domain"};
  if (const auto none = std::ranges::find(region_of_cell_, -1); none != region_of_cell_.end())
    throw InputError(mesh_.source,
                     fmt::format("element {} is in no region",
                                 number_of_cell(mesh_, static_cast<Index>(none - region_of_cell_.begin()))),
                     "put every element into a region, or use no regions at all");
}

/// Blocks of which all cells are inverted are turned: meshes of plane geometries, and mirrored ones.
template <int dim>
void Converter<dim>::add_cells(const ElementBlock& block, std::size_t first)
{
  const ShapeTable& table = table_of(block.type.shape);
  const std::size_t first_cell = data_.cells.size();
  std::vector<Index> element_of_cell;
  for (std::size_t e = 0; e < block.size(); ++e)
  {
    const std::size_t n_before = data_.cells.size();
    cut_cell<dim>(table, corners_of(table, block.element(e)),
                  [&](const Cell<dim>& cell) { data_.cells.push_back(cell); });
    if (data_.cells.size() == n_before)
      throw InputError(mesh_.source,
                       fmt::format("element {} ({}) has no volume: too many of its corners are the same node",
                                   block.numbers[e], describe(block.type)),
                       "remove it");
    data_.regions.resize(data_.cells.size(), region_of_cell_[first + e]);
    element_of_cell.resize(data_.cells.size() - first_cell, static_cast<Index>(e));
  }
  const auto added = std::span(data_.cells).subspan(first_cell);
  const auto is_negative = [&](const Cell<dim>& cell)
  { return determinant(points_of<dim>(data_.vertices, cell)) < 0.0; };
  if (std::ranges::all_of(added, is_negative))
    for (Cell<dim>& cell : added) std::swap(cell[dim - 1], cell[dim]);
  check_shapes(block, first_cell, element_of_cell);
}

/// As the mesh will check it, with the element of the file.
template <int dim>
void Converter<dim>::check_shapes(const ElementBlock& block, std::size_t first_cell,
                                  std::span<const Index> element_of_cell) const
{
  for (std::size_t k = 0; k < element_of_cell.size(); ++k)
  {
    const Cell<dim>& cell = data_.cells[first_cell + k];
    const auto corners = points_of<dim>(data_.vertices, cell);
    if (!std::ranges::all_of(corners, [](const Point<dim>& x) { return x.allFinite(); })) continue;
    const auto fault = shape_fault<dim>(corners);
    if (!fault) continue;
    const bool is_simplex = table_of(block.type.shape).n_corners == dim + 1;
    const std::string part =
        is_simplex ? "" : fmt::format(", whose {} ", dim == 2 ? "triangle" : "tetrahedron");
    throw InputError(
        mesh_.source,
        fmt::format("element {} ({}) of region \"{}\"{}with corners {} {}", block.numbers[element_of_cell[k]],
                    describe(block.type), data_.region_names[data_.regions[first_cell + k]],
                    is_simplex ? " " : part, describe_corners(data_, cell), fault->problem),
        is_simplex ? fault->hint
                   : "it is cut through its vertices with the smallest numbers: mesh it again with less "
                     "distorted elements, or with tetrahedra");
  }
}

template <int dim>
void Converter<dim>::add_facets(const FacetSet& set)
{
  const auto tag = static_cast<int>(data_.boundary_names.size());
  data_.boundary_names.push_back(set.name);
  for (const ElementBlock& block : set.facets)
    for (std::size_t f = 0; f < block.size(); ++f)
    {
      cut_face<dim>(corners_of(table_of(block.type.shape), block.element(f)),
                    [&](const std::array<Index, dim>& vertices) {
                      data_.facets.push_back({vertices, tag});
                    });
      if (has_middles(block.type)) add_edge_nodes(block, block.element(f));
    }
}

/// Facets of second order keep their shape; of higher order nothing is left but the corners.
template <int dim>
void Converter<dim>::note_order()
{
  int order = 0;
  for (const ElementBlock& block : mesh_.cells) order = std::max(order, order_of(block.type));
  if (order > 2)
    notes_.push_back(fmt::format(
        "of elements of order {} only the corners are taken: curved edges become straight", order));
}

/// Those of the facets of the boundary.
template <int dim>
void Converter<dim>::add_all_middles()
{
  if (!std::ranges::any_of(mesh_.cells, has_middles, &ElementBlock::type)) return;
  const std::vector<char> all(mesh_.nodes.size(), 1);
  for (const CellFace& face : CellFaces(mesh_.cells, all).outer())
  {
    const FaceNodes nodes = nodes_of(mesh_.cells, face);
    if (has_middles(nodes.type)) add_edge_nodes({nodes.type}, nodes.span());
  }
}

/// The nodes on the edges of a facet of second order, and on the edge that cuts a quadrilateral: the centre,
/// where it has no node that of the surface through the other eight.
template <int dim>
void Converter<dim>::add_edge_nodes(const ElementBlock& block, std::span<const Index> element)
{
  const ShapeTable& table = table_of(block.type.shape);
  const auto position = [&](int i) -> const Point<3>& { return mesh_.nodes[element[i]]; };
  const auto add = [&](int a, int b, const Point<3>& x)
  {
    const std::array<Index, 2> ends = {vertex_of_node_[element[a]], vertex_of_node_[element[b]]};
    if (ends[0] != ends[1]) data_.edge_nodes.push_back({ends, x.template head<dim>()});
  };
  for (int e = 0; e < table.n_edges; ++e)
    add(table.edges[e][0], table.edges[e][1], position(table.n_corners + e));
  const std::span<const Index> corners = corners_of(table, element);
  if (corners.size() < 4 || !are_distinct(std::array{corners[0], corners[1], corners[2], corners[3]})) return;
  const auto k = static_cast<int>(lowest(corners));
  Point<3> centre = Point<3>::Zero();
  if (block.type.n_nodes == 9)
    centre = position(8);
  else
    for (int i = 0; i < 4; ++i) centre += position(4 + i) / 2 - position(i) / 4;
  add(k, (k + 2) % 4, centre);
}

}  // namespace

SimplicialMesh make_simplicial(ImportedMesh mesh, bool all_middles)
{
  const bool is_solid = !mesh.cells.empty() && table_of(mesh.cells.front().type.shape).dim == 3;
  return is_solid ? Converter<3>(std::move(mesh)).convert(all_middles)
                  : Converter<2>(std::move(mesh)).convert(all_middles);
}

}  // namespace tribound::mesh
