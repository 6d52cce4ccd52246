/// @file friedrichs_test.cpp
/// The Friedrichs constant against an independent program, exact constants, and functions that attain a
/// large part of it: ||f||_* <= C_F ||f|| for the residual of u = 0 under a body force f.

#include "tribound/certify/bound/friedrichs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/mesh/refine.h"

namespace tribound::test
{

namespace
{

template <int dim>
using Conditions = std::vector<problem::BoundaryCondition<dim>>;

constexpr double pi = std::numbers::pi;

template <int dim>
certify::FriedrichsConstant constant(const Conditions<dim>& boundaries, mesh::MeshData<dim> data)
{
  const mesh::Mesh<dim> mesh(std::move(data));
  return certify::friedrichs_constant<dim>(ProblemData<dim>{.boundaries = boundaries}.on(mesh), mesh);
}

template <int dim>
certify::FriedrichsConstant constant_without_factors(const Conditions<dim>& boundaries,
                                                     mesh::MeshData<dim> data)
{
  const mesh::Mesh<dim> mesh(std::move(data));
  return certify::friedrichs_constant<dim>(ProblemData<dim>{.boundaries = boundaries}.on(mesh), mesh, 0);
}

mesh::MeshData<2> rectangle(double length, double height, int nx, int ny)
{
  return box<2>({0, 0}, {length, height}, {nx, ny});
}

template <int dim>
Conditions<dim> clamped_sides(std::initializer_list<const char*> sides)
{
  Conditions<dim> conditions;
  for (const char* side : sides) conditions.push_back(clamped<dim>(side));
  return conditions;
}

/// In contact below.
template <int dim>
Conditions<dim> on_floor()
{
  return {obstacle<dim>("bottom")};
}

/// Clamped on the left, in contact below.
template <int dim>
Conditions<dim> held_on_floor()
{
  return {clamped<dim>("left"), obstacle<dim>("bottom")};
}

struct Reference
{
  int nx;
  double lambda;
  double value;
};

void expect_table(const Conditions<2>& boundaries, std::initializer_list<Reference> table)
{
  for (const auto& [nx, lambda, value] : table)
  {
    const certify::FriedrichsConstant c = constant<2>(boundaries, rectangle(2, 1, nx, nx / 2));
    EXPECT_NEAR(c.theta, (1 - 1e-6) * lambda, 1e-8 * lambda) << nx;
    EXPECT_NEAR(c.value, value, 1e-8 * value) << nx;
    EXPECT_NEAR(c.mesh_size, std::numbers::sqrt2 * 2 / nx, 1e-14) << nx;
    EXPECT_EQ(c.cells, nx * nx) << nx;
  }
}

/// lambda and C_F of an independent program, theta = (1 - 1e-6) lambda. The supremum itself, from below by P2
/// on meshes 8 times finer: 0.858432, 0.750268, 0.671755; contact only: 1.162340, 0.928614.
TEST(Friedrichs, AgreesWithAnIndependentProgram)
{
  expect_table(held_on_floor<2>(), {{2, 1.3580912308028317, 0.9561466712813653},
                                    {4, 1.7705614917660626, 0.7805544115153279},
                                    {8, 2.2111355466039844, 0.6807163660048423},
                                    {16, 2.5684776357256514, 0.6261913261809667}});
  expect_table(on_floor<2>(), {{2, 0.7078767308575882, 1.2611760039576667},
                               {4, 1.1406245168791955, 0.9597841514628193},
                               {8, 1.5902714851059665, 0.7999638041183113},
                               {16, 1.9505715844205436, 0.7179486430215892}});
}

/// k with k tan k = r, 0 < k < pi/2.
double robin_root(double r)
{
  double low = 0;
  double high = pi / 2;
  for (int i = 0; i < 60; ++i)
  {
    const double k = (low + high) / 2;
    (k * std::tan(k) < r ? low : high) = k;
  }
  return low;
}

void expect_from_above(const certify::FriedrichsConstant& c, double exact, double excess)
{
  EXPECT_GE(c.value, exact);
  EXPECT_LE(c.value, (1 + excess) * exact);
}

/// A beam of length 2 and height 1, fixed at the end x = 0, on a floor y = 0 with facets of diameter h:
/// sin(pi x / 4) cos(k (1 - y)) attains C^-2 = (pi/4)^2 + k^2 with k tan k = 1/h; where nothing is fixed, cos
/// alone.
TEST(Friedrichs, IsAboveTheExactConstantsOfABeamOnAFloor)
{
  const double fixed = pi / 4;
  for (const int n : {1, 2, 4, 16})
  {
    const double k = robin_root(n);
    const double excess = n == 16 ? 0.005 : 0.12 / n;
    expect_from_above(constant<2>(held_on_floor<2>(), rectangle(2, 1, 2 * n, n)), 1 / std::hypot(fixed, k),
                      excess);
    expect_from_above(constant<2>(on_floor<2>(), rectangle(2, 1, 2 * n, n)), 1 / k, excess);
  }
  for (const int n : {1, 3})
  {
    const double k = robin_root(n / std::numbers::sqrt2);
    const mesh::MeshData<3> block = box<3>({0, 0, 0}, {2, 1, 1}, {2 * n, n, n});
    expect_from_above(constant<3>(held_on_floor<3>(), block), 1 / std::hypot(fixed, k), 0.25 / n);
    expect_from_above(constant<3>(on_floor<3>(), block), 1 / k, 0.25 / n);
  }
}

/// ||f||_* / ||f|| for the body force f = e_y, from below.
template <int dim>
double attained(const Conditions<dim>& boundaries, const mesh::MeshData<dim>& data)
{
  const DiscreteProblem<dim> c(data, {.boundaries = boundaries, .body_force = {0, 1}});
  double volume = 0;
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    volume += mesh::cell_map(c.mesh, cell).det / (dim == 2 ? 2 : 6);
  certify::DualNorm<dim> dual(c.form, {.refinements = 1, .degree = 2});
  return dual(std::vector<double>(c.space.n_dofs(), 0.0)) / std::sqrt(volume);
}

template <int dim>
void expect_above_attained(const Conditions<dim>& boundaries, const mesh::MeshData<dim>& data)
{
  const double below = attained<dim>(boundaries, data);
  const double value = constant<dim>(boundaries, data).value;
  EXPECT_LE(below, value);
  EXPECT_GE(below, 0.75 * value);
}

TEST(Friedrichs, IsAboveWhatOneFunctionAttains)
{
  const mesh::MeshData<2> corner =
      without(box<2>({-1, -1}, {1, 1}, {4, 4}), [](const Point<2>& x) { return x[0] > 0 && x[1] > 0; });
  for (const Conditions<2>& boundaries : {held_on_floor<2>(), clamped_sides<2>({"right"})})
    expect_above_attained<2>(boundaries, distorted(corner, 3));
  expect_above_attained<3>(held_on_floor<3>(), distorted(box<3>({0, 0, 0}, {2, 1, 1}, {4, 2, 2}), 3));
}

/// C -> 1 / (pi sqrt(d)) for the unit square and cube fixed all around, 2 L / pi for a bar of length L fixed
/// at one end.
TEST(Friedrichs, ConvergesToExactConstantsFromAbove)
{
  const Conditions<2> square = clamped_sides<2>({"left", "right", "bottom", "top"});
  expect_from_above(constant<2>(square, rectangle(1, 1, 8, 8)), 1 / (pi * std::sqrt(2.0)), 0.04);
  expect_from_above(constant<2>(square, rectangle(1, 1, 32, 32)), 1 / (pi * std::sqrt(2.0)), 0.003);
  const Conditions<3> cube = clamped_sides<3>({"left", "right", "bottom", "top", "back", "front"});
  expect_from_above(constant<3>(cube, box<3>({0, 0, 0}, {1, 1, 1}, {6, 6, 6})), 1 / (pi * std::sqrt(3.0)),
                    0.15);
  expect_from_above(constant<2>(clamped_sides<2>({"left"}), rectangle(5, 1, 40, 8)), 10 / pi, 0.001);
  expect_from_above(constant<3>(clamped_sides<3>({"left"}), box<3>({0, 0, 0}, {3, 1, 1}, {12, 4, 4})), 6 / pi,
                    0.01);
}

/// Less sharp: up to 2.5 times the exact constants on these coarse meshes.
TEST(Friedrichs, WithoutFactorsIsAboveTheExactConstants)
{
  const Conditions<2> beam = held_on_floor<2>();
  for (const int n : {1, 4, 16})
  {
    const double k = robin_root(n);
    const mesh::MeshData<2> data = rectangle(2, 1, 2 * n, n);
    expect_from_above(constant_without_factors<2>(beam, data), 1 / std::hypot(pi / 4, k), 1.5);
    expect_from_above(constant_without_factors<2>(on_floor<2>(), data), 1 / k, 1.5);
    EXPECT_EQ(constant_without_factors<2>(beam, data).mesh_size, 0);
  }
  const mesh::MeshData<3> block = box<3>({0, 0, 0}, {2, 1, 1}, {6, 3, 3});
  const double k = robin_root(3 / std::numbers::sqrt2);
  expect_from_above(constant_without_factors<3>(held_on_floor<3>(), block), 1 / std::hypot(pi / 4, k), 1.5);
  expect_from_above(
      constant_without_factors<3>(clamped_sides<3>({"left", "right", "bottom", "top", "back", "front"}),
                                  box<3>({0, 0, 0}, {1, 1, 1}, {6, 6, 6})),
      1 / (pi * std::sqrt(3.0)), 1.5);
  const mesh::MeshData<3> bent = distorted(box<3>({0, 0, 0}, {2, 1, 1}, {4, 2, 2}), 3);
  const certify::FriedrichsConstant c = constant_without_factors<3>(clamped_sides<3>({"left"}), bent);
  EXPECT_GE(c.value, attained<3>(clamped_sides<3>({"left"}), bent));
  EXPECT_LT(c.value, 2 * constant<3>(clamped_sides<3>({"left"}), bent).value);
  EXPECT_EQ(c.value, 1 / std::sqrt(c.theta));
}

/// A facet of Gamma_C only splits and the supremum only shrinks; the bound follows it on these meshes.
TEST(Friedrichs, ShrinksUnderRefinement)
{
  const DiscreteProblem<2> c(distorted(rectangle(2, 1, 4, 2), 1), {.boundaries = held_on_floor<2>()});
  const double coarse = certify::friedrichs_constant<2>(c.problem, c.mesh).value;
  const mesh::Refined<2> refined = mesh::refine_uniformly(c.mesh);
  const double fine = certify::friedrichs_constant<2>(c.problem, refined.mesh).value;
  const mesh::Refined<2> twice = mesh::refine_uniformly(refined.mesh);
  EXPECT_LT(fine, coarse);
  EXPECT_LT(certify::friedrichs_constant<2>(c.problem, twice.mesh).value, fine);
}

/// x is fixed on the left (2 L / pi, L = 3), y below (2 / pi); or the other way round.
TEST(Friedrichs, IsTheLargestOfTheComponents)
{
  const mesh::MeshData<2> data = rectangle(3, 1, 24, 8);
  const certify::FriedrichsConstant rollers =
      constant<2>({fixed<2>("left", 0, free), fixed<2>("bottom", free, 0)}, data);
  EXPECT_GE(rollers.value, 6 / pi);
  EXPECT_LE(rollers.value, 1.002 * 6 / pi);
  const certify::FriedrichsConstant across =
      constant<2>({fixed<2>("left", 0, free), clamped<2>("bottom")}, data);
  EXPECT_LT(across.value, 1.02 * 2 / pi);
}

/// One flat cell in contact all around, kappa^2 H^2 > 1/theta: the proof needs the refined mesh, but the norm
/// is that of the given one, for which C^2 >= ||1||^2 / ||1||_{C,h}^2. With the h_F of the refined mesh the
/// constant is smaller than that.
template <int dim>
void expect_facets_kept(mesh::MeshData<dim> cell)
{
  cell.boundary_names = {"bottom"};
  cell.region_names = {"box"};
  cell.regions = {0};
  for (int i = 0; i <= dim; ++i) cell.facets.push_back({mesh::facet_vertices(cell.cells[0], i), 0});
  const DiscreteProblem<dim> c(cell, {.boundaries = on_floor<dim>()});
  double trace = 0;
  for (int i = 0; i <= dim; ++i)
  {
    const mesh::FacetGeometry<dim> facet = mesh::facet_geometry(c.mesh, 0, i);
    trace += facet.measure / facet.diameter;
  }
  const double below = std::sqrt(mesh::cell_map(c.mesh, 0).det / (dim == 2 ? 2 : 6) / trace);
  const certify::FriedrichsConstant constant = certify::friedrichs_constant<dim>(c.problem, c.mesh);
  EXPECT_EQ(constant.cells, 1 << dim);
  EXPECT_LT(constant.mesh_size, 0.7 * mesh::cell_diameter(c.mesh, 0));
  EXPECT_GE(constant.value, below);
  const mesh::Refined<dim> refined = mesh::refine_uniformly(c.mesh);
  EXPECT_LT(certify::friedrichs_constant<dim>(c.problem, refined.mesh).value, below);
}

TEST(Friedrichs, KeepsTheFacetsOfTheMeshWhereTheProofNeedsAFinerOne)
{
  expect_facets_kept<2>({.vertices = {{0, 0}, {1, 0}, {0.5, 0.4}}, .cells = {{0, 1, 2}}});
  expect_facets_kept<3>(
      {.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.866, 0}, {0.5, 0.2887, 0.6}}, .cells = {{0, 1, 2, 3}}});
}

