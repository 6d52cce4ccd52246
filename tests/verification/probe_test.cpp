/// @file probe_test.cpp
/// The solution at points: exact where it is a polynomial, on facets, vertices and interfaces, too.

#include "tribound/io/record/probes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "support/two_blocks.h"
#include "verification/observed.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

constexpr double lambda = 1.5;
constexpr double mu = 0.7;

/// u = (x^2, x y [, z x]), whose stress is linear; held on all sides.
template <int dim>
ProblemData<dim> quadratic()
{
  ProblemData<dim> data{
      .material = {.lambda = lambda, .mu = mu},
      .body_force = components<dim, problem::Field>(-((dim + 1) * lambda + (dim + 3) * mu), 0.0, 0.0)};
  for (const char* side : side_names<dim>)
    data.boundaries.push_back(fixed<dim>(side, formula("x^2"), formula("x*y"), formula("z*x")));
  return data;
}

template <int dim>
Point<dim> quadratic_u(const Point<dim>& x)
{
  return x[0] * x;
}

/// In the order of symmetric_part().
template <int dim>
std::array<double, 6> quadratic_stress(const Point<dim>& x)
{
  const double trace = (dim + 1) * x[0];
  const double along = lambda * trace + 4 * mu * x[0];
  const double across = lambda * trace + 2 * mu * x[0];
  if constexpr (dim == 2)
    return {along, across, lambda * trace, mu * x[1], 0, 0};
  else
    return {along, across, across, mu * x[1], 0, mu * x[2]};
}

/// Vertices, midpoints of edges and of facets, and points of no such kind.
template <int dim>
std::vector<Point<dim>> places(const mesh::Mesh<dim>& mesh)
{
  std::vector<Point<dim>> points = {mesh.vertex(0), mesh.vertex(mesh.n_vertices() - 1)};
  for (const Index c : {0, mesh.n_cells() / 2})
  {
    const auto v = mesh::points_of(mesh.vertices(), mesh.cell(c));
    points.push_back((v[0] + v[1]) / 2);
    points.push_back(std::accumulate(v.begin(), v.end() - 1, Point<dim>(Point<dim>::Zero())) / dim);
    points.push_back(0.7 * v[0] + 0.3 * (v[1] + v[dim]) / 2);
  }
  return points;
}

template <int dim>
void expect_quadratic(int p, certify::PatchStress stress)
{
  const DiscreteProblem<dim> c(renumbered(block<dim>({3, 2}, {2, 1, 2}), 5), quadratic<dim>(), {.degree = p});
  const std::vector<io::Probe<dim>> probes = {{.name = "here", .points = places(c.mesh), .where = {}}};
  io::check_probes<dim>(c.mesh, probes);
  const auto found = io::read_probes<dim>(c.form, observed(c, stress), true, probes);
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].rows.size(), probes[0].points.size());
  for (std::size_t k = 0; k < found[0].rows.size(); ++k)
  {
    const io::ProbeRow& row = found[0].rows[k];
    const Point<dim>& x = probes[0].points[k];
    SCOPED_TRACE(k);
    EXPECT_EQ(row.point, k);
    EXPECT_EQ(row.region, "box");
    for (int i = 0; i < dim; ++i) EXPECT_NEAR(row.u[i], quadratic_u<dim>(x)[i], 1e-11);
    const std::array<double, 6> expected = quadratic_stress<dim>(x);
    ASSERT_TRUE(row.equilibrated);
    for (int i = 0; i < 6; ++i)
    {
      EXPECT_NEAR(row.stress[i], expected[i], 1e-10);
      EXPECT_NEAR((*row.equilibrated)[i], expected[i], 1e-9);
    }
    EXPECT_LE(*row.difference, 1e-9);
  }
}

TEST(Probe, IsExactForPolynomials)
{
  for (int p = 2; p <= 4; ++p)
    for (const certify::PatchStress stress : {certify::PatchStress::rows, certify::PatchStress::afw})
    {
      SCOPED_TRACE(p);
      expect_quadratic<2>(p, stress);
      expect_quadratic<3>(std::min(p, 3), stress);
    }
}

