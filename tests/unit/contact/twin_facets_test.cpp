/// @file twin_facets_test.cpp
/// Matching facets of two bodies, which still match after bisection of some cells on either side.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/dimensions.h"
#include "support/problem_data.h"
#include "support/two_blocks.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

/// Two blocks with a gap between them, numbered at random, and facets of different sizes.
template <int dim>
mesh::Mesh<dim> blocks_with_a_gap(unsigned seed)
{
  mesh::MeshData<dim> data = matching_blocks<dim>(2);
  for (std::size_t v = data.vertices.size() / 2; v < data.vertices.size(); ++v) data.vertices[v][1] -= 0.1;
  const auto stretch = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    y[0] += 0.1 * std::sin(2 * x[0]) + 0.05 * x[dim - 1] * (dim - 2);
    return y;
  };
  return mesh::Mesh<dim>(renumbered(mapped(std::move(data), stretch), seed));
}

template <int dim>
std::vector<contact::ContactSegment<dim>> segments(const problem::Problem<dim>& problem,
                                                   const mesh::Mesh<dim>& mesh)
{
  return contact::contact_segments<dim>(problem, mesh, 10);
}

/// Checks that corners lie opposite each other.
template <int dim>
void expect_opposite(const mesh::Mesh<dim>& mesh, const mesh::TwinFacets<dim>& twins)
{
  for (int i = 0; i < dim; ++i)
  {
    Point<dim> across = mesh.vertex(twins.vertices[0][i]) - mesh.vertex(twins.vertices[1][i]);
    across[1] = 0;
    EXPECT_LE(across.norm(), 1e-12);
  }
}

template <class T>
class TwinFacets : public ::testing::Test
{
};
TYPED_TEST_SUITE(TwinFacets, Dimensions);

TYPED_TEST(TwinFacets, StaySuch)
{
  constexpr int dim = TypeParam::value;
  const ProblemData<dim> data{.boundaries = {clamped<dim>("bottom_below"), clamped<dim>("top")},
                              .pairs = {pair<dim>("bottom", "top_below", Frictionless())}};
  for (const bool are_kept : {true, false})
  {
    std::mt19937 random(3);
    mesh::Mesh<dim> mesh = blocks_with_a_gap<dim>(7);
    std::size_t n_facets = 0;
    bool match = true;
    for (int round = 0; round < (dim == 2 ? 12 : 9); ++round)
    {
      const problem::Problem<dim> problem = data.on(mesh);
      const auto parts = segments<dim>(problem, mesh);
      const std::vector<mesh::TwinFacets<dim>> twins = contact::twin_facets<dim>(mesh, parts);
      match = match && twins.size() == parts.size();
      n_facets = parts.size();
      if (are_kept)
      {
        ASSERT_EQ(twins.size(), parts.size()) << round;
        for (const mesh::TwinFacets<dim>& pair : twins) expect_opposite(mesh, pair);
      }
      std::bernoulli_distribution chosen(dim == 2 ? 0.1 : 0.05);
      std::vector<Index> marked;
      for (Index c = 0; c < mesh.n_cells(); ++c)
        if (chosen(random)) marked.push_back(c);
      mesh = mesh::bisect<dim>(mesh, marked, round % 2 == 0 ? 1 : dim,
                               are_kept ? std::span(twins) : std::span<const mesh::TwinFacets<dim>>())
                 .mesh;
    }
    EXPECT_GT(n_facets, dim == 2 ? 20 : 100);
    EXPECT_EQ(match, are_kept);
  }
}

/// Cells far from those halved on the other side stay unchanged.
TYPED_TEST(TwinFacets, AreHalvedNoFurtherThanTheyMust)
{
  constexpr int dim = TypeParam::value;
  const ProblemData<dim> data{.boundaries = {clamped<dim>("bottom_below"), clamped<dim>("top")},
                              .pairs = {pair<dim>("bottom", "top_below", Frictionless())}};
  const mesh::Mesh<dim> mesh(matching_blocks<dim>(4));
  const problem::Problem<dim> problem = data.on(mesh);
  const auto twins = contact::twin_facets<dim>(mesh, segments<dim>(problem, mesh));
  const std::vector<Index> far{static_cast<Index>(
      std::ranges::max_element(mesh.cells(), {},
                               [&](const mesh::Cell<dim>& cell) { return mesh.vertex(cell[0])[1]; }) -
      mesh.cells().begin())};
  const std::vector<Index> near{twins[twins.size() / 2].cells[0]};
  const auto n_cells = [&](const std::vector<Index>& marked, bool are_kept)
  {
    return mesh::bisect<dim>(mesh, marked, dim,
                             are_kept ? std::span(twins) : std::span<const mesh::TwinFacets<dim>>())
        .mesh.n_cells();
  };
  EXPECT_EQ(n_cells(far, true), n_cells(far, false));
  const Index added = n_cells(near, false) - mesh.n_cells();
  EXPECT_GT(n_cells(near, true) - mesh.n_cells(), added);
  EXPECT_LE(n_cells(near, true) - mesh.n_cells(), 3 * added);
}

}  // namespace

}  // namespace tribound::test
