/// @file elasticity_test.cpp
/// Stiffness and loads, against the inverse form of Hooke's law and integrals in closed form.

#include "tribound/contact/nitsche/elasticity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <numeric>
#include <span>
#include <vector>

#include "support/dimensions.h"
#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

constexpr double E = 2.5;
constexpr double nu = 0.3;

template <int dim>
mesh::MeshData<dim> grid()
{
  return block<dim>({3, 2}, {2, 1, 1});
}

const problem::Material plane_strain = lame(E, nu);
const problem::Material plane_stress = lame(E, nu, problem::PlaneModel::stress);

/// eps from sigma: (1+nu)/E sigma - nu/E tr(sigma) I in 3D and plane stress; in plane strain
/// sigma_zz = nu tr(sigma) is added to the trace.
template <int dim>
Tensor<dim> strain(const Tensor<dim>& stress, bool is_plane_strain)
{
  const double trace = stress.trace() * (is_plane_strain ? 1 + nu : 1);
  return (1 + nu) / E * stress - nu / E * trace * Tensor<dim>::Identity();
}

template <int dim>
void expect_linear_fields_exact(int p, const problem::Material& material, bool is_plane_strain)
{
  const DiscreteProblem<dim> c(distorted(grid<dim>(), p), {.material = material}, {.degree = p});
  Tensor<dim> stress = Tensor<dim>::Identity() * 0.4;
  stress(0, 1) = stress(1, 0) = 0.7;
  stress(dim - 1, dim - 1) = -1.1;
  const Tensor<dim> eps = strain<dim>(stress, is_plane_strain);
  Tensor<dim> gradient = eps;
  gradient(0, 1) += 0.2;
  gradient(1, 0) -= 0.2;  // a rotation does no work
  const std::vector<double> u =
      interpolate<dim>(c.space, [&](const Point<dim>& x) -> Point<dim> { return gradient * x; });

  double volume = 0;
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    volume +=
        mesh::determinant<dim>(mesh::points_of(c.mesh.vertices(), c.mesh.cell(cell))) / (dim == 2 ? 2 : 6);
  const double energy = volume * stress.cwiseProduct(eps).sum();
  const contact::StressNorms norms = contact::stress_norms<dim>(c.problem, c.space, u);
  EXPECT_NEAR(norms.energy, energy, 1e-12 * energy);
  EXPECT_NEAR(norms.sigma, stress.norm() * std::sqrt(volume), 1e-12 * stress.norm());
  const std::vector<double> ku = contact::apply_stiffness<dim>(c.problem, c.space, u);
  EXPECT_NEAR(std::inner_product(u.begin(), u.end(), ku.begin(), 0.0), energy, 1e-12 * energy);
}

TEST(Elasticity, LinearFieldsHaveTheExactEnergy)
{
  for (int p = 1; p <= 4; ++p)
  {
    expect_linear_fields_exact<2>(p, plane_strain, true);
    expect_linear_fields_exact<2>(p, plane_stress, false);
    expect_linear_fields_exact<3>(p, plane_strain, false);
  }
}

/// Held on the left in all components but y.
template <int dim>
ProblemData<dim> held()
{
  return {.boundaries = {fixed<dim>("left", 0, free)}, .material = plane_strain};
}

template <class T>
class Stiffness : public ::testing::Test
{
};
TYPED_TEST_SUITE(Stiffness, Dimensions);

TYPED_TEST(Stiffness, MatrixAndCellwiseProductAgree)
{
  constexpr int dim = TypeParam::value;
  for (int p = 1; p <= 4; ++p)
  {
    const DiscreteProblem<dim> c(distorted(grid<dim>(), p), held<dim>(), {.degree = p});
    const fem::Constraints& constraints = c.form.constraints();
    ASSERT_GT(std::ranges::count(constraints.fixed, 1), 0);
    const std::vector<double> u = random_free_vector(constraints, 1.0, p);
    const algebra::Triplets matrix = entries(contact::stiffness(c.problem, c.space, constraints));
    const std::vector<double> expected =
        free_part(constraints, contact::apply_stiffness<dim>(c.problem, c.space, u));
    EXPECT_LE(distance(multiply(matrix, u), expected), 1e-12 * norm(expected)) << "degree " << p;
  }
}

TYPED_TEST(Stiffness, FixedDegreesOfFreedomHaveAPositiveDiagonalOnly)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c(grid<dim>(), held<dim>(), {.degree = 2});
  const fem::Constraints& constraints = c.form.constraints();
  const algebra::Triplets matrix = entries(contact::stiffness(c.problem, c.space, constraints));
  Index n_diagonal = 0;
  for (std::size_t k = 0; k < matrix.values.size(); ++k)
  {
    const int row = matrix.rows[k];
    const int col = matrix.cols[k];
    if (!constraints.fixed[row] && !constraints.fixed[col]) continue;
    if (row != col)
    {
      EXPECT_EQ(matrix.values[k], 0);
      continue;
    }
    EXPECT_GT(matrix.values[k], 0);
    ++n_diagonal;
  }
  EXPECT_EQ(n_diagonal, std::ranges::count(constraints.fixed, 1));
}

/// The rows of a node have the same columns, in whole blocks, as PETSc's GAMG prefers. Nodes without a free
/// component have only their own block.
TYPED_TEST(Stiffness, ConsistsOfWholeBlocks)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c(grid<dim>(),
                               {.boundaries = {fixed<dim>("left", 0, free), fixed<dim>("bottom", 0, 0, 0)}},
                               {.degree = 2});
  const fem::Constraints& constraints = c.form.constraints();
  const algebra::SparseRows rows = contact::stiffness(c.problem, c.space, constraints);
  const auto columns = [&](int row)
  { return std::span(rows.columns).subspan(rows.begin[row], rows.begin[row + 1] - rows.begin[row]); };
  for (Index node = 0; node < c.space.n_nodes(); ++node)
  {
    const auto first = columns(dim * node);
    for (int a = 1; a < dim; ++a) EXPECT_TRUE(std::ranges::equal(first, columns(dim * node + a)));
    ASSERT_EQ(first.size() % dim, 0U);
    for (std::size_t k = 0; k < first.size(); ++k)
      EXPECT_EQ(first[k], first[k - k % dim] + static_cast<int>(k) % dim);
    const auto fixed = std::span(constraints.fixed).subspan(dim * node, dim);
    EXPECT_EQ(std::ranges::count(fixed, 0) == 0, first.size() == dim) << "node " << node;
  }
}

/// L(v) for v = (xy, x): body force (1, y), traction (0, 3) on the right, pressure 2 x on top.
TEST(Load, AgreesWithIntegralsInClosedForm)
{
  for (int p = 2; p <= 4; ++p)
  {
    const DiscreteProblem<2> c(renumbered(grid<2>(), p),
                               {.boundaries = {loaded<2>("right", 0, 3), pressed<2>("top", formula("2*x"))},
                                .material = plane_strain,
                                .body_force = {1, formula("y")}},
                               {.degree = p});
    const std::vector<double> v =
        interpolate<2>(c.space, [](const Point<2>& x) { return Point<2>(x[0] * x[1], x[0]); });
    const double body = 1.0 + 1.0;    // xy + xy over [0, 2] x [0, 1]
    const double right = 3.0 * 2.0;   // 3 x at x = 2
    const double top = -2 * 8.0 / 3;  // -2 x x over [0, 2]
    const auto load = c.form.load();
    EXPECT_NEAR(std::inner_product(v.begin(), v.end(), load.begin(), 0.0), body + right + top, 1e-12);
  }
}

}  // namespace

}  // namespace tribound::test
