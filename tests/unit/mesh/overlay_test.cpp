/// The common refinement of two meshes from one forest.

#include "tribound/mesh/overlay.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <stdexcept>

#include "support/dimensions.h"
#include "support/meshes.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

template <int dim>
mesh::Mesh<dim> some_mesh()
{
  if constexpr (dim == 2)
    return mesh::Mesh<2>(distorted(box<2>({0, 0}, {2, 1}, {3, 2}), 4));
  else
    return mesh::Mesh<3>(distorted(box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1}), 4));
}

/// The mesh after `levels` bisections of random cells.
template <int dim>
mesh::Mesh<dim> bisected_at_random(int levels, int times, unsigned seed)
{
  std::mt19937 random(seed);
  std::bernoulli_distribution chosen(0.15);
  mesh::Mesh<dim> mesh = some_mesh<dim>();
  for (int level = 0; level < levels; ++level)
  {
    std::vector<Index> marked;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (chosen(random)) marked.push_back(c);
    mesh = std::move(mesh::bisect<dim>(mesh, marked, times).mesh);
  }
  return mesh;
}

/// The mesh after bisecting a cell at vertex 0 the given number of times.
template <int dim>
mesh::Mesh<dim> graded(mesh::Mesh<dim> mesh, int times)
{
  for (int i = 0; i < times; ++i)
  {
    const Index at_vertex = mesh.topology().vertex_cells[0];
    mesh = std::move(mesh::bisect<dim>(mesh, {{at_vertex}}, 1).mesh);
  }
  return mesh;
}

/// Whether every vertex of a cell lies in a given cell of another mesh.
template <int dim>
bool lies_in(const mesh::Mesh<dim>& mesh, Index cell, const mesh::Mesh<dim>& other, Index other_cell)
{
  const mesh::CellMap<dim> map = mesh::cell_map(other, other_cell);
  for (const Index v : mesh.cell(cell))
  {
    const Point<dim> xhat = fem::reference_point(map, mesh.vertex(v));
    if (xhat.minCoeff() < -1e-9 || xhat.sum() > 1 + 1e-9) return false;
  }
  return true;
}

template <class T>
class Overlay : public ::testing::Test
{
};
TYPED_TEST_SUITE(Overlay, Dimensions);

TYPED_TEST(Overlay, OfTwoCellsOneContainsTheOtherAndAllIsCovered)
{
  constexpr int dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    // Steps of one or of dim bisections, many or few, belong to the same forest. The first mesh is finer at a
    // vertex, the second elsewhere.
    const mesh::Mesh<dim> a = graded(bisected_at_random<dim>(3, 1, seed), 15);
    const mesh::Mesh<dim> b = bisected_at_random<dim>(3, dim, 100 + seed);
    std::vector<double> covered_a(a.n_cells(), 0.0);
    std::vector<double> covered_b(b.n_cells(), 0.0);
    int a_is_smaller = 0;
    int b_is_smaller = 0;
    for (const auto& [i, j] : mesh::overlay(a, b))
    {
      const double size_a = mesh::cell_map(a, i).det;
      const double size_b = mesh::cell_map(b, j).det;
      a_is_smaller += size_a < 0.75 * size_b;
      b_is_smaller += size_b < 0.75 * size_a;
      ASSERT_TRUE(size_a < size_b ? lies_in(a, i, b, j) : lies_in(b, j, a, i));
      covered_a[i] += std::min(size_a, size_b);
      covered_b[j] += std::min(size_a, size_b);
    }
    EXPECT_GT(a_is_smaller, 0);
    EXPECT_GT(b_is_smaller, 0);
    for (Index i = 0; i < a.n_cells(); ++i) EXPECT_NEAR(covered_a[i] / mesh::cell_map(a, i).det, 1, 1e-9);
    for (Index j = 0; j < b.n_cells(); ++j) EXPECT_NEAR(covered_b[j] / mesh::cell_map(b, j).det, 1, 1e-9);
  }
}

TYPED_TEST(Overlay, OfAMeshWithItself)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = bisected_at_random<dim>(3, 1, 7);
  const std::vector<mesh::CellPair> pairs = mesh::overlay(mesh, mesh);
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(mesh.n_cells()));
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    EXPECT_EQ(pairs[c].a, c);
    EXPECT_EQ(pairs[c].b, c);
  }
}

/// Graded towards a corner, forty times: sizes differ by 2^40.
TYPED_TEST(Overlay, OfAMeshGradedStrongly)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> coarse = some_mesh<dim>();
  const mesh::Mesh<dim> fine = graded(some_mesh<dim>(), 40);
  const std::vector<mesh::CellPair> pairs = mesh::overlay(coarse, fine);
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(fine.n_cells()));
  for (const auto& [i, j] : pairs) EXPECT_TRUE(lies_in(fine, j, coarse, i));
}

TYPED_TEST(Overlay, OtherMeshesAreRefused)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = some_mesh<dim>();
  const auto unit = []
  {
    if constexpr (dim == 2)
      return box<2>({0, 0}, {2, 1}, {3, 2});
    else
      return box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1});
  }();
  EXPECT_THROW((void)mesh::overlay(mesh, mesh::Mesh<dim>(renumbered(unit, 1))), std::invalid_argument);
  mesh::MeshData<dim> twice = side_by_side(
      unit, mapped(unit, [](const Point<dim>& x) -> Point<dim> { return x + Point<dim>::Constant(5); }), "2");
  EXPECT_THROW((void)mesh::overlay(mesh::Mesh<dim>(unit), mesh::Mesh<dim>(twice)), std::invalid_argument);
}

}  // namespace

}  // namespace tribound::test
