#include "tribound/mesh/gmsh_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/gmsh_elements.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_session.h"

namespace tribound::mesh
{

namespace
{

/// Gmsh's entities of one dimension, in words.
std::string_view entity_word(int dim)
{
  constexpr std::array<std::string_view, 4> words = {"point", "curve", "surface", "volume"};
  return words[dim];
}

/// The physical groups of one dimension: their names, and the group of every entity that is in one.
struct Groups
{
  std::vector<std::string> names;
  std::map<int, int> of_entity;  ///< entity tag -> position in names
};

Groups read_groups(const Where& where, int dim)
{
  Groups groups;
  for (const gmsh::Entity& physical : gmsh::physical_groups(dim))
  {
    std::string name = gmsh::physical_name(physical);
    if (name.empty()) name = std::to_string(physical.second);
    const auto known = std::find(groups.names.begin(), groups.names.end(), name);
    const int group = static_cast<int>(known - groups.names.begin());
    if (known == groups.names.end()) groups.names.push_back(name);

    for (const int entity : gmsh::entities_of(physical))
    {
      const auto [entry, is_new] = groups.of_entity.try_emplace(std::abs(entity), group);
      if (is_new || entry->second == group) continue;
      throw InputError(
          where,
          fmt::format("{} {} is in two physical groups, \"{}\" and \"{}\"", entity_word(dim),
                      std::abs(entity), groups.names[entry->second], name),
          "every region and every part of the boundary has one name; in .msh files of version 1 and 2, "
          "elements of different groups also need different elementary tags");
    }
  }
  return groups;
}

/// Simplices of one order, named by node tags, and the group of each.
template <int n_corners>
struct Simplices
{
  static constexpr int n_edges = n_corners * (n_corners - 1) / 2;

  int order = 1;
  std::vector<std::array<std::size_t, n_corners>> nodes{};
  std::vector<std::array<std::size_t, n_edges>> edge_nodes{};  ///< of order 2, in Gmsh's order
  std::vector<int> groups{};

  /// Appends the simplices of one entity; returns how many there are.
  std::size_t append(int entity, int group)
  {
    const std::vector<std::size_t> flat = gmsh::element_nodes(simplex_type[order - 1][n_corners - 1], entity);
    const std::size_t stride = order == 1 ? n_corners : n_corners + n_edges;
    const std::size_t n_before = nodes.size();
    const std::size_t n_new = flat.size() / stride;
    nodes.resize(n_before + n_new);
    if (order > 1) edge_nodes.resize(nodes.size());
    for (std::size_t i = 0; i < n_new; ++i)
    {
      const std::size_t* of_simplex = &flat[i * stride];
      std::copy_n(of_simplex, n_corners, nodes[n_before + i].begin());
      if (order > 1) std::copy_n(of_simplex + n_corners, n_edges, edge_nodes[n_before + i].begin());
    }
    groups.resize(nodes.size(), group);
    return n_new;
  }
};

/// Positions and new numbers of the nodes; both indexed by Gmsh's node tags.
struct Nodes
{
  static constexpr Index edge = -4;    ///< on an edge of a cell or facet of order 2
  static constexpr Index absent = -3;  ///< no node has this tag
  static constexpr Index unused = -2;  ///< in no cell and no boundary facet
  static constexpr Index point = -1;   ///< unused as well, but the node of a point of the geometry

