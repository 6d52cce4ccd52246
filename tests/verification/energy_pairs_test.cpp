/// @file energy_pairs_test.cpp
/// The bound of the energy-norm error of two bodies: above the distance from much richer
/// solutions, zero where the stress is constant; for tied blocks it is that of the single block.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "support/random_pair.h"
#include "support/two_blocks.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/bound/poincare_korn.h"
#include "tribound/certify/energy/load_oscillation.h"
#include "tribound/mesh/refine.h"
#include "verification/energy_effectivity.h"

namespace tribound::test
{

namespace
{

/// Vertices moved along the interface.
Point<2> skewed(const Point<2>& x)
{
  return {x[0] + 0.13 * std::sin(1.5 * x[0]) * (2 - x[0]) * (1 + 0.3 * x[1]), x[1]};
}

/// Both blocks are held at their left sides; the upper one is pressed down and pulled to the right.
template <int dim>
ProblemData<dim> two_pressed(problem::ContactLaw law)
{
  return {.boundaries = {clamped<dim>("left"), clamped<dim>("left_below"), loaded<dim>("top", 0, -0.1),
                         loaded<dim>("right", 0.04, 0.06, 0.02), clamped<dim>("bottom_below")},
          .pairs = {pair<dim>("bottom", "top_below", std::move(law))}};
}

template <int dim>
void expect_pair(const char* name, const ProblemData<dim>& data, int p, const certify::RicherSpace& richer,
                 double largest)
{
  EXPECT_EQ(expect_effectivity<dim>(name, data, matching_blocks<dim>(), p, richer, largest).target,
            certify::EnergyTarget::solution);
}

class EnergyPairs : public ::testing::TestWithParam<int>
{
};

TEST_P(EnergyPairs, IsABound)
{
  const int p = GetParam();
  const certify::RicherSpace in_2d{.refinements = 3, .degree = p + 1};
  const certify::RicherSpace in_3d{.refinements = p > 2 ? 1 : 2, .degree = p + 1};
  const std::array laws = {std::pair("tied", problem::ContactLaw(problem::Tied())),
                           std::pair("frictionless", problem::ContactLaw(problem::Frictionless())),
                           std::pair("Tresca", problem::ContactLaw(Tresca(0.03)))};
  for (const auto& [name, law] : laws)
  {
    expect_pair<2>(name, two_pressed<2>(law), p, in_2d, 1.6);
    if (p <= 2) expect_pair<3>(name, two_pressed<3>(law), p, in_3d, 2.5);
  }
}

TEST_P(EnergyPairs, AGapMayBeGivenAndClose)
{
  ProblemData<2> data = two_pressed<2>(problem::Frictionless());
  data.pairs[0].contact.gap = formula("0.01*x");
  expect_pair<2>("gap", data, GetParam(), {.refinements = 3, .degree = GetParam() + 1}, 1.7);
}

/// The upper block lies on the lower one, which is clamped or lies on a floor itself.
template <int dim>
ProblemData<dim> resting(problem::ContactLaw law, bool on_floor, double pull = 0.01)
{
  const bool slides = std::holds_alternative<Frictionless>(law);
  ProblemData<dim> data{
      .boundaries = {loaded<dim>("top", pull, formula("-0.1 - 0.03*x"), 0.01),
                     on_floor ? obstacle<dim>("bottom_below", Tresca(0.04)) : clamped<dim>("bottom_below")},
      .pairs = {pair<dim>("bottom", "top_below", std::move(law))}};
  if (slides) data.boundaries.push_back(fixed<dim>("left", 0.0, free, free));
  if (slides && dim == 3) data.boundaries.push_back(fixed<dim>("back", free, free, 0.0));
  return data;
}

TEST_P(EnergyPairs, ContactMayBeAllThatHoldsABody)
{
  const int p = GetParam();
  const certify::RicherSpace in_2d{.refinements = 3, .degree = p + 1};
  const certify::RicherSpace in_3d{.refinements = p > 2 ? 1 : 2, .degree = p + 1};
  for (const bool on_floor : {false, true})
    for (const auto& [name, law] :
         {std::pair("on another, frictionless", problem::ContactLaw(Frictionless())),
          std::pair("on another, Tresca", problem::ContactLaw(Tresca(0.06)))})
    {
      expect_pair<2>(name, resting<2>(law, on_floor), p, in_2d, 1.8);
      if (p <= 2 && on_floor) expect_pair<3>(name, resting<3>(law, on_floor), p, in_3d, 2.5);
    }
}

/// Loads that friction cannot hold, between the blocks or on the floor.
TEST(EnergyPairs, NoTractionHoldsTheBody)
{
  const auto reason = [](const problem::ContactLaw& law, bool on_floor, double pull)
  {
    const DiscreteProblem<2> c(matching_blocks<2>(), resting<2>(law, on_floor, pull), {.degree = 2});
    return energy_bound(c, std::vector<double>(c.space.n_dofs(), 0.0)).reason;
  };
  const std::string nothing = "no contact traction was found that obeys the law and holds a body";
  EXPECT_EQ(reason(Tresca(0.03), true, 0.027), "");
  EXPECT_EQ(reason(Tresca(0.03), true, 0.033), nothing);
  EXPECT_EQ(reason(Tresca(0.06), false, 0.05), "");
  EXPECT_EQ(reason(Tresca(0.06), true, 0.05), nothing);  // slides on the floor
}

/// Uniform pressure between frictionless sides.
TEST(EnergyPairs, IsNothingWhereTheStressIsConstant)
{
  ProblemData<2> data = two_pressed<2>(problem::Frictionless());
  data.boundaries = {fixed<2>("left", 0.0, {}), fixed<2>("left_below", 0.0, {}),
                     fixed<2>("bottom_below", {}, 0.0), fixed<2>("top", {}, -0.05)};
  for (const int p : {1, 2, 3})
  {
    const DiscreteProblem<2> c(matching_blocks<2>(), data, {.degree = p, .newton = {.tolerance = 1e-13}});
    const certify::EnergyBound eta = energy_bound(c, c.solve().u);
    ASSERT_EQ(eta.reason, "");
    EXPECT_LE(eta.bound, 1e-7) << p;
  }
}

/// What is known of touching bodies does not hold with a gap between them, given or from the meshes.
TEST(EnergyPairs, TheIntervalOfTheEnergyHoldsWithAGap)
{
  for (const char* const gap : {"0", "0.02*x", ""})
  {
    ProblemData<2> data = two_pressed<2>(Tresca(0.03));
    data.pairs[0].contact.gap.reset();
    if (*gap != '\0') data.pairs[0].contact.gap = formula(gap);
    const auto meshes = [&](int finer)
    {
      mesh::MeshData<2> blocks = matching_blocks<2>(finer);
      if (*gap != '\0') return blocks;
      for (std::size_t v = blocks.vertices.size() / 2; v < blocks.vertices.size(); ++v)
        blocks.vertices[v] -= Point<2>(0, 0.01 * (1 + blocks.vertices[v][1]));
      return blocks;
    };
    const DiscreteProblem<2> c(meshes(1), data, {.degree = 2, .newton = {.tolerance = 1e-12}});
    const DiscreteProblem<2> rich(meshes(4), data, {.degree = 3, .newton = {.tolerance = 1e-11}});
    const double truth = contact::stress_norms<2>(rich.problem, rich.space, rich.solve().u).energy;
    const std::vector<problem::Quantity<2>> energy = {{.name = "energy"}};
    const auto found = certify::EnergyEstimator<2>(c.form, {}, energy)(c.solve().u).quantities.front();
    ASSERT_EQ(found.reason, "") << gap;
    fmt::print("gap {}: {:.8f} in [{:.8f}, {:.8f}], {}\n", gap, truth, found.lower, found.upper, found.basis);
    EXPECT_LE(found.lower, truth) << gap;
    EXPECT_GE(found.upper, truth) << gap;
    EXPECT_EQ(found.basis, std::string(gap) == "0" ? "duality gap" : "energy bound");
  }
}

/// Non-matching meshes are cut until they match.
TEST_P(EnergyPairs, InTwoDimensionsMeshesNeedNotMatch)
{
  const int p = GetParam();
  const problem::ContactLaw tied = problem::Tied();
  for (const auto& [name, data] : {std::pair("not matching, tied", two_pressed<2>(tied)),
                                   {"not matching, frictionless", two_pressed<2>(Frictionless())},
                                   {"not matching, Tresca", two_pressed<2>(Tresca(0.03))},
                                   {"not matching, resting", resting<2>(Tresca(0.06), true)}})
    for (const bool is_irregular : {false, true})
    {
      mesh::MeshData<2> mesh = two_blocks<2>();
      if (is_irregular) mesh = renumbered(mapped<2>(std::move(mesh), skewed), 5);
      const DiscreteProblem<2> c(std::move(mesh::refine_uniformly(mesh::Mesh<2>(std::move(mesh)), 1).mesh),
                                 data, {.degree = p, .newton = {.tolerance = 1e-12}});
      const std::vector<double> u = c.solve().u;
      const certify::EnergyBound eta = adapt::energy_bound<2>(c.form, c.method, u);
      ASSERT_EQ(static_cast<Index>(eta.cells.size()), c.mesh.n_cells()) << eta.reason;
      const double found = effectivity<2>(RicherReference<2>(c, {.refinements = 2, .degree = p + 1}), u, eta);
      fmt::print("{:<26} p = {}: {:.3f}; bound {:.3e}, ||c|| {:.1e}, G_c {:.1e}\n", name, p, found, eta.bound,
                 eta.correction, eta.contact);
      EXPECT_GE(found, 1) << name << p;
      EXPECT_LE(found, p == 1 ? 2 : 1.6) << name << p;
    }
}

/// The vertices of one body lie beside those of the other by 1e-2 to 1e-8 of a facet: cells cut between them
/// would be too flat.
template <int dim>
DiscreteProblem<dim> almost_matching(unsigned seed)
{
  std::mt19937 random(seed);
  const auto between = [&](double low, double high)
  { return std::uniform_real_distribution<double>(low, high)(random); };
  const double aside = std::pow(10, between(-8, -2));
  const bool is_shifted = seed % 3 == 0;  // as a whole
  mesh::MeshData<dim> mesh = matching_blocks<dim>(dim == 2 ? 2 : 1);
  for (std::size_t v = mesh.vertices.size() / 2; v < mesh.vertices.size(); ++v)
    for (int a = 0; a < dim; a += 2) mesh.vertices[v][a] += is_shifted ? aside : aside * between(-1, 1);
  const problem::ContactLaw law =
      seed % 2 == 0 ? problem::ContactLaw(Frictionless()) : problem::ContactLaw(Tresca(between(0.001, 0.1)));
  return {std::move(mesh),
          two_pressed<dim>(law),
          {.degree = 1 + static_cast<int>(seed % (dim == 2 ? 3 : 2)), .newton = {.tolerance = 1e-12}}};
}

template <int dim>
void expect_bound_where_facets_almost_match(unsigned seed)
{
  const DiscreteProblem<dim> c = almost_matching<dim>(seed);
  const std::vector<double> u = c.solve().u;
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u);
  const certify::RicherSpace richer{.refinements = dim == 2 ? 2 : 1, .degree = c.space.degree() + 1};
  const double found = effectivity<dim>(RicherReference<dim>(c, richer), u, bound);
  fmt::print("{}D, seed {}, p = {}: {:.3f}\n", dim, seed, c.space.degree(), found);
  EXPECT_GE(found, 1) << seed << ": " << bound.reason;
  EXPECT_LE(found, dim == 2 ? 2.5 : 4) << seed;
}

TEST(EnergyPairs, FacetsMayAlmostMatch)
{
  for (unsigned seed = 0; seed < n_cases(14); ++seed) expect_bound_where_facets_almost_match<2>(seed);
  for (unsigned seed = 0; seed < n_cases(4); ++seed) expect_bound_where_facets_almost_match<3>(seed);
  // Facets that match beside others that do not: repeated corrections closed gaps again.
  expect_bound_where_facets_almost_match<3>(16);
}

/// Neither in three; only tied bodies need it.
TEST_P(EnergyPairs, InThreeDimensionsMeshesNeedNotMatch)
{
  const int p = GetParam();
  if (p > 2) return;
  const certify::RicherSpace richer{.refinements = p == 1 ? 2 : 1, .degree = p + 1};
  for (const auto& [name, data] : {std::pair("not matching, frictionless", two_pressed<3>(Frictionless())),
                                   {"not matching, Tresca", two_pressed<3>(Tresca(0.03))},
                                   {"not matching, resting", resting<3>(Tresca(0.06), true)}})
    EXPECT_GT(expect_effectivity<3>(name, data, two_blocks<3>(p), p, richer, 3).transfer, 0);
}

/// A constant traction from a cube on half of another one of twice its width, p = 1: on each of the two
/// facets below, what is lost is 1 on the covered part less its projection on P^1, from areas and centroids
/// of the triangles into which x = 1 and halving cut them.
TEST(EnergyPairs, WhatIsLostCountsWithTheConstantOfItsCell)
{
  const DiscreteProblem<3> c(on_block<3>(box<3>({0, 0, 0}, {1, 1, 1}, {2, 1, 3}), {1, 1, 1}),
                             two_pressed<3>(Frictionless()), {.degree = 1});
  const std::vector<Point<3>> t(c.form.n_contact_points(), Point<3>(0.3, -2, 0.1));
  const std::vector<double> found =
      certify::transfer_oscillation<3>(c.form, {c.form, certify::ContactRule::resolved}, t);
  const int below = problem::group_number("top_below", c.mesh.boundary_names(), {}, "boundary");
  std::vector<double> expected(found.size(), 0.0);
  for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
  {
    if (facet.tag != below) continue;
    const std::array<Index, 3> vertices = mesh::facet_vertices(c.mesh.cell(facet.cell), facet.local);
    Eigen::Matrix3d corners;  // (x, z, 1) of each
    for (int i = 0; i < 3; ++i)
      corners.col(i) = Eigen::Vector3d(c.mesh.vertex(vertices[i])[0], c.mesh.vertex(vertices[i])[2], 1);
    double covered = 0;
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();  // of barycentric coordinates
    for (int i = 0; i < 4; ++i)                         // the corner triangles of halving, then the middle
    {
      Eigen::Vector3d centroid = Eigen::Vector3d::Constant(i < 3 ? 1.0 / 6 : 1.0 / 3);
      if (i < 3) centroid[i] = 2.0 / 3;
      if ((corners * centroid)[0] > 1) continue;
      covered += 0.25;
      moments += 0.25 * centroid;
    }
    const Eigen::Matrix3d gram =
        (Eigen::Matrix3d::Identity() + Eigen::Matrix3d::Ones()) / 12;  // as shares of the area, which is 1
    const double loss = t[0].norm() * std::sqrt(covered - moments.dot(gram.inverse() * moments));
    const certify::PoincareKorn<3> constants =
        certify::poincare_korn<3>(mesh::points_of(c.mesh.vertices(), c.mesh.cell(facet.cell)));
    expected[facet.cell] = constants.facets[facet.local] * loss / std::sqrt(2 * lame(1, 0.3).mu);
    EXPECT_GT(loss, 0.1);
  }
  for (std::size_t cell = 0; cell < found.size(); ++cell) EXPECT_NEAR(found[cell], expected[cell], 1e-9);
}

TEST(EnergyPairs, TiedBodiesHaveToMatchInThreeDimensions)
{
  const DiscreteProblem<3> c(two_blocks<3>(), two_pressed<3>(problem::Tied()), {.degree = 1});
  const std::vector<double> none(c.space.n_dofs(), 0.0);
  EXPECT_EQ(adapt::energy_bound<3>(c.form, c.method, none).reason, "meshes of tied bodies do not match");
}

/// Two blocks tied side by side, one mesh cut open, lie on a third one with another mesh.
TEST(EnergyPairs, TiedBodiesMayLieOnAnotherMesh)
{
  for (const int p : {1, 2})
  {
    ProblemData<3> data = two_pressed<3>(Tresca(0.03));
    data.boundaries = {clamped<3>("left"), clamped<3>("bottom_below"), loaded<3>("top", 0, -0.1),
                       loaded<3>("right_b", 0.04, 0.06, 0.02)};
    data.pairs[0].slave.emplace_back("bottom_b");
    data.pairs.push_back(pair<3>("right", "left_b", problem::Tied()));
    EXPECT_GT(expect_effectivity<3>("tied on another mesh", data, three_blocks_on_another_mesh(), p,
                                    {.refinements = 1, .degree = p + 1}, 3)
                  .transfer,
              0);
  }
}

/// Meshes, materials, gaps and loads at random; a Coulomb bound is for another problem than the reference.
template <int dim>
DiscreteProblem<dim> random_pair(unsigned seed)
{
  RandomPair<dim> random(seed);
  auto [mesh, data] = random.make();
  problem::ContactLaw& law = data.pairs[0].contact.law;
  const problem::FrictionCone cone = problem::cone(law);
  if (cone.is_tied) law = Frictionless();
  if (cone.coefficient > 0) law = Tresca(0.1 * cone.coefficient);
  return DiscreteProblem<dim>(
      std::move(mesh), std::move(data),
      {.degree = 1 + static_cast<int>(seed % 4 == 0), .newton = {.tolerance = 1e-11}});
}

TEST(EnergyPairs, NoBoundOfRandomPairsFails)
{
  expect_no_failure<2>("pairs, 2D", 60, random_pair<2>);
  expect_no_failure<3>("pairs, 3D", 30, random_pair<3>, 1);
}

INSTANTIATE_TEST_SUITE_P(Degrees, EnergyPairs, ::testing::Range(1, 4));

}  // namespace

}  // namespace tribound::test
