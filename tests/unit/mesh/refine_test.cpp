/// Uniform refinement: conforming, tags and measures inherited, children inside their parents, shapes
/// bounded.

#include "tribound/mesh/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "support/dimensions.h"
#include "tribound/mesh/geometry.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::test
{

namespace
{

using testing_mesh::boundary_measure;
using testing_mesh::irregular_mesh;
using testing_mesh::smallest_angle;
using testing_mesh::volume;

template <class T>
class Refine : public ::testing::Test
{
};
TYPED_TEST_SUITE(Refine, Dimensions);

/// Coordinates as a key, equal for points that differ by round-off.
template <int dim>
std::array<long, dim> key(const Point<dim>& x)
{
  std::array<long, dim> rounded;
  for (int i = 0; i < dim; ++i) rounded[i] = std::lround(x[i] * 1e9);
  return rounded;
}

/// Facets identified only by the coordinates of their centres.
template <int dim>
std::map<std::array<long, dim>, int> cells_per_facet_centre(const mesh::Mesh<dim>& mesh)
{
  std::map<std::array<long, dim>, int> count;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int i = 0; i <= dim; ++i)
    {
      Point<dim> centre = Point<dim>::Zero();
      for (const Index v : mesh::facet_vertices(mesh.cell(c), i)) centre += mesh.vertex(v) / dim;
      ++count[key<dim>(centre)];
    }
  return count;
}

TYPED_TEST(Refine, IsConformingByCoordinates)
{
  constexpr int dim = TypeParam::value;
  const mesh::Refined<dim> refined = mesh::refine_uniformly(irregular_mesh<dim>(), 2);  // verifies itself
  std::set<std::array<long, dim>> places;
  for (const Point<dim>& x : refined.mesh.vertices()) places.insert(key<dim>(x));
  EXPECT_EQ(places.size(), static_cast<std::size_t>(refined.mesh.n_vertices()));

  std::size_t n_outer = 0;
  for (const auto& [centre, n] : cells_per_facet_centre(refined.mesh))
  {
    EXPECT_TRUE(n == 1 || n == 2) << n;
    n_outer += n == 1 ? 1 : 0;
  }
  EXPECT_EQ(n_outer, refined.mesh.boundary().size());
}

TYPED_TEST(Refine, CountsAreThoseOfTheFormula)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  for (const int times : {1, 2})
  {
    const mesh::Mesh<dim> refined = mesh::refine_uniformly(mesh, times).mesh;
    const mesh::EntityCounts n = mesh::count_after_refinement(mesh, times);
    EXPECT_EQ(n.vertices, refined.n_vertices());
    EXPECT_EQ(n.edges, refined.topology().edges.size());
    EXPECT_EQ(n.facets, refined.topology().facets.size());
    EXPECT_EQ(n.cells, refined.n_cells());
    EXPECT_EQ(n.cells, mesh.n_cells() * std::pow(1 << dim, times));
  }
}

TYPED_TEST(Refine, NamesRegionsAndBoundariesAreInherited)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  const mesh::Refined<dim> refined = mesh::refine_uniformly(mesh, 2);
  EXPECT_TRUE(std::ranges::equal(mesh.region_names(), refined.mesh.region_names()));
  EXPECT_TRUE(std::ranges::equal(mesh.boundary_names(), refined.mesh.boundary_names()));
  EXPECT_EQ(refined.mesh.source().file, "grid.msh");
  EXPECT_NEAR(volume(refined.mesh), volume(mesh), 1e-13);
  const std::size_t n_children = std::size_t{1} << (2 * (dim - 1));
  EXPECT_EQ(refined.mesh.boundary().size(), n_children * mesh.boundary().size());
  for (int tag = -1; tag < 2 * dim; ++tag)
    EXPECT_NEAR(boundary_measure(refined.mesh, tag), boundary_measure(mesh, tag), 1e-13) << tag;
}