  std::vector<Point<3>> positions;
  std::vector<Index> numbers;
};

Nodes read_nodes()
{
  const auto [tags, x] = gmsh::nodes();
  const std::size_t largest = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
  if (largest > 16 * tags.size() + 1024)  // too sparse for tables indexed by tag
  {
    gmsh::renumber_nodes();
    return read_nodes();
  }
  Nodes nodes{std::vector<Point<3>>(largest + 1), std::vector<Index>(largest + 1, Nodes::absent)};
  for (std::size_t i = 0; i < tags.size(); ++i)
  {
    nodes.positions[tags[i]] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
    nodes.numbers[tags[i]] = Nodes::unused;
  }
  for (const std::size_t tag : gmsh::nodes(0).tags) nodes.numbers[tag] = Nodes::point;
  return nodes;
}

template <std::size_t n>
std::string describe_nodes(const Nodes& nodes, const std::array<std::size_t, n>& simplex)
{
  std::string text;
  for (const std::size_t tag : simplex) text += (text.empty() ? "" : ", ") + describe(nodes.positions[tag]);
  return text;
}

/// Gmsh orients the surfaces of a plane geometry up or down: an entity whose cells are all negative is
/// reversed. Cells of both signs in one entity are left to the verification of the mesh.
template <int dim>
void orient(const Nodes& nodes, std::span<std::array<std::size_t, dim + 1>> cells)
{
  const auto is_negative = [&](const auto& cell)
  {
    std::array<Point<dim>, dim + 1> points;
    for (int i = 0; i <= dim; ++i) points[i] = nodes.positions[cell[i]].template head<dim>();
    return determinant(points) < 0.0;
  };
  if (std::all_of(cells.begin(), cells.end(), is_negative))
    for (auto& cell : cells) std::swap(cell[dim - 1], cell[dim]);
}

void check_groups_filled(const Where& where, int dim, const Groups& groups, std::span<const int> in_use)
{
  for (std::size_t g = 0; g < groups.names.size(); ++g)
    if (std::find(in_use.begin(), in_use.end(), static_cast<int>(g)) == in_use.end())
      throw InputError(where,
                       fmt::format("physical group \"{}\" has no {}", groups.names[g],
                                   dim == 1   ? "edges"
                                   : dim == 2 ? "triangles"
                                              : "tetrahedra"),
                       fmt::format("mesh the {}s of the group, or remove it", entity_word(dim)));
}

/// All cells, with the position of their region in groups.names.
template <int dim>
Simplices<dim + 1> read_cells(const Where& where, const Nodes& nodes, const Groups& groups, int order)
{
  Simplices<dim + 1> cells{.order = order};
  std::size_t n_homeless = 0;
  std::string example;
  for (const auto& [_, entity] : gmsh::entities(dim))
  {
    const auto group = groups.of_entity.find(entity);
    const bool homeless = !groups.names.empty() && group == groups.of_entity.end();
    const std::size_t n = cells.append(entity, group == groups.of_entity.end() ? 0 : group->second);
    const auto added = std::span(cells.nodes).last(n);
    orient<dim>(nodes, added);
    if (homeless && n > 0 && n_homeless == 0)
      example = fmt::format("{} {}, for example the one with corners {}", entity_word(dim), entity,
                            describe_nodes(nodes, added[0]));
    if (homeless) n_homeless += n;
  }
  if (n_homeless > 0)
    throw InputError(where,
                     fmt::format("{} of {} {} are in no physical group; first in {}", n_homeless,
                                 cells.nodes.size(), dim == 2 ? "triangles" : "tetrahedra", example),
                     fmt::format("put every {} into a physical group, or use no groups of {}s at all",
                                 entity_word(dim), entity_word(dim)));
  if (!groups.names.empty()) check_groups_filled(where, dim, groups, cells.groups);
  return cells;
}

/// The facets of the boundary groups.
template <int dim>
Simplices<dim> read_facets(const Where& where, const Groups& groups, int order)
{
  Simplices<dim> facets{.order = order};
  for (const auto& [entity, group] : groups.of_entity) facets.append(entity, group);
  check_groups_filled(where, dim - 1, groups, facets.groups);
  return facets;
}

/// Numbers the corners of cells and facets in ascending order of their tags and returns their positions.
/// Nodes on edges are dropped; others, too, if they stem from points of the geometry, else they are an error.
template <int dim>
std::vector<Point<dim>> number_vertices(const Where& where, Nodes& nodes, const Simplices<dim + 1>& cells,
                                        const Simplices<dim>& facets, bool is_geo)
{
  const auto mark = [&](const auto& simplices, Index as)
  {
    for (const auto& simplex : simplices)
      for (const std::size_t tag : simplex) nodes.numbers[tag] = as;
  };
  mark(cells.edge_nodes, Nodes::edge);
  mark(facets.edge_nodes, Nodes::edge);
  mark(cells.nodes, 0);
  mark(facets.nodes, 0);

  std::vector<Point<dim>> vertices;
  for (std::size_t tag = 0; tag < nodes.numbers.size(); ++tag)
  {
    Index& number = nodes.numbers[tag];
    if (number == Nodes::unused && !is_geo)
      throw InputError(
          where, fmt::format("node {} at {} belongs to no cell", tag, describe(nodes.positions[tag])),
          "remove it, or save the mesh by physical groups (Mesh.SaveAll=0), which leaves such nodes out");
    if (number < 0) continue;
    number = static_cast<Index>(vertices.size());
    vertices.push_back(nodes.positions[tag].template head<dim>());
  }
  return vertices;
}

/// A plane mesh lies in z = 0, to 1e-12 of its size.
void check_plane(const Where& where, const Nodes& nodes, const Simplices<3>& cells)
{
  double size = 0.0;
  for (const auto& cell : cells.nodes)
    for (const std::size_t tag : cell) size = std::max(size, nodes.positions[tag].lpNorm<Eigen::Infinity>());
  const auto check = [&](const std::array<std::size_t, 3>& tags)
  {
    for (const std::size_t tag : tags)
      if (!(std::abs(nodes.positions[tag][2]) <= 1e-12 * size))
        throw InputError(
            where,
            fmt::format("the mesh has triangles only, and node {} at {} is not in the plane z = 0", tag,
                        describe(nodes.positions[tag])),
            "2D meshes lie in z = 0; a 3D problem needs the tetrahedra of its volume");
  };
  std::ranges::for_each(cells.nodes, check);
  std::ranges::for_each(cells.edge_nodes, check);
}

/// The nodes on the edges of the facets.
template <int dim>
std::vector<EdgeNode<dim>> edge_nodes_of(const Nodes& nodes, const Simplices<dim>& facets)
{
  std::vector<EdgeNode<dim>> result;
  for (std::size_t f = 0; f < facets.edge_nodes.size(); ++f)
    for (int e = 0; e < facets.n_edges; ++e)  // Gmsh has the edges (0, 1), (1, 2), (2, 0)
      result.push_back({{nodes.numbers[facets.nodes[f][e]], nodes.numbers[facets.nodes[f][(e + 1) % dim]]},
                        nodes.positions[facets.edge_nodes[f][e]].template head<dim>()});
  return result;
}

template <std::size_t n>
std::array<Index, n> numbered(const Nodes& nodes, const std::array<std::size_t, n>& simplex)
{
  std::array<Index, n> numbers;
  for (std::size_t i = 0; i < n; ++i) numbers[i] = nodes.numbers[simplex[i]];
  return numbers;
}

/// The loaded model, group by group. Cells of order 2 get straight sides.
template <int dim>
MeshData<dim> mesh_data(const std::filesystem::path& file, int order)
{
  MeshData<dim> data;
  data.source = {.file = file.string()};
  Groups regions = read_groups(data.source, dim);
  Groups boundaries = read_groups(data.source, dim - 1);
  Nodes nodes = read_nodes();
  Simplices<dim + 1> cells = read_cells<dim>(data.source, nodes, regions, order);
  const Simplices<dim> facets = read_facets<dim>(data.source, boundaries, order);
  if constexpr (dim == 2) check_plane(data.source, nodes, cells);

  data.vertices = number_vertices<dim>(data.source, nodes, cells, facets, file.extension() == ".geo");
  data.cells.reserve(cells.nodes.size());
  for (const auto& cell : cells.nodes) data.cells.push_back(numbered(nodes, cell));
  data.facets.reserve(facets.nodes.size());
  for (std::size_t f = 0; f < facets.nodes.size(); ++f)
    data.facets.push_back({numbered(nodes, facets.nodes[f]), facets.groups[f]});
  data.edge_nodes = edge_nodes_of<dim>(nodes, facets);
  data.regions = std::move(cells.groups);
  data.region_names = regions.names.empty() ? std::vector<std::string>{"domain"} : std::move(regions.names);
  data.boundary_names = std::move(boundaries.names);
  return data;
}

}  // namespace

std::variant<MeshData<2>, MeshData<3>> load_gmsh(const std::filesystem::path& file)
{
  const GmshSession session(file);
  const Where where{.file = file.string()};
  const int dim = mesh_dimension(where);
  const int order = mesh_order(where, dim);
  if (dim == 2) return mesh_data<2>(file, order);
  return mesh_data<3>(file, order);
}

}  // namespace tribound::mesh
