/// Functions carried to a bisected mesh do not change.

#include "tribound/fem/nested.h"

#include <gtest/gtest.h>

#include <random>

#include "support/dimensions.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

/// u at a point of the reference cell.
template <int dim>
Point<dim> value_in_cell(const fem::LagrangeSpace<dim>& space, std::span<const double> u, Index cell,
                         const Point<dim>& xhat)
{
  const fem::Tabulation<dim> table = space.basis().tabulate({{xhat}});
  Point<dim> value = Point<dim>::Zero();
  for (int i = 0; i < table.n_nodes; ++i)
    for (int a = 0; a < dim; ++a) value[a] += table.values[i] * u[dim * space.cell_nodes(cell)[i] + a];
  return value;
}

/// u at a point of the domain, in any cell that contains it.
template <int dim>
Point<dim> value_at(const fem::LagrangeSpace<dim>& space, std::span<const double> u, const Point<dim>& x)
{
  for (Index c = 0; c < space.mesh().n_cells(); ++c)
  {
    const Point<dim> xhat = fem::reference_point(mesh::cell_map(space.mesh(), c), x);
    if (xhat.minCoeff() >= -1e-12 && xhat.sum() <= 1 + 1e-12) return value_in_cell(space, u, c, xhat);
  }
  ADD_FAILURE() << "no cell contains " << x.transpose();
  return Point<dim>::Zero();
}

template <int dim>
mesh::Mesh<dim> some_mesh()
{
  if constexpr (dim == 2)
    return mesh::Mesh<2>(distorted(box<2>({0, 0}, {2, 1}, {4, 3}), 4));
  else
    return mesh::Mesh<3>(distorted(box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1}), 4));
}

template <class T>
class Nested : public ::testing::Test
{
};
TYPED_TEST_SUITE(Nested, Dimensions);

TYPED_TEST(Nested, CarriedToABisectedMeshValuesStay)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(0, 1);
  const mesh::Mesh<dim> mesh = some_mesh<dim>();
  const mesh::Bisected<dim> bisected = mesh::bisect<dim>(mesh, std::vector<Index>{2, 3, 9});
  for (int degree = 1; degree <= 4; ++degree)
  {
    const fem::LagrangeSpace<dim> coarse(mesh, degree);
    const fem::LagrangeSpace<dim> fine(bisected.mesh, degree);
    const fem::Constraints none{std::vector<char>(coarse.n_dofs(), 0), {}};
    const std::vector<double> u = random_free_vector(none, 1.0, 3);
    const std::vector<double> carried = fem::nested_interpolant<dim>(coarse, u, bisected.parent, fine);
    ASSERT_EQ(carried.size(), static_cast<std::size_t>(fine.n_dofs()));
    for (Index c = 0; c < bisected.mesh.n_cells(); ++c)
    {
      Point<dim> xhat = Point<dim>::NullaryExpr([&] { return uniform(random); });
      xhat *= uniform(random) / xhat.sum();
      const Point<dim> x = mesh::cell_map(bisected.mesh, c)(xhat);
      EXPECT_LT((value_in_cell<dim>(fine, carried, c, xhat) - value_at<dim>(coarse, u, x)).norm(), 1e-12)
          << degree;
    }
  }
}

/// Carried over several bisections, step by step or at once, values stay the same.
TYPED_TEST(Nested, CarriedOverManyLevelsValuesStay)
{
  constexpr int dim = TypeParam::value;
  constexpr int degree = 2;
  std::mt19937 random(9);
  std::bernoulli_distribution chosen(0.1);
  const mesh::Mesh<dim> first = some_mesh<dim>();
  const fem::LagrangeSpace<dim> first_space(first, degree);
  const fem::Constraints none{std::vector<char>(first_space.n_dofs(), 0), {}};
  const std::vector<double> first_u = random_free_vector(none, 1.0, 3);

  mesh::Mesh<dim> mesh = some_mesh<dim>();
  std::vector<double> u = first_u;
  for (int level = 0; level < 6; ++level)
  {
    std::vector<Index> marked;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (chosen(random)) marked.push_back(c);
    mesh::Bisected<dim> bisected = mesh::bisect<dim>(mesh, marked, 1);
    u = fem::nested_interpolant<dim>(fem::LagrangeSpace<dim>(mesh, degree), u, bisected.parent,
                                     fem::LagrangeSpace<dim>(bisected.mesh, degree));
    mesh = std::move(bisected.mesh);
  }
  EXPECT_GT(mesh.n_cells(), 2 * first.n_cells());
  const fem::LagrangeSpace<dim> space(mesh, degree);
  const auto points = space.node_points();
  for (Index node = 0; node < space.n_nodes(); ++node)
  {
    const Point<dim> expected = value_at<dim>(first_space, first_u, points[node]);
    for (int a = 0; a < dim; ++a) EXPECT_NEAR(u[dim * node + a], expected[a], 1e-12);
  }
}

}  // namespace

}  // namespace tribound::test
