// Imported meshes of all element types written for Gmsh give the same simplicial mesh.

#include "tribound/io/fields/imported_msh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <variant>
#include <vector>

#include "support/meshes_by_place.h"
#include "tribound/mesh/import/node_sets.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/quadratic_facets.h"
#include "unit/mesh/imported_testing.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::test
{
namespace
{

class ImportedMsh : public testing::TestWithParam<mesh::ElementType>
{
};

TEST_P(ImportedMsh, IsReadAsTheMeshThatWasWritten)
{
  std::mt19937 random(7);
  mesh::ImportedMesh imported = testing_mesh::ImportedBox(GetParam(), {3, 2, 2}, random).take();
  imported.nodes.insert(imported.nodes.begin() + 1, {9, 9, 0});  // belongs to no element
  imported.node_numbers.push_back(-5);
  const auto shift = [](mesh::ElementBlock& block)
  {
    for (Index& node : block.nodes) node += node > 0 ? 1 : 0;
  };
  for (mesh::ElementBlock& block : imported.cells) shift(block);
  for (mesh::FacetSet& set : imported.facet_sets)
    for (mesh::ElementBlock& block : set.facets) shift(block);
  for (mesh::NodeSet& set : imported.node_sets)
    for (Index& node : set.nodes) node += node > 0 ? 1 : 0;
  std::vector<std::string> notes;
  add_node_sets(imported, notes);

  const testing_mesh::Directory directory;
  io::write_msh(directory / "again.msh", imported);
  mesh::SimplicialMesh expected = mesh::make_simplicial(imported);
  const std::size_t of_order = mesh::order_of(GetParam()) > 2 ? 1 : 0;
  EXPECT_EQ(expected.notes.size(), 1U + of_order);
  const mesh::MeshFile file{directory / "again.msh", {}};
  std::visit(
      [&]<int dim>(mesh::MeshData<dim>& data)
      {
        const mesh::Mesh<dim> whole(std::move(data));
        const auto again = std::get<mesh::Mesh<dim>>(mesh::read_mesh(file, {}, nullptr, &notes));
        EXPECT_EQ(notes.size(), of_order);
        EXPECT_EQ(cells_by_place(again), cells_by_place(whole));
        EXPECT_EQ(facets_by_place(again), facets_by_place(whole));
        EXPECT_EQ(again.labels().quadratic_facets != nullptr, whole.labels().quadratic_facets != nullptr);
      },
      expected.data);
  const mesh::ImportedMesh read = mesh::read_imported(file, nullptr, mesh::default_patience, notes);
  EXPECT_EQ(read.cells.at(0).type, GetParam()) << "the elements are kept";
  EXPECT_EQ(testing_mesh::misplaced_nodes(read), "");
}

/// A tetrahedron of each order, apart.
mesh::ImportedMesh two_orders()
{
  mesh::ImportedMesh mesh;
  const std::vector<Point<3>> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const double shift : {0., 5.})
    for (const Point<3>& x : corners) mesh.nodes.emplace_back(x + shift * Point<3>::UnitX());
  const mesh::ShapeTable& table = mesh::table_of(mesh::Shape::tetrahedron);
  std::vector<Index> second = {4, 5, 6, 7};
  for (int e = 0; e < table.n_edges; ++e)
  {
    second.push_back(static_cast<Index>(mesh.nodes.size()));
    mesh.nodes.emplace_back((mesh.nodes[4 + table.edges[e][0]] + mesh.nodes[4 + table.edges[e][1]]) / 2);
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    mesh.node_numbers.push_back(static_cast<std::int64_t>(i) + 1);
  mesh.cells = {{{mesh::Shape::tetrahedron, 4}, {0, 1, 2, 3}, {1}},
                {{mesh::Shape::tetrahedron, 10}, second, {2}}};
  return mesh;
}

TEST(ImportedMshOf, BothOrdersHasCornersAlone)
{
  const testing_mesh::Directory directory;
  io::write_msh(directory / "both.msh", two_orders());
  std::vector<std::string> notes;
  const mesh::ImportedMesh read =
      mesh::read_imported({directory / "both.msh", {}}, nullptr, mesh::default_patience, notes);
  ASSERT_EQ(read.cells.size(), 1U);
  EXPECT_EQ(read.cells[0].type, (mesh::ElementType{mesh::Shape::tetrahedron, 4}));
  EXPECT_EQ(read.nodes.size(), 8U);
}

TEST(ImportedMshOf, NamesThatTheFormatCannotHoldIsRefused)
{
  const testing_mesh::Directory directory;
  for (const std::string& name : {std::string("a\"b"), std::string(300, 'a')})
  {
    mesh::ImportedMesh mesh = two_orders();
    mesh.cell_sets = {{name, {0, 1}}};
    EXPECT_THROW(io::write_msh(directory / "no.msh", mesh), InputError);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ImportedMsh, testing::ValuesIn(testing_mesh::all_cell_types),
                         [](const auto& info) {
                           return std::string(mesh::table_of(info.param.shape).name) +
                                  std::to_string(info.param.n_nodes);
                         });

}  // namespace
}  // namespace tribound::test
