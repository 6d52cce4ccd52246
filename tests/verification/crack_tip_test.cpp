/// @file crack_tip_test.cpp
/// How far the crack that carries the water pressure has advanced.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/bonded_path.h"
#include "support/meshes.h"
#include "tribound/contact/nitsche/crack_tip.h"

namespace tribound::test
{
namespace
{

/// The tip if points are open and broken where `cracked` says; 1 is the middle of the block (0, 2) x ...
template <int dim, class Cracked>
contact::CrackTip tip_where(const Cracked& cracked)
{
  const mesh::Mesh<dim> mesh(block<dim>({8, 2}, {4, 2, 2}));
  ProblemData<dim> data{.boundaries = {clamped<dim>("top"), obstacle<dim>("bottom")}};
  problem::BaseLine line{std::vector<double>(dim, 0.0), std::vector<double>(dim, 0.0)};
  line.toe[0] = 2;
  data.boundaries.back().contact->base = line;
  const problem::Problem<dim> problem = data.on(mesh);
  const fem::LagrangeSpace<dim> space(mesh, 1);
  const contact::NitscheForm<dim> form(problem, space, 10);
  std::vector<problem::InterfaceResponse<dim>> responses;
  for (const contact::ContactPoint<dim>& point : form.contact_points())
  {
    problem::InterfaceResponse<dim>& response = responses.emplace_back();
    response.state.damage = cracked(point.x[0]) ? 1 : 0.9;
    response.opening = 1e-3;
  }
  return contact::crack_tips<dim>(form, responses).at(0);
}

template <int dim>
void expect_connected_with_the_heel()
{
  const auto tip = [](const auto& cracked) { return tip_where<dim>(cracked); };
  EXPECT_NEAR(tip([](double x) { return x < 1; }).distance, 1, 1e-14);
  const contact::CrackTip with_island = tip([](double x) { return x < 1 || x > 1.5; });
  EXPECT_NEAR(with_island.distance, 1, 1e-14);
  EXPECT_NEAR(with_island.farthest, 1, 1e-14);
  EXPECT_EQ(tip([](double x) { return x > 0.5; }).distance, 0);
  EXPECT_EQ(tip([](double) { return false; }).distance, 0);
  EXPECT_NEAR(tip([](double) { return true; }).distance, 2, 1e-14);
}

TEST(CrackTip, IsConnectedWithTheHeel)
{
  expect_connected_with_the_heel<2>();
  expect_connected_with_the_heel<3>();
}

/// On the paths that test the bound and several ranks, cracks do carry pressure.
template <int dim>
void expect_crack(bool pairs)
{
  mesh::Mesh<dim> mesh(peeled_mesh<dim>(pairs));
  const problem::Problem<dim> problem = peeled_under_water<dim>(bonded_laws()[0], pairs).on(mesh);
  adapt::Method method{.degree = 1};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  adapt::LoadPath<dim> path(problem, method, {}, std::move(mesh));
  double tip = 0;
  int passes = 1;
  const auto check = [&](const adapt::LoadStep<dim>& step)
  {
    EXPECT_GE(step.crack_tips.at(0).distance, tip);
    tip = step.crack_tips.at(0).distance;
    passes = std::max(passes, step.passes);
  };
  for (const double t : path_of_t) ASSERT_EQ(path.advance(t, check), "");
  EXPECT_GT(tip, 0);
  EXPECT_LE(tip, 2);
  EXPECT_GT(passes, 1);
}

TEST(CrackTip, MovesInASolution)
{
  for (const bool pairs : {false, true})
  {
    expect_crack<2>(pairs);
    expect_crack<3>(pairs);
  }
}

}  // namespace
}  // namespace tribound::test
