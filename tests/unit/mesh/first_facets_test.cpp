/// @file first_facets_test.cpp
/// The facets of the first mesh, and the position of later facets in them.

#include "tribound/mesh/first_facets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/cut_facets.h"
#include "tribound/mesh/first_facet_finder.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/refine.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{

namespace
{

/// Every boundary facet lies in a facet of the first mesh, of the same group. Facets of the first mesh lie in
/// themselves.
template <int dim>
void expect_found(const mesh::Mesh<dim>& mesh, const mesh::FirstFacets& first)
{
  const mesh::FirstFacetFinder<dim> find(first, [](int) { return true; });
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    const auto vertices =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
    const auto [number, barycentric] = find(facet.tag, vertices);
    EXPECT_EQ(first.tags[number], facet.tag);
    for (int j = 0; j < dim; ++j)
    {
      Point<dim> x = Point<dim>::Zero();
      double sum = 0;
      for (int i = 0; i < dim; ++i)
      {
        EXPECT_GE(barycentric[j][i], 0);
        x += barycentric[j][i] * first.point<dim>(first.vertices_of<dim>(number)[i]);
        sum += barycentric[j][i];
      }
      EXPECT_NEAR(sum, 1, 1e-15);
      EXPECT_NEAR((x - vertices[j]).norm(), 0, 1e-13);
    }
  }
}

template <class Dimension>
class FirstFacets : public ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FirstFacets, Dimensions);

TYPED_TEST(FirstFacets, ContainThoseOfAllFinerMeshes)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(distorted(block<dim>({3, 2}, {2, 3, 2}), 5));
  const mesh::FirstFacets& first = mesh.labels().quadratic_facets->first;
  EXPECT_EQ(first.tags.size(), mesh.boundary().size());
  expect_found<dim>(mesh, first);
  const mesh::Mesh<dim> uniform = mesh::refine_uniformly(mesh, 2).mesh;
  const mesh::Mesh<dim> bisected = mesh::bisect<dim>(uniform, std::vector<Index>{0, 5, 7}, 5).mesh;
  EXPECT_EQ(bisected.labels().quadratic_facets, mesh.labels().quadratic_facets);
  expect_found<dim>(bisected, first);
  const mesh::Mesh<dim> restored =
      mesh::restore<dim>(Ranks(), &mesh, mesh::first_records(bisected, 0, bisected.n_cells()), {}, 0).mesh;
  EXPECT_EQ(restored.labels().quadratic_facets->first.vertices, first.vertices);
  expect_found<dim>(restored, restored.labels().quadratic_facets->first);
  if constexpr (dim == 2)
  {
    const mesh::BoundaryFacet& facet = bisected.boundary().front();
    const std::vector<mesh::FacetCuts> cuts{{facet.cell, facet.local, {0.123, 0.71}}};
    const mesh::Mesh<2> cut = mesh::cut_facets(bisected, cuts).mesh;
    EXPECT_EQ(cut.labels().quadratic_facets, mesh.labels().quadratic_facets);
    expect_found<2>(cut, first);
  }
}

TYPED_TEST(FirstFacets, VerticesOfZeroAndOneAreExact)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(distorted(block<dim>({3, 2}, {2, 3, 2}), 6));
  const mesh::FirstFacets& first = mesh.labels().quadratic_facets->first;
  const mesh::FirstFacetFinder<dim> find(first, [](int) { return true; });
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    const auto vertices =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
    for (const auto& lambda : find(facet.tag, vertices).barycentric)
    {
      EXPECT_EQ(std::ranges::count(lambda, 1.0), 1);
      EXPECT_EQ(std::ranges::count(lambda, 0.0), dim - 1);
    }
  }
}

/// Two bodies that touch have facets of their own.
TYPED_TEST(FirstFacets, OfBoxesByFormulaAreThoseOfTheirMesh)
{
  constexpr int dim = TypeParam::value;
  const auto box = [](double height)
  {
    return dim == 2 ? mesh::BoxMesh{.lower = {0, height}, .upper = {2, height + 1}, .cells = {3, 2}}
                    : mesh::BoxMesh{.lower = {0, height, 0}, .upper = {2, height + 1, 1}, .cells = {3, 2, 2}};
  };
  const mesh::Boxes boxes = {{"below", box(0)}, {"above", box(1)}};
  mesh::MeshData<dim> data = mesh::box_meshes<dim>(boxes);
  data.interfaces.push_back({{{{"below.top"}, {"above.bottom"}}}});
  const mesh::Mesh<dim> mesh(std::move(data));
  const mesh::FirstFacets& expected = mesh.labels().quadratic_facets->first;
  const mesh::FirstFacets found = mesh::box_facets<dim>(Ranks(), boxes)->first;
  EXPECT_EQ(found.points.size(), expected.points.size());
  const auto described = [](const mesh::FirstFacets& facets)
  {
    std::vector<std::vector<double>> all;
    for (std::size_t f = 0; f < facets.tags.size(); ++f)
    {
      std::vector<std::vector<double>> points;
      for (const Index v : facets.vertices_of<dim>(f))
        points.emplace_back(&facets.points[dim * v], &facets.points[dim * v] + dim);
      std::ranges::sort(points);
      std::vector<double>& facet = all.emplace_back(1, facets.tags[f]);
      for (const std::vector<double>& x : points) facet.insert(facet.end(), x.begin(), x.end());
    }
    std::ranges::sort(all);
    return all;
  };
  EXPECT_EQ(described(found), described(expected));
}

}  // namespace

}  // namespace tribound::test
