/// Inheritance of marked edges in bisection: orientation, and the resulting shapes.

#include "tribound/mesh/marked_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "support/dimensions.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

/// A single cell: points and bisection type.
template <int dim>
struct Simplex
{
  std::array<Point<dim>, dim + 1> points;
  std::uint8_t type;
};

template <int dim>
Simplex<dim> without_symmetry(std::uint8_t type)
{
  Simplex<dim> simplex{{}, type};
  if constexpr (dim == 2)
    simplex.points = {Point<2>{0, 0}, Point<2>{1.37, 0.11}, Point<2>{0.29, 0.83}};
  else
    simplex.points = {Point<3>{0, 0, 0}, Point<3>{1.37, 0.11, 0.05}, Point<3>{0.29, 0.83, -0.13},
                      Point<3>{0.41, 0.23, 0.71}};
  return simplex;
}

template <int dim>
Simplex<dim> child_of(const Simplex<dim>& parent, int kept)
{
  mesh::MarkedCell<dim> cell{{}, parent.type};
  std::iota(cell.vertices.begin(), cell.vertices.end(), 0);
  std::array<Point<dim>, dim + 2> points;
  std::ranges::copy(parent.points, points.begin());
  points[dim + 1] = 0.5 * (points[0] + points[1]);
  const mesh::MarkedCell<dim> result = mesh::child(cell, kept, dim + 1);
  return {mesh::points_of<dim>(points, result.vertices), result.type};
}

/// The shape up to similarity and reflection, with the vertices in the given order: squared edge lengths
/// relative to their sum, rounded.
template <int dim>
std::vector<long> shape(const std::array<Point<dim>, dim + 1>& points, const std::array<int, dim + 1>& order)
{
  std::vector<double> lengths;
  for (const auto& [i, j] : mesh::local_edges<dim>)
    lengths.push_back((points[order[i]] - points[order[j]]).squaredNorm());
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  std::vector<long> rounded;
  for (const double length : lengths) rounded.push_back(std::lround(1e8 * length / sum));
  return rounded;
}

/// The same for all orders of the vertices.
template <int dim>
std::vector<long> similarity_class(const std::array<Point<dim>, dim + 1>& points)
{
  std::array<int, dim + 1> order;
  std::iota(order.begin(), order.end(), 0);
  std::vector<long> least = shape<dim>(points, order);
  while (std::ranges::next_permutation(order).found) least = std::min(least, shape<dim>(points, order));
  return least;
}

struct Shapes
{
  std::size_t n_classes;
  int last_generation;  ///< the one in which the last new class appears
};

/// All shapes among the descendants of a cell; ends because descendants repeat in shape and type.
template <int dim>
Shapes all_shapes(const Simplex<dim>& cell)
{
  std::array<int, dim + 1> as_it_is;
  std::iota(as_it_is.begin(), as_it_is.end(), 0);
  std::set<std::vector<long>> classes{similarity_class<dim>(cell.points)};
  std::set<std::pair<std::vector<long>, int>> seen;
  Shapes result{1, 0};
  std::vector<Simplex<dim>> generation{cell};
  for (int g = 1; !generation.empty(); ++g)
  {
    std::vector<Simplex<dim>> next;
    for (const Simplex<dim>& parent : generation)
      for (int kept = 0; kept < 2; ++kept)
      {
        const Simplex<dim> simplex = child_of(parent, kept);
        if (!seen.emplace(shape<dim>(simplex.points, as_it_is), simplex.type).second) continue;
        next.push_back(simplex);
        if (classes.insert(similarity_class<dim>(simplex.points)).second) result.last_generation = g;
      }
    if (seen.size() > 10000)
    {
      ADD_FAILURE() << "the shapes do not repeat";
      break;
    }
    generation = std::move(next);
  }
  result.n_classes = classes.size();
  return result;
}

template <class T>
class Marked : public ::testing::Test
{
};
TYPED_TEST_SUITE(Marked, Dimensions);

TYPED_TEST(Marked, ChildrenArePositivelyOrientedHalves)
{
  constexpr int dim = TypeParam::value;
  for (int type = 0; type < mesh::n_bisection_types<dim>; ++type)
  {
    const auto parent = without_symmetry<dim>(static_cast<std::uint8_t>(type));
    for (int kept = 0; kept < 2; ++kept)
    {
      const Simplex<dim> simplex = child_of(parent, kept);
      EXPECT_NEAR(mesh::determinant<dim>(simplex.points), 0.5 * mesh::determinant<dim>(parent.points), 1e-15)
          << type;
      EXPECT_LT(simplex.type, mesh::n_bisection_types<dim>);
    }
  }
}

/// Triangles have 4. Tetrahedra whose marked edges lie in one plane or form a path (types 4, 8 and 5, 7) have
/// 36: bisection runs through these types in turn. The children of any other tetrahedron have such a type.
/// All shapes are there after 7 bisections.
TYPED_TEST(Marked, DescendantsHaveFewShapes)
{
  constexpr int dim = TypeParam::value;
  for (int type = 0; type < (dim == 2 ? 1 : 9); ++type)
  {
    const Shapes shapes = all_shapes(without_symmetry<dim>(static_cast<std::uint8_t>(type)));
    const bool in_turn = type == 4 || type == 5 || type == 7 || type == 8;
    if (dim == 2)
      EXPECT_EQ(shapes.n_classes, 4U);
    else if (in_turn)
      EXPECT_EQ(shapes.n_classes, 36U) << type;
    else
      EXPECT_LE(shapes.n_classes, 73U) << type;
    EXPECT_LE(shapes.last_generation, dim == 2 ? 2 : 7) << type;
  }
}

/// The mark of a face must be the same from both sides, whatever the order of the vertices, even if lengths
/// are equal or differ only by round-off.
TEST(MarkedFirst, FacesAreMarkedTheSameFromBothSides)
{
  const double a = 1.0 / 3;
  for (const std::array<Point<3>, 5>& points :
       {std::array<Point<3>, 5>{Point<3>{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {2, 2, 2}},
        {Point<3>{a, a, a}, {a + 0.1, a + 0.1, a}, {a + 0.1, a, a + 0.1}, {a, a + 0.1, a + 0.1}, {1, 1, 1}}})
  {
    std::array<Index, 3> face{1, 2, 3};
    std::set<std::set<Index>> marked;
    do
      for (const Index tip : {0, 4})
      {
        const mesh::Cell<3> vertices{face[0], face[1], face[2], tip};
        const auto cell = mesh::longest_edges_marked<3>(points, vertices);
        const auto local = static_cast<int>(std::ranges::find(cell.vertices, tip) - cell.vertices.begin());
        const auto facet = mesh::marked_facet(cell, local);
        marked.insert({facet[0], facet[1]});
      }
    while (std::ranges::next_permutation(face).found);
    EXPECT_EQ(marked.size(), 1U);
  }
}

}  // namespace

}  // namespace tribound::test
