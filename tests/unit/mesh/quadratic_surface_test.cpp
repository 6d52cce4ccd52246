/// Second-order facets: what a mesh keeps of them, and the surface they form.

#include <random>

#include "support/dimensions.h"
#include "support/edge_nodes.h"
#include "tribound/mesh/cut_open.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/quadratic_surface.h"
#include "tribound/mesh/refine.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::quadratic_surface_cases
{

namespace
{

constexpr int bottom = 2;
const Where in_case = {.file = "case.toml", .key = "shape.s.mesh"};

/// The quadratic height of the lower side.
template <int dim>
double height(const Point<dim>& x)
{
  return 0.2 * x[0] * x[0] - 0.1 * x[0] + (dim == 3 ? 0.1 * x[0] * x[2 % dim] + 0.15 * x[2 % dim] : 0);
}

/// A box whose lower side is bent to the height of `curve`, with second-order nodes there.
template <int dim, class Curve>
mesh::MeshData<dim> bent_box(int n, const Curve& curve)
{
  std::array<int, dim> cells;
  cells.fill(n);
  const auto bend = [&](Point<dim> x) -> Point<dim>
  {
    x[1] += (1 - x[1]) * curve(x);
    return x;
  };
  mesh::MeshData<dim> straight = test::box<dim>(-Point<dim>::Ones() / 2, Point<dim>::Ones() / 2, cells);
  for (Point<dim>& x : straight.vertices) x[1] += 0.5;
  mesh::MeshData<dim> nodes = test::with_edge_nodes<dim>(straight, bottom, bend);
  straight = test::mapped<dim>(std::move(straight), bend);
  straight.edge_nodes = std::move(nodes.edge_nodes);
  return straight;
}

template <int dim>
mesh::QuadraticSurface<dim> surface_of(const mesh::Mesh<dim>& mesh)
{
  return {*mesh.labels().quadratic_facets, std::array{bottom}, in_case};
}

/// Points of the facets of the lower side.
template <int dim>
std::vector<Point<dim>> points_below(const mesh::Mesh<dim>& mesh)
{
  std::vector<Point<dim>> points;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.tag == bottom)
      for (const double s : {0.0, 0.2, 0.5})
        points.push_back(mesh::facet_map(mesh, facet.cell, facet.local)(Point<dim - 1>::Constant(s)));
  return points;
}

template <class D>
class QuadraticSurface : public testing::Test
{
};
TYPED_TEST_SUITE(QuadraticSurface, test::Dimensions);

TYPED_TEST(QuadraticSurface, OfDegreeTwoIsExact)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(bent_box<dim>(2, height<dim>));
  const mesh::QuadraticSurface<dim> surface = surface_of(mesh);
  for (const Point<dim>& x : points_below(mesh))
  {
    const Point<dim> X = surface.value(mesh::QuadraticSurface<dim>::Nodal::point, x);
    EXPECT_NEAR(X[1], height(X), 1e-15);
    for (const int i : {0, dim == 3 ? 2 : 0}) EXPECT_NEAR(X[i], x[i], 1e-15);
  }
}

TYPED_TEST(QuadraticSurface, RefinedMeshesKeepIt)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(bent_box<dim>(2, height<dim>));
  const mesh::Mesh<dim> fine = mesh::refine_uniformly(mesh, 2).mesh;
  EXPECT_EQ(fine.labels().quadratic_facets, mesh.labels().quadratic_facets);
  const mesh::QuadraticSurface<dim> surface = surface_of(fine);
  for (const Point<dim>& x : points_below(fine))
  {
    const Point<dim> X = surface.value(mesh::QuadraticSurface<dim>::Nodal::point, x);
    EXPECT_NEAR(X[1], height(X), 1e-15);
  }
}

