/// @file meridian_patch_test.cpp
/// The stress on patches of axisymmetric problems against an independent dense solution.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/meridian_patch.h"
#include "unit/certify/dense_meridian_patch.h"

namespace tribound::test
{

namespace
{

/// A row of tau_a of the program in one cell of the patch.
Point<2> value(const certify::SortedCell<2>& sorted, std::span<const double> stress, int row, int degree,
               const Point<2>& x)
{
  std::vector<double> phi(fem::polynomial_dimension(2, degree));
  fem::orthonormal_values<2>(degree, sorted.inverse * (x - sorted.origin), phi);
  Point<2> result = Point<2>::Zero();
  for (int k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < phi.size(); ++j)
      result[k] += stress[(2 * row + k) * phi.size() + j] * phi[j] / std::sqrt(sorted.det);
  return result;
}

/// The largest difference of a row from the dense solution, over the largest value.
double difference(const MeridianProblem& c, const DenseMeridianPatch& dense, int row,
                  std::span<const certify::MeridianPatchCell> cells)
{
  double scale = 0;
  double worst = 0;
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (const Point<2>& xhat : fem::quadrature<2>(4).points)
    {
      const Point<2> x = mesh::cell_map(c.mesh, cells[k].cell)(xhat);
      const Point<2> expected = dense(k, row, x);
      const Point<2> found =
          value(cells[k].prepared->sorted, cells[k].stress[0], row, c.space.degree() + 1, x);
      scale = std::max(scale, expected.norm());
      worst = std::max(worst, (expected - found).norm());
    }
  EXPECT_GT(scale, 0);
  return worst / scale;
}

/// The cells of a patch, and where their stress goes.
struct Patch
{
  Patch(const MeridianProblem& c, const certify::MeridianCellSource& source, std::span<const Index> around,
        std::span<const double> u, std::span<const double> turning = {})
      : stress(around.size(), std::vector<double>(4 * fem::polynomial_dimension(2, c.space.degree() + 1)))
  {
    prepared.reserve(around.size());
    for (const Index k : around)
    {
      std::vector<Tensor<2>> at_vertices;
      if (!turning.empty())
      {
        Tensor<2> spin;
        spin << 0, -turning[k], turning[k], 0;
        at_vertices.assign(3, spin);
      }
      prepared.push_back(source.prepare(k, u, at_vertices));
      cells.push_back({k, &prepared.back(), {stress[cells.size()]}});
    }
  }
  Patch(const Patch&) = delete;
  Patch& operator=(const Patch&) = delete;

  std::vector<std::vector<double>> stress;
  std::vector<certify::MeridianCell> prepared;
  std::vector<certify::MeridianPatchCell> cells;
};

void expect_minimisers(const MeridianProblem& c)
{
  const std::vector<double> u = any_displacement(c, 1);
  const std::vector<Point<2>> t = c.form.traction(u);
  const certify::MeridianCellSource source(c.form);
  const certify::MeridianFacets facets(c.form, source.reference(), u, {t, {}, {}});
  for (Index v = 0; v < c.mesh.n_vertices(); ++v)
    for (int row = 0; row < 2; ++row)
    {
      const DenseMeridianPatch dense(c, u, t, v, row, row + 1);
      const Patch patch(c, source, dense.cells(), u);
      certify::solve_meridian_patch(c.mesh, source.reference(), facets, v, 0, 1, patch.cells, true);
      EXPECT_LE(difference(c, dense, row, patch.cells), 1e-9) << "vertex " << v << ", row " << row;
    }
}

void expect_symmetric_minimisers(const MeridianProblem& c)
{
  const std::vector<double> u = any_displacement(c, 1);
  const std::vector<Point<2>> t = c.form.traction(u);
  std::mt19937 random(1);
  std::vector<double> turning(c.mesh.n_cells());
  for (double& k : turning) k = std::uniform_real_distribution<double>(-0.1, 0.1)(random);
  const problem::Material& material = c.problem.material(c.mesh.region(0));
  const certify::MeridianCellSource source(c.form, false, {{2 * material.mu, material.lambda}});
  const certify::MeridianFacets facets(c.form, source.reference(), u, {t, {}, {}});
  for (Index v = 0; v < c.mesh.n_vertices(); ++v)
  {
    const DenseMeridianPatch dense(c, u, t, v, 0, 2, turning);
    const Patch patch(c, source, dense.cells(), u, turning);
    certify::solve_meridian_patch(c.mesh, source.reference(), facets, v, 0, 1, patch.cells, false);
    for (int row = 0; row < 2; ++row)
      EXPECT_LE(difference(c, dense, row, patch.cells), 1e-9) << "vertex " << v << ", row " << row;
  }
}

class MeridianPatch : public OnMeridians
{
};

TEST_P(MeridianPatch, HasTheMinimiser)
{
  for (const bool held : {false, true})
    expect_minimisers(MeridianProblem(skew_mesh(axis(), 2), pressed(held), {.degree = degree()}));
}

class WeaklySymmetricPatch : public OnMeridians
{
};

/// The radial load is constant: of others the patches have a projection.
TEST_P(WeaklySymmetricPatch, HasTheMinimiser)
{
  for (const bool held : {false, true})
  {
    ProblemData<2> data = pressed(held);
    data.body_force[0] = 0.02;
    expect_symmetric_minimisers(MeridianProblem(skew_mesh(axis(), 2), data, {.degree = degree()}));
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, MeridianPatch, meridians);
// In degree 5 monomials lose too many digits.
INSTANTIATE_TEST_SUITE_P(Meshes, WeaklySymmetricPatch,
                         ::testing::Combine(::testing::Values(Axis::none, Axis::vertex, Axis::edges),
                                            ::testing::Range(1, 4)));

}  // namespace

}  // namespace tribound::test
