/// Nearest points of second-order facets: nearest over all facets, with the right side, also at rims and
/// corners.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/dimensions.h"
#include "support/edge_nodes.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/quadratic_surface.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

const Where in_case = {.file = "case.toml", .key = "shape.s.mesh"};

template <int dim>
using Nodes = std::array<Point<dim>, mesh::n_facet_nodes<dim>>;

/// Facets without common nodes.
template <int dim>
mesh::QuadraticFacets loose(const std::vector<Nodes<dim>>& all)
{
  mesh::QuadraticFacets facets;
  for (const Nodes<dim>& nodes : all)
  {
    facets.tags.push_back(0);
    for (const Point<dim>& x : nodes)
    {
      facets.nodes.push_back(static_cast<Index>(facets.nodes.size()));
      facets.points.insert(facets.points.end(), x.begin(), x.end());
    }
  }
  return facets;
}

template <int dim>
mesh::QuadraticSurface<dim> surface_of(const mesh::QuadraticFacets& facets)
{
  return {facets, std::array{0}, in_case};
}

/// The point with these barycentric coordinates.
template <int dim>
Point<dim> on_facet(const Nodes<dim>& nodes, const std::array<double, dim>& l)
{
  Point<dim> x = Point<dim>::Zero();
  for (int i = 0; i < dim; ++i) x += l[i] * (2 * l[i] - 1) * nodes[i];
  constexpr auto& edges = mesh::local_edges<dim - 1>;
  for (std::size_t e = 0; e < edges.size(); ++e) x += 4 * l[edges[e][0]] * l[edges[e][1]] * nodes[dim + e];
  return x;
}

template <int dim>
std::vector<Point<dim>> samples(const Nodes<dim>& nodes, int n)
{
  std::vector<Point<dim>> points;
  for (int i = 0; i <= n; ++i)
  {
    const double s = static_cast<double>(i) / n;
    if constexpr (dim == 2)
      points.push_back(on_facet<2>(nodes, {1 - s, s}));
    else
      for (int j = 0; i + j <= n; ++j)
      {
        const double t = static_cast<double>(j) / n;
        points.push_back(on_facet<3>(nodes, {1 - s - t, s, t}));
      }
  }
  return points;
}

/// Facets of any shape and size, some bent by more than half their length.
template <int dim>
class RandomFacets
{
 public:
  Point<dim> point(double size)
  {
    Point<dim> x;
    for (double& c : x) c = size * uniform_(random_);
    return x;
  }

