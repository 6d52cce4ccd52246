/// @file cut_facets_test.cpp
/// Cells cut into fans: the domain, boundaries and regions stay, with vertices where they are wanted.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "support/meshes.h"
#include "tribound/mesh/cut_facets.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

/// Up to three cuts on every other boundary facet; corner cells have two.
std::vector<mesh::FacetCuts> random_cuts(const mesh::Mesh<2>& mesh, std::mt19937& random)
{
  std::vector<mesh::FacetCuts> cuts;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    std::vector<double> at(random() % 4);
    for (double& x : at) x = std::uniform_real_distribution<double>(0.01, 0.99)(random);
    std::ranges::sort(at);
    if (!at.empty()) cuts.push_back({facet.cell, facet.local, std::move(at)});
  }
  std::ranges::shuffle(cuts, random);
  return cuts;
}

std::map<int, double> lengths(const mesh::Mesh<2>& mesh)
{
  std::map<int, double> result;
  for (const auto& [cell, local, tag] : mesh.boundary())
    result[tag] += mesh::facet_geometry(mesh, cell, local).measure;
  return result;
}

TEST(CutFacets, CutNothingElse)
{
  std::mt19937 random(3);
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const mesh::Mesh<2> mesh(distorted(block<2>({3, 2}), seed));
    const std::vector<mesh::FacetCuts> cuts = random_cuts(mesh, random);
    std::size_t n = 0;
    std::vector<double> areas(mesh.n_cells(), 0.0);
    const mesh::Bisected<2> cut = mesh::cut_facets(mesh, cuts);
    for (const mesh::FacetCuts& facet : cuts)
    {
      const auto [first, last] = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
      for (const double at : facet.at)
      {
        const Point<2> x = (1 - at) * mesh.vertex(first) + at * mesh.vertex(last);
        const auto is_there = [&](const Point<2>& y) { return (x - y).norm() <= 1e-14; };
        EXPECT_EQ(std::ranges::count_if(cut.mesh.vertices(), is_there), 1);
        ++n;
      }
    }
    EXPECT_EQ(cut.mesh.n_vertices(), mesh.n_vertices() + static_cast<Index>(n));
    EXPECT_EQ(cut.mesh.n_cells(), mesh.n_cells() + static_cast<Index>(n));
    for (Index c = 0; c < cut.mesh.n_cells(); ++c)
    {
      areas[cut.parent[c]] += mesh::cell_map(cut.mesh, c).det / 2;
      EXPECT_EQ(cut.mesh.region(c), mesh.region(cut.parent[c]));
    }
    for (Index c = 0; c < mesh.n_cells(); ++c) EXPECT_NEAR(areas[c], mesh::cell_map(mesh, c).det / 2, 1e-14);
    const std::map<int, double> before = lengths(mesh);
    const std::map<int, double> after = lengths(cut.mesh);
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [tag, length] : before) EXPECT_NEAR(after.at(tag), length, 1e-13);
    // the mesh can be bisected
    const std::vector<Index> first = {0, cut.mesh.n_cells() - 1};
    EXPECT_GT(mesh::bisect<2>(cut.mesh, first).mesh.n_cells(), cut.mesh.n_cells());
  }
}

}  // namespace

}  // namespace tribound::test
