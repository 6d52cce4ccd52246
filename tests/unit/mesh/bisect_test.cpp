/// Bisection: conforming, tags and measures inherited, children inside their parents, shapes bounded,
/// independent of numbering.

#include "tribound/mesh/bisect.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "support/dimensions.h"
#include "unit/mesh/bisect_checks.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::test
{

namespace
{

using testing_mesh::cells_by_coordinates;
using testing_mesh::coordinates;
using testing_mesh::Directory;
using testing_mesh::expect_conforming;
using testing_mesh::expect_right_ancestry;
using testing_mesh::expect_right_parents;
using testing_mesh::expect_same_parts;
using testing_mesh::expect_tags_in_place;
using testing_mesh::irregular_data;
using testing_mesh::irregular_mesh;
using testing_mesh::smallest_angle;
using testing_mesh::whole_boundary;

std::vector<Index> all_cells(Index n)
{
  std::vector<Index> cells(n);
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

std::vector<Index> random_cells(Index n, double share, std::mt19937& random)
{
  std::bernoulli_distribution chosen(share);
  std::vector<Index> cells;
  for (Index c = 0; c < n; ++c)
    if (chosen(random)) cells.push_back(c);
  return cells;
}

/// The cells that contain the vertex.
template <int dim>
std::vector<Index> cells_around(const mesh::Mesh<dim>& mesh, Index vertex)
{
  const mesh::Topology<dim>& topology = mesh.topology();
  const auto begin = topology.vertex_cells.begin();
  return {begin + topology.vertex_cells_begin[vertex], begin + topology.vertex_cells_begin[vertex + 1]};
}

/// The vertex farthest to the lower left.
template <int dim>
Index corner(const mesh::Mesh<dim>& mesh)
{
  const auto vertices = mesh.vertices();
  return static_cast<Index>(
      std::ranges::min_element(vertices, {}, [](const Point<dim>& x) { return x.sum(); }) - vertices.begin());
}

/// About a fifth of the cells, chosen by a hash of their coordinates.
template <int dim>
std::vector<Index> cells_chosen_by_place(const mesh::Mesh<dim>& mesh, std::uint64_t seed)
{
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    std::uint64_t hash = seed;
    for (const auto& point : coordinates(mesh, mesh.cell(c)))
      for (const double x : point)
        hash = std::rotl((hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U, 29);
    if (hash % 5 == 0) cells.push_back(c);
  }
  return cells;
}

/// Bisects `levels` times; `choose(mesh, level)` names the cells. Checks every level, returns the last mesh.
template <int dim, class Choose>
mesh::Mesh<dim> bisect_and_check(mesh::Mesh<dim> mesh, int levels, const Choose& choose, int times = dim)
{
  const double boundary = whole_boundary(mesh);
  for (int level = 0; level < levels && !::testing::Test::HasFailure(); ++level)
  {
    const std::vector<Index> marked = choose(mesh, level);
    mesh::Bisected<dim> bisected = mesh::bisect<dim>(mesh, marked, times);
    SCOPED_TRACE(level);
    expect_conforming(bisected.mesh, boundary);
    expect_same_parts(bisected.mesh, mesh);
    expect_right_parents(bisected, mesh);
    expect_tags_in_place(bisected, mesh);
    expect_right_ancestry(bisected.mesh, mesh);
    mesh = std::move(bisected.mesh);
  }
  return mesh;
}

/// The smallest angle among the descendants of the cells. After 9 bisections of every cell there are no new
/// shapes, see marked_cell_test.cpp.
template <int dim>
double smallest_angle_of_descendants(const mesh::Mesh<dim>& mesh)
{
  double smallest = smallest_angle(mesh);
  mesh::Bisected<dim> bisected = mesh::bisect<dim>(mesh, all_cells(mesh.n_cells()));
  for (int times = dim; times <= 9; times += dim)
  {
    smallest = std::min(smallest, smallest_angle(bisected.mesh));
    bisected = mesh::bisect<dim>(bisected.mesh, all_cells(bisected.mesh.n_cells()));
  }
  return smallest;
}

/// The angles of `mesh`, refined from `original`, are bounded; the test's XML output contains the figures.
template <int dim>
void expect_bounded_angles(const mesh::Mesh<dim>& mesh, const mesh::Mesh<dim>& original)
{
  const double angle = smallest_angle(mesh);
  EXPECT_GE(angle, smallest_angle_of_descendants(original) * (1 - 1e-9));
  ::testing::Test::RecordProperty("cells", mesh.n_cells());
  ::testing::Test::RecordProperty("smallest_angle_before", std::to_string(smallest_angle(original)));
  ::testing::Test::RecordProperty("smallest_angle_after", std::to_string(angle));
}

template <class T>
class Bisect : public ::testing::Test
{
};
TYPED_TEST_SUITE(Bisect, Dimensions);

TYPED_TEST(Bisect, RandomLevels)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(5);
  const mesh::Mesh<dim> mesh = bisect_and_check(
      irregular_mesh<dim>(), dim == 2 ? 20 : 12,
      [&](const mesh::Mesh<dim>& m, int) { return random_cells(m.n_cells(), dim == 2 ? 0.2 : 0.15, random); },
      1);
  EXPECT_GT(mesh.n_cells(), 10000);
  expect_bounded_angles(mesh, irregular_mesh<dim>());
}

/// Far from the corner nothing changes, so from some level on each level adds the same number of cells.
TYPED_TEST(Bisect, GradedTowardsACorner)
{
  constexpr int dim = TypeParam::value;
  std::vector<Index> n_cells;
  const mesh::Mesh<dim> mesh = bisect_and_check(irregular_mesh<dim>(), dim == 2 ? 15 : 8,
                                                [&](const mesh::Mesh<dim>& m, int)
                                                {
                                                  n_cells.push_back(m.n_cells());
                                                  return cells_around(m, corner(m));
                                                });
  const Index added = mesh.n_cells() - n_cells.back();
  EXPECT_GT(added, 0);
  for (std::size_t level = n_cells.size() - 1; level > n_cells.size() - 4; --level)
    EXPECT_EQ(n_cells[level] - n_cells[level - 1], added);
  expect_bounded_angles(mesh, irregular_mesh<dim>());
}

TYPED_TEST(Bisect, AllCellsDimTimesHalvesEveryEdge)
{
  constexpr int dim = TypeParam::value;
  mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  for (int level = 0; level < 3; ++level)
  {
    mesh::Bisected<dim> bisected = mesh::bisect<dim>(mesh, all_cells(mesh.n_cells()));
    EXPECT_EQ(bisected.mesh.n_cells(), mesh.n_cells() * (1 << dim));
    EXPECT_EQ(bisected.mesh.n_vertices() - mesh.n_vertices(), mesh.topology().edges.size());
    mesh = std::move(bisected.mesh);
  }
}

/// The volumes of the descendants of marked cells; the rest of the mesh is cut less.
TYPED_TEST(Bisect, MarkedCellsAreCutAsOftenAsAskedFor)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  const std::vector<Index> marked{3, 7};
  for (int times = 1; times <= 5; ++times)
  {
    const mesh::Bisected<dim> bisected = mesh::bisect<dim>(mesh, marked, times);
    expect_conforming(bisected.mesh, whole_boundary(mesh));
    for (Index c = 0; c < bisected.mesh.n_cells(); ++c)
      if (bisected.parent[c] == 3 || bisected.parent[c] == 7)
      {
        const double share =
            mesh::cell_map(bisected.mesh, c).det / mesh::cell_map(mesh, bisected.parent[c]).det;
        EXPECT_LE(share, std::ldexp(1 + 1e-9, -times));
      }
    EXPECT_LT(bisected.mesh.n_cells(), mesh.n_cells() * (1 << times));
  }
}

/// A mesh continues where it stopped: bisecting in one go or in two gives the same. The cells are flat, so
/// the longest edges of the descendants are not their refinement edges.
TYPED_TEST(Bisect, BisectionTypesAreCarriedAlong)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(mapped(irregular_data<dim>(),
                                    [](Point<dim> x)
                                    {
                                      x[1] *= 0.2;
                                      return x;
                                    }));
  const auto all = all_cells(mesh.n_cells());
  const mesh::Mesh<dim> first = mesh::bisect<dim>(mesh, all, dim).mesh;
  const mesh::Mesh<dim> second = mesh::bisect<dim>(first, all_cells(first.n_cells()), 2 * dim).mesh;
  EXPECT_EQ(cells_by_coordinates(second), cells_by_coordinates(mesh::bisect<dim>(mesh, all, 3 * dim).mesh));
}