/// On a sphere about a centre above: normals are radial to second order, of length 1, and point out of the
/// body.
TYPED_TEST(QuadraticSurface, NormalsConverge)
{
  constexpr int dim = TypeParam::value;
  const Point<dim> centre = Point<dim>::Unit(1);
  const auto ball = [](const Point<dim>& x)
  { return 1 - std::sqrt(1 - x[0] * x[0] - (dim == 3 ? x[2 % dim] * x[2 % dim] : 0)); };
  std::vector<double> errors;
  for (const int n : {8, 16})
  {
    const mesh::Mesh<dim> mesh(bent_box<dim>(n, ball));
    const mesh::QuadraticSurface<dim> surface = surface_of(mesh);
    errors.push_back(0);
    for (const Point<dim>& x : points_below(mesh))
    {
      const Point<dim> X = surface.value(mesh::QuadraticSurface<dim>::Nodal::point, x);
      const Point<dim> normal = surface.normal(x);
      EXPECT_NEAR(normal.norm(), 1, 1e-15);
      errors.back() = std::max(errors.back(), (normal - (X - centre).normalized()).norm());
    }
  }
  EXPECT_LT(errors[1], errors[0] / 3) << errors[0];
  EXPECT_LT(errors[1], 0.02);
}

/// Continuous across edges, and for points off the facets by rounding. Numbering is random, as the vertices
/// of facets come in any order.
TYPED_TEST(QuadraticSurface, IsContinuous)
{
  constexpr int dim = TypeParam::value;
  using Nodal = typename mesh::QuadraticSurface<dim>::Nodal;
  const mesh::Mesh<dim> mesh(
      bent_box<dim>(4, [](const Point<dim>& x) { return 0.1 * std::sin(3 * x[0] + x[dim - 1]); }));
  const mesh::QuadraticSurface<dim> surface = surface_of(mesh);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag != bottom) continue;
    const mesh::FacetMap<dim> map = mesh::facet_map(mesh, facet.cell, facet.local);
    for (const double s : {0.0, 0.3, 1.0})
    {
      Point<dim - 1> at = Point<dim - 1>::Zero();
      at[0] = s;
      for (int i = 0; i < dim; ++i)
        for (const double off : {1e-12, -1e-12})
          for (const Nodal what : {Nodal::point, Nodal::normal})
            EXPECT_LE(
                (surface.value(what, map(at)) - surface.value(what, map(at) + off * Point<dim>::Unit(i)))
                    .norm(),
                1e-10);
    }
  }
}

/// Over parts of facets: values, and derivatives by differences, which are exact for the polynomial.
TYPED_TEST(QuadraticSurface, IsEnclosed)
{
  constexpr int dim = TypeParam::value;
  using Nodal = typename mesh::QuadraticSurface<dim>::Nodal;
  const mesh::Mesh<dim> mesh(
      bent_box<dim>(2, [](const Point<dim>& x) { return 0.2 * std::cos(2 * x[0] + x[dim - 1]); }));
  const mesh::QuadraticSurface<dim> surface = surface_of(mesh);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto mean = [&](const std::array<Point<dim>, dim>& points) -> Point<dim>
  {
    Point<dim> sum = Point<dim>::Zero();
    double weights = 0;
    for (const Point<dim>& x : points)
    {
      const double weight = uniform(random);
      sum += weight * x;
      weights += weight;
    }
    return sum / weights;
  };
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag != bottom) continue;
    const auto whole =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
    std::array<Point<dim>, dim> part;
    std::vector<double> vertices;
    Point<dim> centre = Point<dim>::Zero();
    for (Point<dim>& v : part)
    {
      v = mean(whole);
      centre += v / dim;
      vertices.insert(vertices.end(), v.begin(), v.end());
    }
    for (const Nodal what : {Nodal::point, Nodal::normal})
    {
      const auto coefficients = surface.enclose(what, vertices);
      for (int trial = 0; trial < 20; ++trial)
      {
        const Point<dim> at = mean(part);
        const Point<dim> step = (mean(part) - centre) / 4;  // stays on the facet
        const Point<dim> back = surface.value(what, at - step);
        const Point<dim> here = surface.value(what, at);
        const Point<dim> ahead = surface.value(what, at + step);
        const Point<dim> first = 4 * (ahead - back) / 2;
        const Point<dim> second = 16 * (ahead - 2 * here + back) / 2;
        for (int k = 0; k < dim; ++k)
        {
          EXPECT_TRUE(coefficients[k][0].contains(here[k]));
          EXPECT_GE(first[k], coefficients[k][1].lower - 1e-13);
          EXPECT_LE(first[k], coefficients[k][1].upper + 1e-13);
          EXPECT_GE(second[k], coefficients[k][2].lower - 1e-13);
          EXPECT_LE(second[k], coefficients[k][2].upper + 1e-13);
        }
      }
    }
  }
}

