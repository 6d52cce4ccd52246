// A mesh written for Gmsh is read back unchanged.

#include "tribound/io/fields/gmsh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "support/meshes.h"
#include "support/meshes_by_place.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/import/read.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::test
{
namespace
{

/// A distorted box with two regions and some bisected cells.
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
mesh::Mesh<dim> written_and_read(const mesh::Mesh<dim>& mesh, std::span<const std::string> left_out = {})
{
  const testing_mesh::Directory directory;
  io::write_gmsh<dim>(directory / "again.msh", mesh, left_out);
  return std::get<mesh::Mesh<dim>>(mesh::read_mesh(mesh::MeshFile{directory / "again.msh", {}}));
}

template <int dim>
void expect_round_trip()
{
  const mesh::Mesh<dim> mesh = bisected_box<dim>();
  const mesh::Mesh<dim> again = written_and_read<dim>(mesh);
  EXPECT_EQ(again.n_vertices(), mesh.n_vertices());
  EXPECT_EQ(cells_by_place(again), cells_by_place(mesh)) << "coordinates must come back to the last digit";
  EXPECT_EQ(facets_by_place(again), facets_by_place(mesh));
}

TEST(GmshFile, IsReadAgain)
{
  expect_round_trip<2>();
  expect_round_trip<3>();
}

TEST(GmshFile, LeavesOutBoundaries)
{
  const mesh::Mesh<2> mesh = bisected_box<2>();
  const std::vector<std::string> left_out = {"top"};
  const mesh::Mesh<2> again = written_and_read<2>(mesh, left_out);
  const std::vector<std::string> names(again.boundary_names().begin(), again.boundary_names().end());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("left", "right", "bottom"));
  EXPECT_EQ(again.boundary().size(), mesh.boundary().size());
}

}  // namespace
}  // namespace tribound::test