TYPED_TEST(Bisect, NothingMarkedChangesNothing)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  const mesh::Bisected<dim> same = mesh::bisect<dim>(mesh, {});
  EXPECT_EQ(cells_by_coordinates(same.mesh), cells_by_coordinates(mesh));
  EXPECT_EQ(same.parent, all_cells(mesh.n_cells()));
}

TYPED_TEST(Bisect, OrderAndRepetitionOfMarksDoNotMatter)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = irregular_mesh<dim>();
  const mesh::Bisected<dim> a = mesh::bisect<dim>(mesh, std::vector<Index>{1, 4, 9});
  const mesh::Bisected<dim> b = mesh::bisect<dim>(mesh, std::vector<Index>{9, 4, 9, 1, 4});
  EXPECT_TRUE(std::ranges::equal(a.mesh.vertices(), b.mesh.vertices()));
  EXPECT_TRUE(std::ranges::equal(a.mesh.cells(), b.mesh.cells()));
  EXPECT_TRUE(std::ranges::equal(a.mesh.bisection_types(), b.mesh.bisection_types()));
  EXPECT_EQ(a.parent, b.parent);
}

/// The meshes have edges of equal and of nearly equal length: squares and cubes, isosceles and equilateral
/// triangles.
TYPED_TEST(Bisect, NumberingDoesNotMatter)
{
  constexpr int dim = TypeParam::value;
  const auto slanted = [](double height)
  {
    return [height](const Point<dim>& x)
    {
      Point<dim> y = x;
      y[0] -= 0.5 * x[1];
      y[1] *= height;
      return y;
    };
  };
  mesh::MeshData<dim> grid;
  if constexpr (dim == 2)
    grid = box<2>({0, 0}, {1, 1}, {4, 4});
  else
    grid = box<3>({0, 0, 0}, {1, 0.5, 0.5}, {4, 2, 2});
  for (const mesh::MeshData<dim>& data :
       {grid, mapped(grid, slanted(2)), mapped(grid, slanted(std::sqrt(0.75))), irregular_data<dim>()})
    for (unsigned seed = 0; seed < 5; ++seed)
    {
      mesh::Mesh<dim> a{mesh::MeshData<dim>(data)};
      mesh::Mesh<dim> b{renumbered(data, seed)};
      for (std::uint64_t level = 0; level < 5; ++level)
      {
        a = mesh::bisect<dim>(a, cells_chosen_by_place(a, level + seed), 1).mesh;
        b = mesh::bisect<dim>(b, cells_chosen_by_place(b, level + seed), 1).mesh;
        ASSERT_EQ(a.n_cells(), b.n_cells());
        ASSERT_EQ(cells_by_coordinates(a), cells_by_coordinates(b));
      }
    }
}

