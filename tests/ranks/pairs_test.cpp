/// @file pairs_test.cpp
/// Bodies in contact, on several ranks against one: adaptive loops, random pairs, joints.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "ranks/hidden_wall.h"
#include "ranks/same_on_ranks.h"
#include "support/problem_data.h"
#include "support/random_pair.h"
#include "support/two_blocks.h"
#include "tribound/adapt/excerpt.h"
#include "tribound/mesh/bodies.h"

namespace tribound::test
{
namespace
{

template <int dim>
ProblemData<dim> pushed(problem::ContactLaw law, double stiffness)
{
  return {.boundaries = {clamped<dim>("bottom_below"), clamped<dim>("left"), loaded<dim>("top", 0, -0.1),
                         loaded<dim>("right", 0.04, 0.06, 0.02)},
          .regions = {{.name = "box_below", .material = lame(stiffness, 0.25)}},
          .pairs = {pair<dim>("bottom", "top_below", std::move(law))}};
}

TEST(Pairs, OfEveryDegreeAndLawIn2D)
{
  const std::array<problem::ContactLaw, 4> laws = {Frictionless(), Tresca(0.03), Coulomb(0.3), Tied()};
  for (const int p : {1, 2, 3, 4})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    expect_same<2>(two_blocks<2>(), pushed<2>(laws[p - 1], p == 2 ? 100.0 : 2.0), {.degree = p},
                   {.max_levels = 3});
  }
}

/// Matching meshes stay matching, whichever rank has the other side.
TEST(Pairs, OnMeshesThatMatch)
{
  expect_same<2>(matching_blocks<2>(), pushed<2>(Tresca(0.03), 2), {.degree = 2}, {.max_levels = 5});
  expect_same<3>(matching_blocks<3>(), pushed<3>(Frictionless(), 3), {.degree = 1}, {.max_levels = 3});
}

TEST(Pairs, In3D)
{
  for (const int p : {1, 2})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    expect_same<3>(two_blocks<3>(), pushed<3>(Coulomb(0.4), 3), {.degree = p}, {.max_levels = 3 - p});
  }
}

TEST(Pairs, Random)
{
  for (const unsigned seed : {1U, 2U, 5U, 8U})
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [data, problem] = RandomPair<2>(seed).make();
    expect_same<2>(data, problem, {.degree = 2}, {.max_levels = 1});
  }
  for (const unsigned seed : {3U, 4U})
  {
    SCOPED_TRACE("3D, seed " + std::to_string(seed));
    const auto [data, problem] = RandomPair<3>(seed).make();
    expect_same<3>(data, problem, {.degree = 1}, {.max_levels = 1});
  }
}

TEST(Pairs, HiddenInPart)
{
  auto [data, problem] = hidden_wall<2>();
  expect_same<2>(data, problem, {.degree = 2}, {.max_levels = 1});
  problem.pairs[0].pairing = {.direction = Point<2>(0.1, -1), .reach = 0.9};  // nothing of the wall is left
  expect_same<2>(data, problem, {.degree = 2}, {.max_levels = 1});
  const auto [data_3d, problem_3d] = hidden_wall<3>();
  expect_same<3>(data_3d, problem_3d, {.degree = 1}, {.max_levels = 1});
}

TEST(Pairs, NeedTheirPartners)
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<2> whole(two_blocks<2>());
  const mesh::Mesh<2> part = mesh::share_out<2>(ranks, ranks.is_first() ? &whole : nullptr);
  const problem::Problem<2> problem = pushed<2>(Frictionless(), 1).on(part);
  EXPECT_THROW((void)contact::contact_segments<2>(problem, part, 10), InputError);
}

TEST(Pairs, RegularisedAndWithMultigrid)
{
  expect_same<2>(two_blocks<2>(), pushed<2>(Coulomb(0.3), 2),
                 {.degree = 2, .regularisation = adapt::RegularisationOptions()}, {.max_levels = 1});
  const adapt::Method method{.degree = 1,
                             .newton = {.tolerance = 1e-11},
                             .stopping = {.criterion = adapt::Stopping::last_bounded},
                             .solver = {.method = algebra::LinearMethod::iterative}};
  expect_same<3>(two_blocks<3>(), pushed<3>(Coulomb(0.3), 50), method, {.max_levels = 2}, Compare::solutions);
}

/// Cells at the boundary alone are barely connected; an excerpt of them still knows their bodies.
TEST(Pairs, ExcerptsKnowTheBodies)
{
  const Ranks ranks = Ranks::world();
  const mesh::MeshData<3> data = renumbered(two_blocks<3>(), 4);
  const adapt::Method method{.degree = 1};
  auto whole = ranks.is_first() ? std::make_shared<const mesh::Mesh<3>>(data) : nullptr;
  mesh::Mesh<3> part = mesh::share_out<3>(ranks, whole.get());
  const problem::Problem<3> problem = pushed<3>(Coulomb(0.3), 2).on(part);
  adapt::Levels<3> levels(problem, method, 1e-6,
                          std::make_unique<adapt::Discretisation<3>>(std::move(part), problem, method),
                          nullptr, std::move(whole));
  ASSERT_EQ(levels.advance(), "");
  const auto shown = adapt::boundary_excerpt<3>(levels.view(), method);
  ASSERT_EQ(shown.has_value(), ranks.is_first());
  if (!shown) return;
  const mesh::Mesh<3>& mesh = shown->discrete->mesh;
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  EXPECT_EQ(bodies.n, 2);
  std::array<int, 2> of_region{-1, -1};
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    int& body = of_region[mesh.region(c)];
    if (body < 0) body = bodies.of_cell[c];
    EXPECT_EQ(bodies.of_cell[c], body);
  }
  EXPECT_NE(of_region[0], of_region[1]);
}

}  // namespace
}  // namespace tribound::test
