/// @file loop_test.cpp
/// The adaptive, certified loop on several ranks against the same on one: meshes, Newton steps, bounds.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ranks/same_on_ranks.h"
#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/adapt/excerpt.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/io/record/level_record.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

TEST(Loop, OfEveryDegreeIn2D)
{
  for (const int p : {1, 2, 3, 4})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    expect_same<2>(block<2>({8, 4}), pressed_block<2>(), {.degree = p}, {.max_levels = 4});
  }
}

/// Loads and gap are not polynomials, so osc, neu and C_F matter. Two materials, a bent boundary.
ProblemData<2> rough_data()
{
  ProblemData<2> data = pressed_block<2>(Coulomb(0.3));
  data.body_force[0] = formula("0.1*exp(-20*((x - 1)^2 + (y - 0.5)^2))");
  data.boundaries[1] = loaded<2>("top", 0, formula("-0.1*abs(sin(5*x))"));
  data.boundaries.back() = obstacle<2>("bottom", Coulomb(0.3), formula("0.01*abs(x - 0.7)"));
  return data;
}

TEST(Loop, OnMoreRanksThanCells)
{
  expect_same<2>(block<2>({1, 1}), pressed_block<2>(), {.degree = 2}, {.max_levels = 3});
}

TEST(Loop, WithFormulasAndOtherChoices)
{
  const mesh::MeshData<2> mesh = distorted(block<2>({8, 4}), 7);
  adapt::AdaptOptions options{.max_levels = 3};
  expect_same<2>(mesh, rough_data(), {.degree = 2}, options);
  options.marking = {.strategy = adapt::Marking::maximum, .theta = 0.5, .separate_contact = true};
  expect_same<2>(mesh, rough_data(),
                 {.degree = 1, .stopping = {.criterion = adapt::Stopping::adaptive_local}}, options);
  options.marking.strategy = adapt::Marking::uniform;
  expect_same<2>(mesh, rough_data(), {.degree = 3, .stopping = {.criterion = adapt::Stopping::tolerance}},
                 {.marking = {.strategy = adapt::Marking::uniform}, .max_levels = 1});
  expect_same<2>(mesh, rough_data(), {.degree = 2, .regularisation = adapt::RegularisationOptions()},
                 {.max_levels = 2});
}

TEST(Loop, In3D)
{
  for (const int p : {1, 2})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    ProblemData<3> data = pressed_block<3>(Coulomb(0.4));
    data.body_force[1] = formula("-0.05*sin(2*x)");
    expect_same<3>(block<3>({4, 2, 2}), data, {.degree = p}, {.max_levels = 3 - p});
  }
}

/// Multigrid differs with the number of ranks; only the limits of Newton's method agree.
TEST(Loop, WithMultigrid)
{
  for (const int p : {1, 2})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    const adapt::Method method{.degree = p,
                               .newton = {.tolerance = 1e-11},
                               .stopping = {.criterion = adapt::Stopping::last_bounded},
                               .solver = {.method = algebra::LinearMethod::iterative}};
    expect_same<3>(block<3>({8, 4, 4}), pressed_block<3>(), method, {.max_levels = 1}, Compare::solutions);
    expect_same<2>(block<2>({16, 8}), pressed_block<2>(), method, {.max_levels = 1}, Compare::solutions);
  }
}

/// Sums over cells of area, mean stress and squared components.
template <int dim>
std::vector<double> sums(const mesh::Mesh<dim>& mesh, const adapt::CertifiedLevel<dim>& level)
{
  std::vector<double> result(1 + dim * dim + certify::all_components.size(), 0.0);
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const double det = mesh::cell_map(mesh, c).det;
    result[0] += det;
    for (int entry = 0; entry < dim * dim; ++entry)
      result[1 + entry] += std::sqrt(det) * level.stress.dis_in(c)[entry * level.stress.n];
    for (std::size_t i = 0; i < certify::all_components.size(); ++i)
      result[1 + dim * dim + i] += std::pow(level.estimate.cells[c].*certify::all_components[i].value, 2);
  }
  mesh.ranks().sum(std::span(result));
  return result;
}

