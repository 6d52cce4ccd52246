/// Groups by formulas: facets, cells, normals, what is taken from where, what is refused.

#include "tribound/mesh/formula_groups.h"

#include <algorithm>
#include <random>

#include "tribound/mesh/import/read.h"
#include "tribound/mesh/quadratic_facets.h"
#include "unit/mesh/imported_testing.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::boundary_measure;
using testing_mesh::expect_input_error;

const mesh::BoxMesh cuboid{{0, 0, 0}, {2, 1, 1}, {4, 2, 2}};

mesh::FormulaGroup boundary(const std::string& name, const std::string& condition,
                            std::vector<std::string> of = {})
{
  return {name, condition, {.file = "case.toml", .key = "boundary.x.where", .line = 5}, std::move(of)};
}

mesh::FormulaGroup region(const std::string& name, const std::string& condition,
                          std::vector<std::string> of = {})
{
  mesh::FormulaGroup group = boundary(name, condition, std::move(of));
  group.is_region = true;
  return group;
}

mesh::Mesh<3> with_groups(const std::vector<mesh::FormulaGroup>& groups)
{
  return std::get<mesh::Mesh<3>>(mesh::read_mesh(cuboid, {}, nullptr, nullptr, groups));
}

double area_of(const mesh::Mesh<3>& mesh, const std::string& name)
{
  const auto found = std::ranges::find(mesh.boundary_names(), name);
  return boundary_measure(mesh, static_cast<int>(found - mesh.boundary_names().begin()));
}

void expect_refusal(const std::vector<mesh::FormulaGroup>& groups, std::initializer_list<std::string> words)
{
  expect_input_error([&] { (void)with_groups(groups); }, words);
}

TEST(FormulaGroups, SplitTheSidesOfABox)
{
  const mesh::Mesh<3> mesh =
      with_groups({boundary("load", "x < 1 + 1e-9", {"front"}),
                   boundary("low", "z < 0.5 + 1e-9", {"left", "right"}), boundary("rest", "1", {"top"})});
  EXPECT_NEAR(area_of(mesh, "load"), 1, 1e-14);
  EXPECT_NEAR(area_of(mesh, "front"), 1, 1e-14);
  EXPECT_NEAR(area_of(mesh, "low"), 1, 1e-14);
  EXPECT_NEAR(area_of(mesh, "left"), 0.5, 1e-14);
  EXPECT_NEAR(area_of(mesh, "rest"), 2, 1e-14);
  EXPECT_THAT(mesh.boundary_names(), testing::Not(testing::Contains("top"))) << "nothing is left of it";
}

TEST(FormulaGroups, AreTakenByTheOutwardNormal)
{
  const std::vector<std::string> all = {"left", "right", "bottom", "top", "back", "front"};
  const mesh::Mesh<3> mesh =
      with_groups({boundary("up", "nz > 0.5 && x > 1 - 1e-9", all), boundary("side", "abs(nx) > 0.9", all)});
  EXPECT_NEAR(area_of(mesh, "up"), 1, 1e-14);
  EXPECT_NEAR(area_of(mesh, "front"), 1, 1e-14);
  EXPECT_NEAR(area_of(mesh, "side"), 2, 1e-14);
  EXPECT_NEAR(area_of(mesh, "back"), 2, 1e-14);
  const mesh::BoxMesh rectangle{{0, 0}, {2, 1}, {4, 2}};
  const std::vector<mesh::FormulaGroup> groups = {
      boundary("down", "ny < -0.5 && x < 1.2", {"bottom", "top"})};
  const auto plane = std::get<mesh::Mesh<2>>(mesh::read_mesh(rectangle, {}, nullptr, nullptr, groups));
  EXPECT_NEAR(boundary_measure(plane, static_cast<int>(plane.boundary_names().size()) - 1), 1, 1e-14);
}

TEST(FormulaGroups, RegionsGoByTheCentresOfCells)
{
  const mesh::Mesh<3> mesh = with_groups({region("right", "x > 1"), region("far", "x < 0.5")});
  std::vector<double> volumes(3, 0);
  for (Index c = 0; c < mesh.n_cells(); ++c) volumes[mesh.region(c)] += mesh::cell_map(mesh, c).det / 6;
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("box", "right", "far"));
  EXPECT_NEAR(volumes[0], 0.5, 1e-14);
  EXPECT_NEAR(volumes[1], 1, 1e-14);
  EXPECT_NEAR(volumes[2], 0.5, 1e-14);
  EXPECT_THAT(with_groups({region("all", "1")}).region_names(), testing::ElementsAre("all"));
}

TEST(FormulaGroups, AreRefusedWithThePlace)
{
  expect_refusal({boundary("g", "x < -1", {"left"})},
                 {"case.toml:5: boundary.x.where: none of 8 facets satisfies the condition of \"g\"",
                  "such as not the face (0, "});
  expect_refusal({boundary("g", "x < 1e-6")}, {"there are no facets for \"g\"", "of = \"left\""});
  expect_refusal({boundary("g", "y < 1", {"lft"})},
                 {"there is no boundary \"lft\" to take it from", "of = one or several of left, right"});
  expect_refusal({boundary("top", "y < 1", {"left"})}, {"the mesh has a boundary \"top\" already"});
  expect_refusal({boundary("g", "z > 0.4", {"left"}), boundary("h", "1", {"left"})},
                 {"face (0, ", "is in boundary \"g\", too"});
  expect_refusal({boundary("g", "y <", {"left"})}, {"boundary.x.where"});
  expect_refusal({boundary("g", "y < t", {"left"})}, {"uses t"});
  expect_refusal({boundary("g", "sqrt(-1 - x)", {"left"})}, {"has no value at (0, "});
  expect_refusal({region("g", "nx > 0")}, {"unknown name \"nx\""});
  expect_refusal({region("g", "x > 5")}, {"none of 96 cells satisfies"});
  expect_refusal({region("g", "x > 1"), region("h", "x > 1.5")}, {"would be in region \"h\", too"});
}

/// Facets of second order that the file has in no set.
TEST(FormulaGroups, OfSecondOrderHaveTheirMiddles)
{
  const testing_mesh::Directory directory;
  std::string text =
      "*NODE\n1,0,0\n2,1,0\n3,0,1\n4,0.5,-0.1\n5,0.5,0.5\n6,0,0.5\n*ELEMENT,TYPE=CPE6\n1, 1,2,3,4,5,6\n";
  const mesh::MeshFile file = directory.write("deck.inp", text);
  const std::vector<mesh::FormulaGroup> groups = {boundary("arc", "y < 1e-6"), boundary("rest", "ny > -0.1")};
  const auto mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(file, {}, nullptr, nullptr, groups));
  EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("arc", "rest"));
  EXPECT_NEAR(mesh::sagitta<2>(*mesh.labels().quadratic_facets, 0), 0.1, 1e-14);
  EXPECT_EQ(mesh::sagitta<2>(*mesh.labels().quadratic_facets, 1), 0);
}

}  // namespace

}  // namespace tribound
