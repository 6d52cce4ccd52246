#include "tribound/mesh/box.h"

#include <cmath>
#include <cstdint>

#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::boundary_measure;
using testing_mesh::expect_input_error;
using testing_mesh::volume;

const mesh::BoxMesh rectangle{{-1, 0}, {1, 3}, {4, 3}, {}};
const mesh::BoxMesh cuboid{{0, -1, 2}, {2, 0, 5}, {3, 2, 4}, {}};

TEST(Box, NumbersVerticesAndCellsAsTheReferenceData)
{
  const int nx = 4;
  const mesh::MeshData<2> data = mesh::box_mesh<2>(rectangle);
  ASSERT_EQ(data.vertices.size(), 20U);
  ASSERT_EQ(data.cells.size(), 24U);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < nx; ++i)
    {
      const Index v00 = j * (nx + 1) + i;
      const Index v01 = v00 + nx + 1;
      EXPECT_EQ(data.cells[2 * (j * nx + i)], (mesh::Cell<2>{v00, v00 + 1, v01 + 1}));
      EXPECT_EQ(data.cells[2 * (j * nx + i) + 1], (mesh::Cell<2>{v00, v01 + 1, v01}));
      EXPECT_NEAR((data.vertices[v00] - Point<2>(-1 + 0.5 * i, j)).norm(), 0, 1e-15);
    }
}

TEST(Box, NumbersVerticesOfACuboidAlongXThenYThenZ)
{
  const mesh::MeshData<3> data = mesh::box_mesh<3>(cuboid);
  ASSERT_EQ(data.vertices.size(), 60U);
  ASSERT_EQ(data.cells.size(), 6U * 24);
  EXPECT_NEAR((data.vertices[(2 * 3 + 1) * 4 + 3] - Point<3>(2, -0.5, 3.5)).norm(), 0, 1e-15);
}

TEST(Box, RegionAndSidesHaveTheirMeasures)
{
  const mesh::Mesh<2> plane(mesh::box_mesh<2>(rectangle));
  EXPECT_THAT(plane.region_names(), testing::ElementsAre("box"));
  EXPECT_THAT(plane.boundary_names(), testing::ElementsAre("left", "right", "bottom", "top"));
  EXPECT_NEAR(volume(plane), 6, 1e-13);
  EXPECT_EQ(plane.boundary().size(), 14U);
  for (const int tag : {0, 1}) EXPECT_NEAR(boundary_measure(plane, tag), 3, 1e-13);
  for (const int tag : {2, 3}) EXPECT_NEAR(boundary_measure(plane, tag), 2, 1e-13);

  const mesh::Mesh<3> solid(mesh::box_mesh<3>(cuboid));
  EXPECT_THAT(solid.boundary_names(),
              testing::ElementsAre("left", "right", "bottom", "top", "back", "front"));
  EXPECT_NEAR(volume(solid), 6, 1e-13);
  EXPECT_EQ(solid.boundary().size(), 2U * (2 * 8 + 2 * 12 + 2 * 6));
  const std::array<double, 6> areas = {3, 3, 6, 6, 2, 2};
  for (int tag = 0; tag < 6; ++tag) EXPECT_NEAR(boundary_measure(solid, tag), areas[tag], 1e-13);
}

TEST(Box, SidesLieWhereTheirNamesSay)
{
  const mesh::Mesh<3> mesh(mesh::box_mesh<3>(cuboid));
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    ASSERT_GE(facet.tag, 0);
    Point<3> outward = Point<3>::Zero();
    outward[facet.tag / 2] = facet.tag % 2 == 0 ? -1 : 1;
    EXPECT_NEAR((mesh::facet_geometry(mesh, facet.cell, facet.local).normal - outward).norm(), 0, 1e-14);
  }
}

TEST(Box, EveryCubeIsCutIntoTetrahedraOfEqualVolume)
{
  const mesh::Mesh<3> mesh(mesh::box_mesh<3>({{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {}}));
  ASSERT_EQ(mesh.n_cells(), 6);
  for (Index c = 0; c < 6; ++c)
  {
    EXPECT_NEAR(mesh::cell_map(mesh, c).det, 1, 1e-15);
    EXPECT_EQ(mesh.cell(c)[0], 0);
    EXPECT_EQ(mesh.cell(c)[3], 7);
  }
}

TEST(Box, RejectsNonsenseNamingTheKey)
{
  const Where where{.file = "case.toml", .key = "mesh.box", .line = 4};
  const auto build = [&](std::vector<double> lower, std::vector<double> upper, std::vector<int> cells) {
    return [=] { (void)mesh::box_mesh<2>({lower, upper, cells, where}); };
  };
  expect_input_error(build({0, 0}, {1}, {1, 1}),
                     {"case.toml:4: mesh.box: ", "2, 1 and 2 numbers", "hint: each has 2"});
  expect_input_error(build({0, 0}, {1, 0}, {1, 1}),
                     {"case.toml:4: mesh.box.upper: ", "upper[1] = 0 is not above lower[1] = 0"});
  expect_input_error(build({0, 0}, {INFINITY, 1}, {1, 1}), {"mesh.box: ", "reaches from 0 to inf along x"});
  expect_input_error(build({0, 0}, {1, 1}, {1, 0}), {"mesh.box.cells: ", "cells[1] = 0", "at least one"});
  expect_input_error(build({0, 0}, {1, 1}, {100'000, 100'000}),
                     {"mesh.box.cells: ", "makes 2e+10 simplices", "at most 357913941"});
  expect_input_error(
      [&] {
        (void)mesh::read_mesh(mesh::BoxMesh{{0}, {1}, {2}, where});
      },
      {"1, 1 and 1 numbers"});
}

TEST(Box, RecordsOfManyRanksHaveNumbersBeyond32Bits)
{
  const mesh::BoxMesh large{{0, 0, 0}, {4000, 3000, 2000}, {4000, 3000, 2000}, {}};
  const std::int64_t n = mesh::n_box_cells(large);
  EXPECT_EQ(n, 144'000'000'000);
  const mesh::CellRecord<3> last = mesh::box_records<3>(large, n - 1, n).front();
  EXPECT_EQ(last.name.root, n - 1);
  for (const mesh::VertexName<3>& vertex : last.vertices)
  {
    const auto at = [&](int axis) { return static_cast<std::uint64_t>(std::llround(vertex.position[axis])); };
    EXPECT_EQ(vertex.origin, at(0) + 4001 * (at(1) + 3001 * at(2)));
    EXPECT_GT(vertex.origin, 24'000'000'000U);
  }
}

TEST(Box, ReadMeshTakesTheDimensionFromTheNumberOfEntries)
{
  EXPECT_EQ(std::get<mesh::Mesh<2>>(mesh::read_mesh(rectangle)).n_cells(), 24);
  EXPECT_EQ(std::get<mesh::Mesh<3>>(mesh::read_mesh(cuboid)).n_cells(), 144);
}

}  // namespace

}  // namespace tribound