/// Gmsh meshes: two regions around a hole; a solid whose cells shrink towards an edge.
const std::string plate_geo = R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1}; Disk(2) = {0.8, 0.5, 0, 0.3, 0.2}; Rectangle(3) = {1.5, 0, 0, 0.5, 1};
BooleanDifference(4) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
BooleanFragments{ Surface{4}; Delete; }{ Surface{3}; Delete; }
Mesh.MeshSizeMax = 0.3;
Physical Surface("strip") = Surface In BoundingBox {1.4, -0.1, -0.1, 2.1, 1.1, 0.1};
Physical Surface("plate") = Surface In BoundingBox {-0.1, -0.1, -0.1, 1.6, 1.1, 0.1};
Physical Curve("end") = Curve In BoundingBox {1.9, -0.1, -0.1, 2.1, 1.1, 0.1};
)";
const std::string solid_geo = R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {1, 0, 0, 0.5, 1, 1}; Coherence;
MeshSize {:} = 0.6; MeshSize { PointsOf { Curve{1}; } } = 0.2;
Physical Volume("cube") = {1}; Physical Volume("slab") = {2};
Physical Surface("floor") = Surface In BoundingBox {-0.1, -0.1, -0.1, 1.6, 1.1, 0.1};
)";

TYPED_TEST(Bisect, MeshesFromGmsh)
{
  constexpr int dim = TypeParam::value;
  const Directory directory;
  const auto source = directory.write("mesh.geo", dim == 2 ? plate_geo : solid_geo);
  std::mt19937 random(11);
  const auto original = std::get<mesh::Mesh<dim>>(mesh::read_mesh(source));
  const mesh::Mesh<dim> mesh = bisect_and_check(
      std::get<mesh::Mesh<dim>>(mesh::read_mesh(source)), dim == 2 ? 8 : 4,
      [&](const mesh::Mesh<dim>& m, int) { return random_cells(m.n_cells(), 0.1, random); }, 1);
  expect_bounded_angles(mesh, original);
}

}  // namespace

}  // namespace tribound::test
