#include "tribound/mesh/box.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tribound/mesh/marked_cell.h"

namespace tribound::mesh
{

namespace
{

/// The cells of the unit cube; bit a of a corner is its coordinate along axis a.
template <int dim>
constexpr auto cube_cells = []
{
  if constexpr (dim == 2)
    return std::array<Cell<2>, 2>{{{0, 1, 3}, {0, 3, 2}}};
  else  // one tetrahedron per order of the axes; odd orders with two corners swapped
    return std::array<Cell<3>, 6>{
        {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};
}();

template <int dim>
constexpr int n_sides = 2 * dim;

/// Steps through the grid points below `counts`, the first axis fastest; calls visit(grid point).
template <int dim, class Visit>
void for_each_grid_point(const std::array<Index, dim>& counts, const Visit& visit)
{
  std::array<Index, dim> at{};
  for (int i = 0; i < dim;)
  {
    visit(at);
    for (i = 0; i < dim && ++at[i] == counts[i]; ++i) at[i] = 0;
  }
}

/// The sides of the box on which a facet of a cube's cell lies.
template <int dim, class Visit>
void for_each_side(const std::array<Index, dim>& corners, const std::array<Index, dim>& cube,
                   std::span<const int> n_cubes, const Visit& visit)
{
  Index all = ~0;
  Index any = 0;
  for (const Index corner : corners)
  {
    all &= corner;
    any |= corner;
  }
  for (int axis = 0; axis < dim; ++axis)
  {
    if (cube[axis] == 0 && (any >> axis & 1) == 0) visit(2 * axis);
    if (cube[axis] == n_cubes[axis] - 1 && (all >> axis & 1) != 0) visit(2 * axis + 1);
  }
}

/// The points and cubes of the grid.
template <int dim>
struct Grid
{
  explicit Grid(const BoxMesh& of) : box(of)
  {
    for (int i = 0; i < dim; ++i)
    {
      n_cubes[i] = box.cells[i];
      stride[i] = i == 0 ? 1 : stride[i - 1] * (std::int64_t{n_cubes[i - 1]} + 1);
    }
  }

  [[nodiscard]] Point<dim> point(const std::array<Index, dim>& at) const
  {
    Point<dim> x;
    for (int i = 0; i < dim; ++i) x[i] = std::lerp(box.lower[i], box.upper[i], double(at[i]) / n_cubes[i]);
    return x;
  }
  /// The grid point of a corner of a cube.
  [[nodiscard]] std::array<Index, dim> corner(std::array<Index, dim> cube, Index corner) const
  {
    for (int i = 0; i < dim; ++i) cube[i] += corner >> i & 1;
    return cube;
  }
  [[nodiscard]] std::int64_t vertex(const std::array<Index, dim>& at) const
  {
    std::int64_t v = 0;
    for (int i = 0; i < dim; ++i) v += at[i] * stride[i];
    return v;
  }
  /// The cube with this number in the order of for_each_grid_point().
  [[nodiscard]] std::array<Index, dim> cube(std::int64_t number) const
  {
    std::array<Index, dim> at;
    for (int i = 0; i < dim; ++i)
    {
      at[i] = static_cast<Index>(number % n_cubes[i]);
      number /= n_cubes[i];
    }
    return at;
  }

  const BoxMesh& box;
  std::array<Index, dim> n_cubes;
  std::array<std::int64_t, dim> stride;  ///< between the vertex numbers of neighbours along an axis
};

void expect(const BoxMesh& box, bool good, const char* key, const std::string& problem,
            const std::string& hint)
{
  if (good) return;
  Where where = box.where;
  where.key += key;
  throw InputError(where, problem, hint);
}

/// Throws InputError if there are more cells than `most`.
void expect_at_most(const BoxMesh& box, std::int64_t most)
{
  double n_cells = box.lower.size() == 2 ? 2.0 : 6.0;
  for (const int cubes : box.cells) n_cells *= cubes;
  expect(box, n_cells <= static_cast<double>(most), ".cells", fmt::format("makes {:.3g} simplices", n_cells),
         fmt::format("at most {}", most));
}

}  // namespace

void require_valid(const BoxMesh& box)
{
  const std::size_t dim = box.lower.size();
  expect(box, (dim == 2 || dim == 3) && box.upper.size() == dim && box.cells.size() == dim, "",
         fmt::format("lower, upper and cells have {}, {} and {} numbers", dim, box.upper.size(),
                     box.cells.size()),
         "each has 2 in 2D, 3 in 3D");
  for (std::size_t i = 0; i < dim; ++i)
  {
    expect(box, std::isfinite(box.lower[i]) && std::isfinite(box.upper[i]), "",
           fmt::format("reaches from {} to {} along {}", box.lower[i], box.upper[i], "xyz"[i]),
           "finite numbers in lower and upper");
    expect(box, box.lower[i] < box.upper[i], ".upper",
           fmt::format("upper[{}] = {} is not above lower[{}] = {}", i, box.upper[i], i, box.lower[i]),
           "lower and upper are opposite corners of the box");
    expect(box, box.cells[i] >= 1, ".cells", fmt::format("cells[{}] = {}", i, box.cells[i]),
           "at least one cell along every axis");
  }
  constexpr std::int64_t most_of_ranks = 1'000'000'000'000'000;  // sums of several boxes are numbers, too
  expect_at_most(box, most_of_ranks);
}

template <int dim>
MeshLabels box_labels(const BoxMesh& box)
{
  require_valid(box);
  if (box.lower.size() != dim)
    throw InputError(box.where, fmt::format("the box has {} dimensions", box.lower.size()),
                     fmt::format("a mesh in {}D needs {} coordinates for each corner", dim, dim));
  MeshLabels labels{{"box"}, {"left", "right", "bottom", "top"}, box.where};
  if (dim == 3) labels.boundary_names.insert(labels.boundary_names.end(), {"back", "front"});
  return labels;
}

template <int dim>
MeshLabels box_labels(const Boxes& boxes)
{
  MeshLabels all;
  for (const auto& [name, box] : boxes)
  {
    const MeshLabels labels = box_labels<dim>(box);
    all.region_names.push_back(name);
    for (const std::string& side : labels.boundary_names)
      all.boundary_names.push_back(fmt::format("{}.{}", name, side));
    if (all.source.file.empty()) all.source = labels.source;
  }
  return all;
}

template <int dim>
MeshData<dim> box_mesh(const BoxMesh& box)
{
  MeshData<dim> data{box_labels<dim>(box)};
  expect_at_most(box, std::numeric_limits<Index>::max() / Topology<3>::n_cell_edges);
  const Grid<dim> grid(box);
  std::array<Index, dim> n_points = grid.n_cubes;
  for (Index& n : n_points) ++n;
  for_each_grid_point<dim>(n_points, [&](const auto& at) { data.vertices.push_back(grid.point(at)); });
  for_each_grid_point<dim>(grid.n_cubes,
                           [&](const auto& cube)
                           {
                             for (const Cell<dim>& corners : cube_cells<dim>)
                             {
                               Cell<dim>& cell = data.cells.emplace_back();
                               for (int i = 0; i <= dim; ++i)
                                 cell[i] = static_cast<Index>(grid.vertex(grid.corner(cube, corners[i])));
                               for (int i = 0; i <= dim; ++i)
                                 for_each_side<dim>(facet_vertices(corners, i), cube, grid.n_cubes,
                                                    [&](int tag) {
                                                      data.facets.push_back({facet_vertices(cell, i), tag});
                                                    });
                             }
                           });
  data.regions.assign(data.cells.size(), 0);
  return data;
}

template <int dim>
MeshData<dim> box_meshes(const Boxes& boxes)
{
  MeshData<dim> all{box_labels<dim>(boxes)};
  for (int region = 0; region < static_cast<int>(boxes.size()); ++region)
  {
    MeshData<dim> data = box_mesh<dim>(boxes[region].box);
    const auto first_vertex = static_cast<Index>(all.vertices.size());
    const int first_group = n_sides<dim> * region;
    all.vertices.insert(all.vertices.end(), data.vertices.begin(), data.vertices.end());
    for (Cell<dim>& cell : data.cells)
      for (Index& v : cell) v += first_vertex;
    all.cells.insert(all.cells.end(), data.cells.begin(), data.cells.end());
    all.regions.resize(all.cells.size(), region);
    for (auto& [vertices, tag] : data.facets)
    {
      for (Index& v : vertices) v += first_vertex;
      all.facets.push_back({vertices, tag + first_group});
    }
  }
  return all;
}

std::int64_t n_box_cells(const BoxMesh& box)
{
  std::int64_t n = box.lower.size() == 2 ? 2 : 6;
  for (const int cubes : box.cells) n *= cubes;
  return n;
}

std::int64_t n_box_cells(const Boxes& boxes)
{
  std::int64_t n = 0;
  for (const NamedBox& named : boxes) n += n_box_cells(named.box);
  return n;
}

std::optional<std::int64_t> n_box_cells(const MeshSource& source)
{
  if (const auto* box = std::get_if<BoxMesh>(&source)) return n_box_cells(*box);
  if (const auto* boxes = std::get_if<Boxes>(&source)) return n_box_cells(*boxes);
  return std::nullopt;
}

BoxMesh coarser_box(BoxMesh box, std::int64_t most_cells)
{
  while (n_box_cells(box) > most_cells)
    for (int& n : box.cells) n = (n + 1) / 2;
  return box;
}

template <int dim>
std::vector<CellRecord<dim>> box_records(const BoxMesh& box, std::int64_t first, std::int64_t last)
{
  constexpr auto n_in_cube = static_cast<std::int64_t>(cube_cells<dim>.size());
  const Grid<dim> grid(box);
  std::vector<CellRecord<dim>> records;
  records.reserve(last - first);
  for (std::int64_t number = first; number < last; ++number)
  {
    const auto cube = grid.cube(number / n_in_cube);
    const Cell<dim>& corners = cube_cells<dim>[number % n_in_cube];
    std::array<Point<dim>, dim + 1> points;
    Cell<dim> own;  // numbers in `points`
    for (int i = 0; i <= dim; ++i)
    {
      points[i] = grid.point(grid.corner(cube, corners[i]));
      own[i] = i;
    }
    const MarkedCell<dim> marked = longest_edges_marked<dim>(points, own);
    CellRecord<dim>& record = records.emplace_back();
    record.name.root = number;
    record.region = 0;
    record.bisection_type = marked.type;
    for (int i = 0; i <= dim; ++i)
    {
      const Index local = marked.vertices[i];
      record.vertices[i] = vertex_name<dim>(points[local], grid.vertex(grid.corner(cube, corners[local])));
      record.tags[i] = facet_inside;
      for_each_side<dim>(facet_vertices(corners, local), cube, grid.n_cubes,
                         [&](int tag) { record.tags[i] = tag; });
    }
  }
  return records;
}

Boxes coarser_box(Boxes boxes, std::int64_t most_cells)
{
  const auto share = static_cast<double>(most_cells) / static_cast<double>(n_box_cells(boxes));
  if (share >= 1) return boxes;
  for (NamedBox& named : boxes)
  {
    const std::int64_t least = named.box.lower.size() == 2 ? 2 : 6;
    const auto most = static_cast<std::int64_t>(share * static_cast<double>(n_box_cells(named.box)));
    named.box = coarser_box(named.box, std::max(least, most));
  }
  return boxes;
}

MeshSource coarser_box(MeshSource source, std::int64_t most_cells)
{
  if (const auto* box = std::get_if<BoxMesh>(&source)) return coarser_box(*box, most_cells);
  if (const auto* boxes = std::get_if<Boxes>(&source)) return coarser_box(*boxes, most_cells);
  return source;
}

template <int dim>
std::vector<CellRecord<dim>> box_records(const Boxes& boxes, std::int64_t first, std::int64_t last)
{
  std::vector<CellRecord<dim>> all;
  std::int64_t first_cell = 0;
  std::uint64_t first_vertex = 0;
  for (int region = 0; region < static_cast<int>(boxes.size()); ++region)
  {
    const BoxMesh& box = boxes[region].box;
    const std::int64_t n = n_box_cells(box);
    const std::int64_t begin = std::clamp<std::int64_t>(first - first_cell, 0, n);
    const std::int64_t end = std::clamp<std::int64_t>(last - first_cell, 0, n);
    for (CellRecord<dim>& record : box_records<dim>(box, begin, end))
    {
      record.name.root += first_cell;
      record.region = region;
      for (VertexName<dim>& vertex : record.vertices) vertex.origin += first_vertex;
      for (std::int32_t& tag : record.tags)
        if (tag >= 0) tag += n_sides<dim> * region;
      all.push_back(record);
    }
    first_cell += n;
    std::uint64_t n_vertices = 1;
    for (const int cubes : box.cells) n_vertices *= static_cast<std::uint64_t>(cubes) + 1;
    first_vertex += n_vertices;
  }
  return all;
}

template MeshLabels box_labels<2>(const Boxes&);
template MeshLabels box_labels<3>(const Boxes&);
template std::vector<CellRecord<2>> box_records<2>(const Boxes&, std::int64_t, std::int64_t);
template std::vector<CellRecord<3>> box_records<3>(const Boxes&, std::int64_t, std::int64_t);
template MeshLabels box_labels<2>(const BoxMesh&);
template MeshLabels box_labels<3>(const BoxMesh&);
template std::vector<CellRecord<2>> box_records<2>(const BoxMesh&, std::int64_t, std::int64_t);
template std::vector<CellRecord<3>> box_records<3>(const BoxMesh&, std::int64_t, std::int64_t);
template MeshData<2> box_mesh<2>(const BoxMesh&);
template MeshData<2> box_meshes<2>(const Boxes&);
template MeshData<3> box_meshes<3>(const Boxes&);
template MeshData<3> box_mesh<3>(const BoxMesh&);

}  // namespace tribound::mesh