  Nodes<dim> nodes()
  {
    for (;;)
    {
      Nodes<dim> nodes;
      const Point<dim> centre = point(1);
      const double size = 0.5 + 0.4 * uniform_(random_);
      for (int i = 0; i < dim; ++i) nodes[i] = centre + point(size);
      constexpr auto& edges = mesh::local_edges<dim - 1>;
      for (std::size_t e = 0; e < edges.size(); ++e)
        nodes[dim + e] = (nodes[edges[e][0]] + nodes[edges[e][1]]) / 2 + point(0.5 * size);
      try
      {
        (void)surface_of<dim>(loose<dim>({nodes}));
        return nodes;
      }
      catch (const InputError&)  // it folds
      {
      }
    }
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

template <class D>
class QuadraticFoot : public testing::Test
{
};
TYPED_TEST_SUITE(QuadraticFoot, test::Dimensions);

/// No sample is nearer, and the point found lies on the facets; from points near, far, and on the facets.
TYPED_TEST(QuadraticFoot, NoPointIsNearer)
{
  constexpr int dim = TypeParam::value;
  constexpr int n_samples = dim == 2 ? 2000 : 100;
  RandomFacets<dim> random;
  for (int trial = 0; trial < 40; ++trial)
  {
    std::vector<Nodes<dim>> all;
    std::vector<Point<dim>> points;
    for (int f = 0; f < 20; ++f)
    {
      all.push_back(random.nodes());
      std::ranges::copy(samples<dim>(all.back(), n_samples), std::back_inserter(points));
    }
    const mesh::QuadraticSurface<dim> surface = surface_of<dim>(loose<dim>(all));
    for (const double size : {1.0, 1.0, 1.0, 5.0, 0.0})
    {
      const Point<dim> x = size > 0 ? random.point(size) : points[trial * 7];
      const auto foot = surface.foot(x);
      const auto least = [&](const Point<dim>& from)
      {
        double square = std::numeric_limits<double>::infinity();
        for (const Point<dim>& y : points) square = std::min(square, (y - from).squaredNorm());
        return std::sqrt(square);
      };
      const double distance = (foot.point - x).norm();
      EXPECT_LE(distance, least(x) + 1e-14);
      EXPECT_LE(std::abs(foot.distance), distance + 1e-14);
      EXPECT_LE(least(foot.point), 4.0 / n_samples);
      EXPECT_NEAR(foot.normal.norm(), 1, 1e-14);
    }
  }
}

/// Nearest points are found even where there are many: at and near the centre of a ball, on the axis of a
/// cylinder.
TYPED_TEST(QuadraticFoot, CentresOfCurvatureHaveOne)
{
  constexpr int dim = TypeParam::value;
  // The focal point of y = x^2/2: |x - c|^2 = 1 + x^4/4.
  Nodes<dim> nodes;
  constexpr auto& edges = mesh::local_edges<dim - 1>;
  const auto lifted = [](Point<dim> x) -> Point<dim>
  {
    x[1] = x[0] * x[0] / 2;
    return x;
  };
  const double far = 0.5;
  nodes[0] = lifted(Point<dim>(Point<dim>::Unit(0) * -far));
  nodes[1] = lifted(Point<dim>(Point<dim>::Unit(0) * far));
  if constexpr (dim == 3) nodes[2] = lifted(Point<3>(0.1, 0, 1));
  for (std::size_t e = 0; e < edges.size(); ++e)
    nodes[dim + e] = lifted((nodes[edges[e][0]] + nodes[edges[e][1]]) / 2);
  const mesh::QuadraticSurface<dim> surface = surface_of<dim>(loose<dim>({nodes}));
  Point<dim> x = Point<dim>::Unit(1);
  if (dim == 3) x[dim - 1] = 0.3;
  for (const double off : {0.0, 1e-9, -1e-5, 0.01})
  {
    const Point<dim> at = x + off * Point<dim>::Unit(0);
    EXPECT_NEAR(std::abs(surface.foot(at).distance), 1, std::abs(off)) << off;
    EXPECT_NEAR(std::abs(surface.foot(at).point[0]), std::cbrt(2 * std::abs(off)),
                0.05 * std::cbrt(std::abs(off)) + 1e-3);
  }
}

constexpr int bottom = 2;

/// A block whose lower side is part of the sphere around (0, 1, 0) with radius 1, with n facets along it.
template <int dim>
mesh::QuadraticSurface<dim> bowl(int n)
{
  std::array<int, dim> cells;
  cells.fill(n);
  cells[1] = 1;
  const auto bend = [](Point<dim> x) -> Point<dim>
  {
    x[1] += (1 - x[1]) * (1 - std::sqrt(1 - x.squaredNorm() + x[1] * x[1]));
    return x;
  };
  Point<dim> lower = Point<dim>::Constant(-0.5);
  Point<dim> upper = Point<dim>::Constant(0.5);
  lower[1] = 0;
  upper[1] = 1;
  const Point<dim> centre = Point<dim>::Unit(1);
  const mesh::Mesh<dim> mesh(test::with_edge_nodes<dim>(
      test::mapped<dim>(test::box<dim>(lower, upper, cells), bend), bottom,
      [&](const Point<dim>& x) -> Point<dim> { return centre + (x - centre).normalized(); }));
  return {*mesh.labels().quadratic_facets, std::array{bottom}, in_case};
}

/// On both sides, and also far from the facets, except at their centre.
TYPED_TEST(QuadraticFoot, DistancesFromASphereConverge)
{
  constexpr int dim = TypeParam::value;
  const Point<dim> centre = Point<dim>::Unit(1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  std::vector<Point<dim>> points;
  for (int i = 0; i < 200; ++i)
  {
    Point<dim> x;
    for (double& c : x) c = uniform(random);
    points.push_back(x);
  }
  std::vector<double> errors;
  std::vector<double> turns;
  for (const int n : {4, 8, 16})
  {
    const mesh::QuadraticSurface<dim> surface = bowl<dim>(n);
    errors.push_back(0);
    turns.push_back(0);
    for (const Point<dim>& x : points)
    {
      const auto foot = surface.foot(x);
      errors.back() = std::max(errors.back(), std::abs(foot.distance - ((x - centre).norm() - 1)));
      turns.back() = std::max(turns.back(), (foot.normal - (x - centre).normalized()).norm());
    }
  }
  for (int i = 0; i < 2; ++i)
  {
    EXPECT_GT(std::log2(errors[i] / errors[i + 1]), 2.7) << errors[i] << " " << errors[i + 1];
    EXPECT_GT(std::log2(turns[i] / turns[i + 1]), 1.7) << turns[i] << " " << turns[i + 1];
  }
  EXPECT_LT(errors[2], 1e-5);
}

/// Nearly all points of the surface are equally near to it.
TYPED_TEST(QuadraticFoot, TheCentreOfASphereIsOneRadiusAway)
{
  constexpr int dim = TypeParam::value;
  EXPECT_NEAR(bowl<dim>(8).foot(Point<dim>(Point<dim>::Unit(1))).distance, -1, 1e-4);
}

/// Beyond its rim the surface continues along its tangents.
TYPED_TEST(QuadraticFoot, TheSurfaceGoesOnBeyondItsRim)
{
  constexpr int dim = TypeParam::value;
  const mesh::QuadraticSurface<dim> surface = bowl<dim>(8);
  Point<dim> rim = Point<dim>::Zero();
  rim[0] = 0.5;
  rim[1] = 1 - std::sqrt(0.75);
  const Point<dim> centre = Point<dim>::Unit(1);
  const Point<dim> outward = rim - centre;
  Point<dim> along = Point<dim>::Zero();
  along[0] = -outward[1];
  along[1] = outward[0];
  for (const double off : {-0.1, 0.0, 0.1})
  {
    const auto foot = surface.foot(rim + 0.2 * along + off * outward);
    // In 3D, nodes on the edges of the rim lie farther out than the others.
    EXPECT_NEAR((foot.point - rim).norm(), 0, dim == 2 ? 1e-14 : 1e-2);
    EXPECT_NEAR(foot.distance, off, 2e-3);
    EXPECT_NEAR((foot.normal - (foot.point - centre)).norm(), 0, 5e-3);
  }
}

/// Two straight facets at right angles; outside is the wider side.
TEST(QuadraticFoot2D, CornersHaveASide)
{
  mesh::QuadraticFacets facets;
  facets.tags = {0, 0};
  facets.nodes = {0, 1, 2, 1, 3, 4};
  facets.points = {0, 1, 0, 0, 0, 0.5, 1, 0, 0.5, 0};  // down, then to the right: the body is above
  const mesh::QuadraticSurface<2> surface = surface_of<2>(facets);
  EXPECT_NEAR(surface.foot({-0.3, -0.4}).distance, 0.5, 1e-15);
  EXPECT_NEAR(surface.foot({-0.3, -0.4}).point.norm(), 0, 1e-15);
  EXPECT_NEAR((surface.foot({-0.3, -0.4}).normal + Point<2>(1, 1).normalized()).norm(), 0, 1e-15);
  EXPECT_NEAR(surface.foot({0.3, 0.4}).distance, -0.3, 1e-15);
  EXPECT_NEAR(surface.foot({0.4, -0.1}).distance, 0.1, 1e-15);
}

}  // namespace

}  // namespace tribound
