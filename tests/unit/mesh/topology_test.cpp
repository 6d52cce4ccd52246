#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "tribound/mesh/box.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

/// The topology by its definition, with std::map.
template <int dim>
mesh::Topology<dim> by_definition(Index n_vertices, std::span<const mesh::Cell<dim>> cells)
{
  using Facet = std::array<Index, dim>;
  using Edge = std::array<Index, 2>;
  std::map<Facet, std::vector<Index>> facets;
  std::map<Edge, Index> edges;
  std::vector<std::set<Index>> around(n_vertices);
  const auto facet_of = [](const mesh::Cell<dim>& cell, int i)
  {
    Facet facet = mesh::facet_vertices(cell, i);
    std::sort(facet.begin(), facet.end());
    return facet;
  };
  const auto edge_of = [](const mesh::Cell<dim>& cell, int e)
  {
    const auto [a, b] = mesh::local_edges<dim>[e];
    return Edge{std::min(cell[a], cell[b]), std::max(cell[a], cell[b])};
  };
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (int i = 0; i <= dim; ++i) facets[facet_of(cells[c], i)].push_back(static_cast<Index>(c));
    for (int e = 0; e < mesh::Topology<dim>::n_cell_edges; ++e) edges[edge_of(cells[c], e)] = 0;
    for (const Index v : cells[c]) around[v].insert(static_cast<Index>(c));
  }

  mesh::Topology<dim> topology;
  std::map<Facet, Index> number;
  for (const auto& [facet, its_cells] : facets)
  {
    number[facet] = static_cast<Index>(topology.facets.size());
    topology.facets.push_back(facet);
    topology.facet_cells.push_back({its_cells[0], its_cells.size() > 1 ? its_cells[1] : -1});
  }
  for (auto& [edge, n] : edges)
  {
    n = static_cast<Index>(topology.edges.size());
    topology.edges.push_back(edge);
  }
  for (const mesh::Cell<dim>& cell : cells)
  {
    auto& of_cell = topology.cell_facets.emplace_back();
    for (int i = 0; i <= dim; ++i) of_cell[i] = number[facet_of(cell, i)];
    auto& its_edges = topology.cell_edges.emplace_back();
    for (int e = 0; e < mesh::Topology<dim>::n_cell_edges; ++e) its_edges[e] = edges[edge_of(cell, e)];
  }
  topology.vertex_cells_begin = {0};
  for (const auto& its_cells : around)
  {
    topology.vertex_cells.insert(topology.vertex_cells.end(), its_cells.begin(), its_cells.end());
    topology.vertex_cells_begin.push_back(static_cast<Index>(topology.vertex_cells.size()));
  }
  return topology;
}

template <int dim>
void expect_same(const mesh::Topology<dim>& actual, const mesh::Topology<dim>& expected)
{
  EXPECT_EQ(actual.facets, expected.facets);
  EXPECT_EQ(actual.facet_cells, expected.facet_cells);
  EXPECT_EQ(actual.cell_facets, expected.cell_facets);
  EXPECT_EQ(actual.edges, expected.edges);
  EXPECT_EQ(actual.cell_edges, expected.cell_edges);
  EXPECT_EQ(actual.vertex_cells_begin, expected.vertex_cells_begin);
  EXPECT_EQ(actual.vertex_cells, expected.vertex_cells);
}

/// Cells with vertices renumbered and listed at random, so that no order of the box remains.
template <int dim>
std::vector<mesh::Cell<dim>> shuffled(const mesh::MeshData<dim>& data)
{
  std::mt19937 generator(3);
  std::vector<Index> number(data.vertices.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), generator);
  std::vector<mesh::Cell<dim>> cells = data.cells;
  for (mesh::Cell<dim>& cell : cells)
  {
    for (Index& v : cell) v = number[v];
    std::shuffle(cell.begin(), cell.end(), generator);
  }
  std::shuffle(cells.begin(), cells.end(), generator);
  return cells;
}

template <int dim>
void check_box(const mesh::BoxMesh& box)
{
  const mesh::MeshData<dim> data = mesh::box_mesh<dim>(box);
  const auto n = static_cast<Index>(data.vertices.size());
  expect_same(mesh::build_topology<dim>(n, data.cells), by_definition<dim>(n, data.cells));
  const std::vector<mesh::Cell<dim>> cells = shuffled(data);
  expect_same(mesh::build_topology<dim>(n, cells), by_definition<dim>(n, cells));
}

TEST(Topology, OfBoxesIsTheDefinition)
{
  check_box<2>({{0, 0}, {1, 1}, {1, 1}, {}});
  check_box<2>({{0, 0}, {1, 1}, {7, 5}, {}});
  check_box<3>({{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {}});
  check_box<3>({{0, 0, 0}, {1, 1, 1}, {4, 3, 5}, {}});
}

TEST(Topology, OfGmshMeshesIsTheDefinition)
{
  const testing_mesh::Directory directory;
  const auto plane = std::get<mesh::Mesh<2>>(
      mesh::read_mesh(directory.write("disk.geo",
                                      "SetFactory(\"OpenCASCADE\"); Disk(1) = {0, 0, 0, 1};"
                                      "Mesh.MeshSizeMax = 0.2;\n")));
  expect_same(plane.topology(), by_definition<2>(plane.n_vertices(), plane.cells()));
  const auto solid = std::get<mesh::Mesh<3>>(
      mesh::read_mesh(directory.write("ball.geo",
                                      "SetFactory(\"OpenCASCADE\"); Sphere(1) = {0, 0, 0, 1};"
                                      "Mesh.MeshSizeMax = 0.4;\n")));
  expect_same(solid.topology(), by_definition<3>(solid.n_vertices(), solid.cells()));
}

TEST(Topology, OfMoreCellsThanNumbersIsRefused)
{
  const mesh::Cell<3> cell{0, 1, 2, 3};
  const std::span<const mesh::Cell<3>> many(&cell, 357'913'942);  // only counted
  EXPECT_THROW((void)mesh::build_topology<3>(4, many), SolveError);
}

TEST(Topology, OfAVertexWithManyCellsStaysExact)
{
  const Index n = 5000;  // a fan around vertex 0
  std::vector<mesh::Cell<2>> cells;
  for (Index i = 1; i < n; ++i) cells.push_back({0, i, i + 1});
  expect_same(mesh::build_topology<2>(n + 1, cells), by_definition<2>(n + 1, cells));
}

}  // namespace

}  // namespace tribound