/// Where cells meet, the row has the means of the stresses of the cells of its region, and the largest
/// difference, here by hand.
TEST(Probe, TakesMeansOverTheCellsOfARegion)
{
  const DiscreteProblem<2> c(block<2>({2, 1}), pressed_block<2>(), {.degree = 2});
  const adapt::CertifiedLevel<2> level = observed(c, certify::PatchStress::rows);
  const Point<2> vertex(1, 1);
  const std::vector<io::Probe<2>> probes = {{.name = "top", .points = {vertex}, .where = {}}};
  const io::ProbeRow row = io::read_probes<2>(c.form, level, true, probes)[0].rows.at(0);
  const auto sigma = io::stress_field(c.problem, c.space, level.u);
  const auto sigma_h = io::equilibrated_stress_field(c.space, level.stress);
  Tensor<2> sum = Tensor<2>::Zero();
  double largest = 0;
  int n = 0;
  std::vector<Tensor<2>> one(c.space.basis().n_nodes());
  std::vector<Tensor<2>> other(one.size());
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    for (int i = 0; i < 3; ++i)
    {
      if (c.mesh.vertex(c.mesh.cell(cell)[i]) != vertex) continue;
      ++n;
      sigma.at_nodes(cell, one);
      sigma_h.at_nodes(cell, other);
      const int node = static_cast<int>(std::ranges::find(c.space.cell_nodes(cell), corner(c, vertex)) -
                                        c.space.cell_nodes(cell).begin());
      sum += one[node];
      largest = std::max(largest, (one[node] - other[node]).norm());
    }
  EXPECT_GE(n, 2);
  EXPECT_NEAR(row.stress[0], sum(0, 0) / n, 1e-14);
  EXPECT_NEAR(row.stress[3], (sum(0, 1) + sum(1, 0)) / 2 / n, 1e-14);
  EXPECT_NEAR(*row.difference, largest, 1e-14);
  const io::ProbeRow without = io::read_probes<2>(c.form, level, false, probes)[0].rows.at(0);
  EXPECT_FALSE(without.equilibrated);
  EXPECT_FALSE(without.difference);
  EXPECT_EQ(without.stress, row.stress);
}

/// A point of the interface belongs to both bodies, which slide and have different stresses along it.
TEST(Probe, HasARowForEachBody)
{
  const DiscreteProblem<2> c(matching_blocks<2>(),
                             {.boundaries = {loaded<2>(fixed<2>("left", 0.0, free), 0, 0),
                                             pressed<2>("top", 0.1), clamped<2>("bottom_below")},
                              .pairs = {pair<2>("bottom", "top_below")}},
                             {.degree = 2});
  const std::vector<io::Probe<2>> probes = {
      {.name = "line", .points = {{1.1, 0.5}, {1.1, 0}, {1.1, -0.5}}, .where = {}}};
  const auto rows = io::read_probes<2>(c.form, observed(c, certify::PatchStress::rows), true, probes)[0].rows;
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].body, "box");
  EXPECT_EQ(rows[1].body, "box");
  EXPECT_EQ(rows[2].body, "box_below");
  EXPECT_EQ(rows[1].point, rows[2].point);
  EXPECT_EQ(rows[3].body, "box_below");
  EXPECT_GT(std::abs(rows[1].u[0] - rows[2].u[0]), 1e-3);
  EXPECT_NEAR(rows[1].u[1], rows[2].u[1], 1e-2);
}

TEST(Probe, OutsideTheMeshIsRefused)
{
  const mesh::Mesh<2> plane(block<2>({4, 2}));
  const mesh::Mesh<3> space(block<3>({2, 1, 1}));
  const auto message = [](const auto& mesh, const auto& x)
  {
    constexpr int dim = std::decay_t<decltype(x)>::RowsAtCompileTime;
    const std::vector<io::Probe<dim>> probes = {
        {.name = "p", .points = {Point<dim>::Constant(0.5), x}, .where = {.file = {}, .key = "probe.p"}}};
    try
    {
      io::check_probes<dim>(mesh, probes);
    }
    catch (const InputError& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(plane, Point<2>(2, 1)), "");
  EXPECT_EQ(message(plane, Point<2>(2 + 1e-11, 0.3)), "");
  EXPECT_THAT(message(plane, Point<2>(2.25, 0.3)),
              HasSubstr("(2.25, 0.3) lies outside the mesh, 0.25 from it"));
  EXPECT_THAT(message(plane, Point<2>(5, 5)), HasSubstr("5 from it"));
  EXPECT_THAT(message(space, Point<3>(1, 0.5, 1.5)), HasSubstr("0.5 from it"));
  EXPECT_THAT(message(space, Point<3>(2, 4, 5)), HasSubstr("5 from it"));
  EXPECT_THAT(message(space, Point<3>(2.3, 1.4, 0.2)), HasSubstr("probe.p"));
}

}  // namespace

}  // namespace tribound::test
