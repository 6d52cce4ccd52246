// A mesh written for Gmsh is read again as it was.

#include "tribound/mesh/gmsh_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "support/meshes.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/gmsh.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::test
{
namespace
{

/// A distorted box in which some cells are bisected, in two regions.
template <int dim>
mesh::Mesh<dim> bisected_box()
{
  mesh::MeshData<dim> data;
  if constexpr (dim == 2)
    data = box<2>({0, 0}, {2, 1}, {4, 2});
  else
    data = box<3>({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
  data = distorted<dim>(std::move(data), 3);
  data.region_names = {"soft ground", "wall"};
  for (std::size_t c = 0; c < data.regions.size(); ++c) data.regions[c] = c % 3 == 0;
  const mesh::Mesh<dim> mesh(std::move(data));
  const std::array<Index, 3> marked = {0, 2, 5};
  return mesh::bisect<dim>(mesh, marked).mesh;
}

template <int dim>
mesh::Mesh<dim> read_again(const std::string& text)
{
  const testing_mesh::Directory directory;
  return std::get<mesh::Mesh<dim>>(mesh::read_gmsh(directory.write("again.msh", text)));
}

/// Cells or boundary facets by the coordinates of their vertices, with the name of their group.
template <class Corners>
auto sorted_by_place(Corners corners)
{
  std::ranges::sort(corners);
  return corners;
}

template <int dim>
auto cells_by_place(const mesh::Mesh<dim>& mesh)
{
  std::vector<std::pair<std::string, std::vector<std::vector<double>>>> result;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    auto& cell = result.emplace_back(mesh.region_names()[mesh.region(c)], 0);
    for (const Index v : mesh.cell(c)) cell.second.emplace_back(mesh.vertex(v).begin(), mesh.vertex(v).end());
    std::ranges::sort(cell.second);
  }
  return sorted_by_place(result);
}

template <int dim>
auto facets_by_place(const mesh::Mesh<dim>& mesh)
{
  std::vector<std::pair<std::string, std::vector<std::vector<double>>>> result;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    auto& corners = result.emplace_back(facet.tag < 0 ? "" : mesh.boundary_names()[facet.tag], 0);
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      corners.second.emplace_back(mesh.vertex(v).begin(), mesh.vertex(v).end());
    std::ranges::sort(corners.second);
  }
  return sorted_by_place(result);
}

template <int dim>
void expect_round_trip()
{
  const mesh::Mesh<dim> mesh = bisected_box<dim>();
  const mesh::Mesh<dim> again = read_again<dim>(mesh::gmsh_text(mesh));
  EXPECT_EQ(again.n_vertices(), mesh.n_vertices());
  EXPECT_EQ(cells_by_place(again), cells_by_place(mesh)) << "coordinates must come back to the last digit";
  EXPECT_EQ(facets_by_place(again), facets_by_place(mesh));
}

TEST(GmshText, IsReadAgain)
{
  expect_round_trip<2>();
  expect_round_trip<3>();
}

TEST(GmshText, LeavesOutBoundaries)
{
  const mesh::Mesh<2> mesh = bisected_box<2>();
  const std::vector<std::string> left_out = {"top"};
  const mesh::Mesh<2> again = read_again<2>(mesh::gmsh_text<2>(mesh, left_out));
  const std::vector<std::string> names(again.boundary_names().begin(), again.boundary_names().end());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("left", "right", "bottom"));
  EXPECT_EQ(again.boundary().size(), mesh.boundary().size());
}

}  // namespace
}  // namespace tribound::test