/// Merges cells of a level on which u is a polynomial.
template <int dim>
void expect_merged(const adapt::LevelView<dim>& view, const adapt::Method& method, std::int64_t most)
{
  const mesh::Mesh<dim>& mesh = view.discrete.mesh;
  const auto polynomial = [&](const fem::LagrangeSpace<dim>& space)
  {
    std::vector<double> u;
    for (const Point<dim>& x : space.node_points())
      for (int a = 0; a < dim; ++a) u.push_back(std::pow(0.3 * x[0] - x[1], method.degree) + a * x[dim - 1]);
    return u;
  };
  adapt::CertifiedLevel<dim> level = view.level;
  level.u = polynomial(view.discrete.space);
  level.stress.lin.clear();
  level.stress.reg.clear();
  const std::vector<double> expected = sums(mesh, level);
  const std::int64_t n_facets = mesh.ranks().sum(static_cast<std::int64_t>(mesh.n_owned_boundary()));
  const adapt::LevelView<dim> changed{view.number, view.discrete, level, view.verdict, 0, view.owner};
  const auto merged = adapt::excerpt<dim>(changed, method, most);
  ASSERT_EQ(merged.has_value(), mesh.ranks().is_first());
  if (!merged) return;
  const mesh::Mesh<dim>& shown = merged->discrete->mesh;
  EXPECT_TRUE(merged->is_merged);
  EXPECT_LE(shown.n_cells(), most);
  EXPECT_LT(most, shown.n_global_cells());
  EXPECT_EQ(std::ssize(shown.boundary()), n_facets);
  const std::vector<double> found = sums(shown, merged->level);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-12 * std::max(1.0, std::abs(expected[i]))) << i;
  const std::vector<double> u = polynomial(merged->discrete->space);
  for (std::size_t i = 0; i < u.size(); ++i) EXPECT_NEAR(merged->level.u[i], u[i], 1e-12);
}

/// When there are too many cells to show, they are merged: all are at the boundary or in larger cells.
TEST(Excerpt, OfMergedCells)
{
  const Ranks ranks = Ranks::world();
  const auto check = [&]<int dim>(const mesh::MeshData<dim>& data, int p, double share)
  {
    SCOPED_TRACE(testing::Message() << dim << "D, p = " << p);
    const adapt::Method method{.degree = p};
    auto whole = ranks.is_first() ? std::make_shared<const mesh::Mesh<dim>>(data) : nullptr;
    mesh::Mesh<dim> part = mesh::share_out<dim>(ranks, whole.get());
    const problem::Problem<dim> problem = pressed_block<dim>().on(part);
    adapt::Levels<dim> levels(problem, method, 1e-6,
                              std::make_unique<adapt::Discretisation<dim>>(std::move(part), problem, method),
                              nullptr, std::move(whole));
    ASSERT_EQ(levels.advance(), "");
    for (int level = 0; level < 2; ++level)
    {
      const auto all = [](const adapt::LevelView<dim>& view)
      {
        std::vector<Index> marked(view.discrete.mesh.n_owned_cells());
        std::iota(marked.begin(), marked.end(), 0);
        return marked;
      };
      ASSERT_EQ(levels.refine(all), "");
      ASSERT_EQ(levels.advance(), "");
    }
    const auto n = static_cast<double>(levels.discrete().mesh.n_global_cells());
    expect_merged<dim>(levels.view(), method, std::llround(share * n));
    const auto at_boundary = adapt::excerpt<dim>(levels.view(), method, 1);  // that is not enough
    EXPECT_FALSE(at_boundary && at_boundary->is_merged);
  };
  for (const int p : {1, 3}) check(block<2>({8, 4}), p, 0.6);
  check(block<3>({4, 3}, {3, 3, 3}), 2, 0.95);
}

/// An error on one rank alone is also seen at facets between ranks.
TEST(Identities, SeeFacetsBetweenRanks)
{
  const Ranks ranks = Ranks::world();
  const mesh::MeshData<2> data = block<2>({8, 4});
  const mesh::Mesh<2> whole(data);
  mesh::Mesh<2> mesh = mesh::share_out<2>(ranks, ranks.is_first() ? &whole : nullptr);
  const adapt::Method method{.degree = 2};
  const problem::Problem<2> problem = pressed_block<2>().on(mesh);
  const adapt::Discretisation<2> discrete(std::move(mesh), problem, method);
  adapt::CertifiedLevel<2> level = adapt::solve_and_certify<2>(discrete.form, {}, method);
  const auto defects = [&]
  { return certify::check_identities<2>(discrete.form, level.traction, level.stress); };
  EXPECT_LT(defects().largest(), 1e-10);
  // A constant stress: no jump inside a part.
  if (ranks.is_first())
    for (std::size_t c = 0; c < level.estimate.cells.size(); ++c)
    {
      const auto index = static_cast<Index>(c);
      const double root = std::sqrt(mesh::cell_map(discrete.mesh, index).det);
      for (const int entry : {0, 3})
        level.stress.dis[c * level.stress.block_size() + entry * level.stress.n] += 0.01 * root;
    }
  EXPECT_GT(defects().jump, 1e-3);
  EXPECT_LT(defects().divergence, 1e-10);
}

}  // namespace
}  // namespace tribound::test
