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
  EXPECT_EQ(expected.notes.size(), 1U);
  const mesh::MeshFile file{directory / "again.msh", {}};
  std::visit(
      [&]<int dim>(mesh::MeshData<dim>& data)
      {
        const mesh::Mesh<dim> whole(std::move(data));
        const auto again = std::get<mesh::Mesh<dim>>(mesh::read_mesh(file, {}, nullptr, &notes));
        EXPECT_THAT(notes, testing::IsEmpty());
        EXPECT_EQ(cells_by_place(again), cells_by_place(whole));
        EXPECT_EQ(facets_by_place(again), facets_by_place(whole));
        EXPECT_EQ(again.labels().quadratic_facets != nullptr, whole.labels().quadratic_facets != nullptr);
      },
      expected.data);
  const mesh::ImportedMesh read = mesh::read_imported(file, nullptr, mesh::default_patience, notes);
  EXPECT_EQ(read.cells.at(0).type, GetParam()) << "the elements are kept";
  EXPECT_EQ(testing_mesh::misplaced_nodes(read), "");
}

INSTANTIATE_TEST_SUITE_P(All, ImportedMsh, testing::ValuesIn(testing_mesh::cell_types),
                         [](const auto& info) {
                           return std::string(mesh::table_of(info.param.shape).name) +
                                  std::to_string(info.param.n_nodes);
                         });

}  // namespace
}  // namespace tribound::test