TYPED_TEST(Refine, DescendantsFillTheirAncestors)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  const mesh::Refined<dim> refined = mesh::refine_uniformly(mesh, 2);
  std::vector<double> filled(mesh.n_cells(), 0.0);
  for (Index c = 0; c < refined.mesh.n_cells(); ++c)
  {
    const Index ancestor = refined.ancestor(c);
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, ancestor);
    filled[ancestor] += mesh::cell_map(refined.mesh, c).det / map.det;
    EXPECT_EQ(refined.mesh.region(c), mesh.region(ancestor));
    for (const Index v : refined.mesh.cell(c))
    {
      const Point<dim> xhat = map.inverse_transpose.transpose() * (refined.mesh.vertex(v) - map.origin);
      EXPECT_GE(xhat.minCoeff(), -1e-12);
      EXPECT_LE(xhat.sum(), 1 + 1e-12);
    }
  }
  for (const double share : filled) EXPECT_NEAR(share, 1.0, 1e-12);
}

TEST(RefineShapes, TrianglesStaySimilar)
{
  const mesh::Mesh<2> mesh = irregular_mesh<2>();
  EXPECT_NEAR(smallest_angle(mesh::refine_uniformly(mesh, 4).mesh), smallest_angle(mesh), 1e-9);
}

/// The children of a tetrahedron differ in shape from their parent only once; after that no significantly new
/// shapes appear. The meshes: Kuhn's tetrahedra, distorted ones, a flat one.
TEST(RefineShapes, AnglesOfTetrahedraAreBoundedOverFourLevels)
{
  mesh::MeshData<3> flat = mapped(box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1}),
                                  [](const Point<3>& x) {
                                    return Point<3>{x[0] + 0.4 * x[1], x[1], 0.2 * x[2]};
                                  });
  for (mesh::MeshData<3> data : {box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1}),
                                 distorted(box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1}), 7), std::move(flat)})
  {
    const mesh::Mesh<3> mesh(std::move(data));
    std::array<double, 5> angle{smallest_angle(mesh)};
    for (int level = 1; level <= 4; ++level)
      angle[level] = smallest_angle(mesh::refine_uniformly(mesh, level).mesh);
    EXPECT_GE(angle[1], 0.5 * angle[0]);
    for (int level = 2; level <= 4; ++level) EXPECT_GE(angle[level], angle[1] * (1 - 1e-9)) << level;
  }
}

/// The coordinates of the vertices of every cell, in order.
std::multiset<std::vector<double>> cells_in_space(const mesh::Mesh<3>& mesh)
{
  std::multiset<std::vector<double>> cells;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    std::array<Point<3>, 4> points = mesh::points_of(mesh.vertices(), mesh.cell(c));
    std::ranges::sort(points,
                      [](const Point<3>& x, const Point<3>& y) { return mesh::comes_before<3>(x, y); });
    std::vector<double> cell;
    for (const Point<3>& x : points) cell.insert(cell.end(), x.begin(), x.end());
    cells.insert(std::move(cell));
  }
  return cells;
}

/// Every octahedron in a Kuhn tetrahedron has two shortest diagonals.
TEST(RefineShapes, TheNumberingDoesNotMatter)
{
  const mesh::MeshData<3> data = box<3>({0, 0, 0}, {1, 1, 1}, {2, 1, 1});
  const auto expected = cells_in_space(mesh::refine_uniformly(mesh::Mesh<3>(data), 2).mesh);
  for (const unsigned seed : {1U, 2U, 3U})
    EXPECT_EQ(cells_in_space(mesh::refine_uniformly(mesh::Mesh<3>(renumbered(data, seed)), 2).mesh), expected)
        << seed;
}

TEST(RefineSize, TooManyCellsAreRefused)
{
  const mesh::Mesh<3> mesh(box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1}));
  testing_mesh::expect_input_error([&] { (void)mesh::refine_uniformly(mesh, 9); },
                                   {"9 times", "8.05e+08 cells"});
}

}  // namespace

}  // namespace tribound::test
