#pragma once

/// Meshes of all element types on a box, renumbered at random.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/import/simplex_nodes.h"

namespace tribound::testing_mesh
{

/// All types of cells of order 1 and 2.
inline const std::vector<mesh::ElementType> cell_types = {
    {mesh::Shape::triangle, 3},      {mesh::Shape::triangle, 6},      {mesh::Shape::quadrilateral, 4},
    {mesh::Shape::quadrilateral, 8}, {mesh::Shape::quadrilateral, 9}, {mesh::Shape::tetrahedron, 4},
    {mesh::Shape::tetrahedron, 10},  {mesh::Shape::hexahedron, 8},    {mesh::Shape::hexahedron, 20},
    {mesh::Shape::hexahedron, 27},   {mesh::Shape::prism, 6},         {mesh::Shape::prism, 15},
    {mesh::Shape::prism, 18},        {mesh::Shape::pyramid, 5},       {mesh::Shape::pyramid, 13},
    {mesh::Shape::pyramid, 14}};

/// Those of order 3 and 4, too.
inline const std::vector<mesh::ElementType> all_cell_types = []
{
  std::vector<mesh::ElementType> types = cell_types;
  for (const int n : {10, 15}) types.push_back({mesh::Shape::triangle, n});
  for (const int n : {20, 35}) types.push_back({mesh::Shape::tetrahedron, n});
  return types;
}();

/// The place of a node of a simplex between its corners.
inline Point<3> place_of(const mesh::NodeIndex& node, std::span<const Point<3>> corners)
{
  Point<3> sum = Point<3>::Zero();
  for (std::size_t v = 0; v < corners.size(); ++v) sum += node[v] * corners[v];
  return sum / static_cast<double>(std::accumulate(node.begin(), node.end(), 0));
}

/// The cells of one cube (corners as of a hexahedron, 8: its centre), or of one square.
inline std::vector<std::vector<int>> cells_of_cube(mesh::Shape shape)
{
  switch (shape)
  {
    case mesh::Shape::triangle:
      return {{0, 1, 2}, {0, 2, 3}};
    case mesh::Shape::quadrilateral:
      return {{0, 1, 2, 3}};
    case mesh::Shape::tetrahedron:
      return {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    case mesh::Shape::prism:
      return {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
    case mesh::Shape::pyramid:
      return {{0, 1, 2, 3, 8}, {4, 7, 6, 5, 8}, {0, 4, 5, 1, 8},
              {1, 5, 6, 2, 8}, {2, 6, 7, 3, 8}, {3, 7, 4, 0, 8}};
    default:
      return {{0, 1, 2, 3, 4, 5, 6, 7}};
  }
}

/// A box of n_x * n_y * n_z unit cubes, or of n_x * n_y squares: regions "left" and "right" of x = 1, facet
/// set "bottom" (z = 0; in 2D y = 0), node set "top". Nodes are numbered at random.
class ImportedBox
{
 public:
  ImportedBox(const mesh::ElementType& type, std::array<int, 3> n, std::mt19937& random) : type_(type), n_(n)
  {
    const bool is_plane = mesh::table_of(type.shape).dim == 2;
    if (is_plane) n_[2] = 1;
    mesh_.cells = {{.type = type}};
    mesh_.cell_sets = {{"left"}, {"right"}};
    for (int k = 0; k < n_[2]; ++k)
      for (int j = 0; j < n_[1]; ++j)
        for (int i = 0; i < n_[0]; ++i) add_cube({double(i), double(j), double(k)});
    add_sets(is_plane ? 1 : 2);
    renumber(random);
  }

  [[nodiscard]] mesh::ImportedMesh take() { return std::move(mesh_); }

 private:
  /// Coordinates times 12 are integers.
  Index node(const Point<3>& x)
  {
    std::array<int, 3> key{};
    for (int i = 0; i < 3; ++i) key[i] = static_cast<int>(std::lround(12 * x[i]));
    const auto [it, is_new] = nodes_.try_emplace(key, static_cast<Index>(mesh_.nodes.size()));
    if (is_new)
    {
      mesh_.nodes.push_back(x);
      mesh_.node_numbers.push_back(static_cast<std::int64_t>(mesh_.nodes.size()));
    }
    return it->second;
  }

  void add_cube(const Point<3>& lower)
  {
    const double h = mesh::table_of(type_.shape).dim == 2 ? 0 : 1;
    const std::array<Point<3>, 9> corners = {{{0, 0, 0},
                                              {1, 0, 0},
                                              {1, 1, 0},
                                              {0, 1, 0},
                                              {0, 0, h},
                                              {1, 0, h},
                                              {1, 1, h},
                                              {0, 1, h},
                                              {0.5, 0.5, 0.5}}};
    for (const std::vector<int>& cell : cells_of_cube(type_.shape))
    {
      std::vector<Point<3>> x;
      for (const int c : cell) x.push_back(lower + corners[c]);
      add_cell(x);
    }
  }

  void add_cell(std::vector<Point<3>> x)
  {
    const mesh::ShapeTable& table = mesh::table_of(type_.shape);
    const auto centre = [&](const auto& places)
    {
      Point<3> sum = Point<3>::Zero();
      for (const int p : places) sum += x[p];
      return Point<3>(sum / static_cast<double>(places.size()));
    };
    if (mesh::is_simplex(type_.shape))
    {
      const std::vector<Point<3>> ends = std::exchange(x, {});
      for (const mesh::NodeIndex& index : mesh::simplex_nodes(type_)) x.push_back(place_of(index, ends));
    }
    else if (mesh::has_middles(type_))
      for (int e = 0; e < table.n_edges; ++e) x.push_back(centre(table.edges[e]));
    for (int f = 0; f < table.n_faces && static_cast<int>(x.size()) < type_.n_nodes; ++f)
      if (table.faces[f].n == 4) x.push_back(centre(table.faces[f].span()));
    if (static_cast<int>(x.size()) < type_.n_nodes)
    {
      std::vector<int> all(table.n_corners);
      std::iota(all.begin(), all.end(), 0);
      x.push_back(centre(all));
    }
    mesh::ElementBlock& block = mesh_.cells.front();
    std::vector<int> corners(table.n_corners);
    std::iota(corners.begin(), corners.end(), 0);
    mesh_.cell_sets[centre(corners)[0] < 1 ? 0 : 1].cells.push_back(static_cast<Index>(block.size()));
    for (const Point<3>& position : x) block.nodes.push_back(node(position));
    block.numbers.push_back(static_cast<std::int64_t>(block.numbers.size()) + 1);
  }

  void add_sets(int axis)
  {
    const std::vector<char> all(mesh_.nodes.size(), 1);
    mesh_.facet_sets = {{"bottom"}};
    for (const mesh::CellFace& face : mesh::CellFaces(mesh_.cells, all).outer())
    {
      const mesh::FaceNodes facet = mesh::nodes_of(mesh_.cells, face);
      if (std::ranges::all_of(facet.span(), [&](Index v) { return mesh_.nodes[v][axis] == 0; }))
        mesh::append(mesh_.facet_sets[0].facets, facet, mesh_.cells[0].numbers[face.element]);
    }
    mesh_.node_sets = {{"top", {}, true}};
    for (std::size_t v = 0; v < mesh_.nodes.size(); ++v)
      if (mesh_.nodes[v][axis] == n_[axis]) mesh_.node_sets[0].nodes.push_back(static_cast<Index>(v));
  }

  void renumber(std::mt19937& random)
  {
    std::vector<Index> to(mesh_.nodes.size());
    std::iota(to.begin(), to.end(), 0);
    std::ranges::shuffle(to, random);
    std::vector<Point<3>> nodes(to.size());
    for (std::size_t v = 0; v < to.size(); ++v) nodes[to[v]] = mesh_.nodes[v];
    mesh_.nodes = std::move(nodes);
    const auto map = [&](std::vector<Index>& places)
    {
      for (Index& v : places) v = to[v];
    };
    map(mesh_.cells[0].nodes);
    for (mesh::ElementBlock& block : mesh_.facet_sets[0].facets) map(block.nodes);
    map(mesh_.node_sets[0].nodes);
  }

  mesh::ElementType type_;
  std::array<int, 3> n_;
  mesh::ImportedMesh mesh_{.source = {.file = "box.inp"}};
  std::map<std::array<int, 3>, Index> nodes_{};
};

/// Every node of a simplex is at its place, every middle of another cell in the middle of its edge, every
/// centre in that of its face.
inline std::string misplaced_nodes(const mesh::ImportedMesh& mesh)
{
  for (const mesh::ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e)
    {
      const mesh::ShapeTable& table = mesh::table_of(block.type.shape);
      const auto is_centre = [&](int place, std::span<const int> corners)
      {
        Point<3> sum = Point<3>::Zero();
        for (const int c : corners) sum += mesh.nodes[block.element(e)[c]];
        return (mesh.nodes[block.element(e)[place]] - sum / static_cast<double>(corners.size())).norm() <
               1e-6;
      };
      std::vector<Point<3>> corners;
      for (int i = 0; i < table.n_corners; ++i) corners.push_back(mesh.nodes[block.element(e)[i]]);
      for (int i = 0; mesh::is_simplex(block.type.shape) && i < block.type.n_nodes; ++i)
        if ((mesh.nodes[block.element(e)[i]] - place_of(mesh::simplex_nodes(block.type)[i], corners)).norm() >
            1e-6)
          return fmt::format("node {}", i);
      for (int i = 0; mesh::has_middles(block.type) && i < table.n_edges; ++i)
        if (!is_centre(table.n_corners + i, table.edges[i])) return fmt::format("edge {}", i);
      for (int f = 0; f < table.n_faces; ++f)
      {
        const mesh::FaceElement face = mesh::face_element(block.type, f);
        if (face.type.n_nodes == 9 && !is_centre(face.nodes[8], table.faces[f].span()))
          return fmt::format("face {}", f);
      }
    }
  return {};
}

}  // namespace tribound::testing_mesh