TYPED_TEST(QuadraticSurface, SagittaIsThatOfTheNodes)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(bent_box<dim>(2, [](const Point<dim>& x) { return x[0] * x[0]; }));
  EXPECT_NEAR(mesh::sagitta<dim>(*mesh.labels().quadratic_facets, bottom), 1.0 / 16, 1e-15);
  EXPECT_EQ(mesh::sagitta<dim>(*mesh.labels().quadratic_facets, 3), 0);  // flat
}

TYPED_TEST(QuadraticSurface, WhatMakesNoSurfaceIsNamed)
{
  constexpr int dim = TypeParam::value;
  using testing_mesh::message_of;
  const mesh::MeshData<dim> good = bent_box<dim>(2, height<dim>);
  const auto message = [&](const auto& damage)
  {
    mesh::MeshData<dim> data = good;
    damage(data);
    return message_of([&] { (void)surface_of(mesh::Mesh<dim>(std::move(data))); });
  };
  EXPECT_EQ(message([](auto&) {}), "");
  EXPECT_THAT(message([](auto& data) { data.edge_nodes[0].position[0] = NAN; }),
              testing::HasSubstr("not finite"));
  EXPECT_THAT(message(
                  [](auto& data)
                  {
                    data.edge_nodes.push_back(data.edge_nodes[0]);
                    std::swap(data.edge_nodes.back().ends[0], data.edge_nodes.back().ends[1]);
                    data.edge_nodes.back().position[0] += 0.01;
                  }),
              testing::HasSubstr("has two middles"));
  EXPECT_THAT(message(
                  [](auto& data)
                  {
                    for (auto& node : data.edge_nodes) node.position[0] += 0.4;
                  }),
              testing::AllOf(testing::HasSubstr("shape.s.mesh"), testing::HasSubstr("folds")));
  EXPECT_THAT(message([](auto& data)
                      { std::erase_if(data.facets, [](const auto& facet) { return facet.tag == bottom; }); }),
              testing::HasSubstr("no facets of second order"));
}

/// A curved joint inside the body: both sides get the nodes, with opposite normals.
TEST(QuadraticFacets, JointsAreCutOpenWithTheirNodes)
{
  mesh::MeshData<2> data = test::box<2>({0, 0}, {1, 1}, {2, 2});
  std::erase_if(data.facets, [](const mesh::TaggedFacet<2>&) { return true; });
  data.boundary_names = {"joint"};
  std::vector<Index> middle;
  for (Index v = 0; v < static_cast<Index>(data.vertices.size()); ++v)
    if (data.vertices[v][1] == 0.5) middle.push_back(v);
  for (int i = 0; i < 2; ++i) data.facets.push_back({{middle[i], middle[i + 1]}, 0});
  data = test::with_edge_nodes<2>(std::move(data), 0,
                                  [](const Point<2>& x) -> Point<2> {
                                    return {x[0], 0.55};
                                  });
  mesh::cut_open<2>(data, std::vector<std::string>{"joint"});
  const mesh::Mesh<2> mesh(std::move(data));
  ASSERT_EQ(mesh.boundary_names().size(), 2U);
  const mesh::QuadraticFacets& facets = *mesh.labels().quadratic_facets;
  const mesh::QuadraticSurface<2> one(facets, std::array{0}, in_case);
  const mesh::QuadraticSurface<2> other(facets, std::array{1}, in_case);
  const Point<2> x(0.25, 0.5);
  using Nodal = mesh::QuadraticSurface<2>::Nodal;
  EXPECT_NEAR((one.value(Nodal::point, x) - Point<2>(0.25, 0.55)).norm(), 0, 1e-15);
  EXPECT_NEAR((one.value(Nodal::point, x) - other.value(Nodal::point, x)).norm(), 0, 1e-15);
  EXPECT_NEAR((one.normal(x) + other.normal(x)).norm(), 0, 1e-15);
  EXPECT_NEAR(std::abs(one.normal(x)[1]), 1, 1e-15);
}

}  // namespace

}  // namespace tribound::quadratic_surface_cases