/// Nothing but the boundary: both triangles of a square fixed all around have one free facet.
TEST(Friedrichs, OfTheSmallestMeshes)
{
  const Conditions<2> square = clamped_sides<2>({"left", "right", "bottom", "top"});
  EXPECT_GE(constant<2>(square, rectangle(1, 1, 1, 1)).value, 1 / (pi * std::sqrt(2.0)));
  mesh::MeshData<2> triangle{{.region_names = {"box"}, .boundary_names = {"left"}},
                             {{0, 0}, {1, 0}, {0, 1}},
                             {{0, 1, 2}},
                             {0},
                             {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 0}, 0}}};
  EXPECT_GE(constant<2>(clamped_sides<2>({"left"}), triangle).value, 1 / (pi * std::sqrt(5.0)));
}

TEST(Friedrichs, OfSeveralBodiesIsTheLargest)
{
  const mesh::MeshData<2> low = rectangle(2, 1, 8, 4);
  const mesh::MeshData<2> high =
      mapped(rectangle(3, 1, 12, 4), [](const Point<2>& x) -> Point<2> { return x + Point<2>(0, 2); });
  const mesh::MeshData<2> both = side_by_side(low, high, "_high");
  const certify::FriedrichsConstant larger = constant<2>(clamped_sides<2>({"left"}), high);
  const certify::FriedrichsConstant held = constant<2>(clamped_sides<2>({"left", "left_high"}), both);
  EXPECT_NEAR(held.theta, larger.theta, 1e-7 * larger.theta);
  EXPECT_NEAR(held.value, larger.value, 1e-7 * larger.value);
  EXPECT_GT(held.value, constant<2>(clamped_sides<2>({"left"}), low).value);

  const certify::FriedrichsConstant loose = constant<2>(clamped_sides<2>({"left"}), both);
  EXPECT_TRUE(std::isinf(loose.value));
  EXPECT_EQ(loose.theta, 0);
  const certify::FriedrichsConstant half =
      constant<2>({clamped<2>("left"), fixed<2>("left_high", 0, free)}, both);
  EXPECT_TRUE(std::isinf(half.value));
}

TEST(Friedrichs, IsALength)
{
  const Conditions<2> boundaries = held_on_floor<2>();
  const certify::FriedrichsConstant unit = constant<2>(boundaries, rectangle(2, 1, 6, 3));
  for (const double scale : {1e-6, 1e6})
  {
    const certify::FriedrichsConstant c = constant<2>(boundaries, rectangle(2 * scale, scale, 6, 3));
    EXPECT_NEAR(c.value, scale * unit.value, 1e-8 * scale * unit.value);
    EXPECT_NEAR(c.theta * scale * scale, unit.theta, 1e-8 * unit.theta);
  }
}

}  // namespace

}  // namespace tribound::test
