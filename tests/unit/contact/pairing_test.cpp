/// @file pairing_test.cpp
/// Overlays of non-matching boundaries: what is covered, by what, and what is refused.

#include "tribound/contact/pairing/pairing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/dimensions.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

constexpr double distance = 0.1;  ///< between the bodies

/// The box [first, last] along x (and z), [bottom, top] along y.
template <int dim>
mesh::MeshData<dim> slab(double first, double last, double bottom, double top,
                         const std::array<int, dim>& cells)
{
  Point<dim> lower = Point<dim>::Constant(first);
  Point<dim> upper = Point<dim>::Constant(last);
  lower[1] = bottom;
  upper[1] = top;
  return box<dim>(lower, upper, cells);
}

/// A box above another one; the lower one extends from `first` to `last`.
template <int dim>
mesh::MeshData<dim> two_slabs(const std::array<int, dim>& cells_above,
                              const std::array<int, dim>& cells_below, double first, double last)
{
  return side_by_side(slab<dim>(0, 1, 0, 1, cells_above),
                      slab<dim>(first, last, -1 - distance, -distance, cells_below), "_below");
}

template <int dim>
std::array<int, dim> cubes(int n)
{
  std::array<int, dim> cells;
  cells.fill(n);
  return cells;
}

/// The numbers of the boundary facets with this name.
template <int dim>
std::vector<std::size_t> facets_named(const mesh::Mesh<dim>& mesh, const std::string& name)
{
  return mesh::facets_named(mesh, std::span(&name, 1));
}

template <int dim>
std::vector<contact::FacetPair<dim>> overlay(const mesh::Mesh<dim>& mesh,
                                             const std::vector<std::string>& masters,
                                             const problem::Pairing<dim>& pairing = {})
{
  return contact::overlay<dim>(mesh, facets_named(mesh, "bottom"), mesh::facets_named<dim>(mesh, masters),
                               pairing);
}

template <int dim>
mesh::FacetMap<dim> map_of(const mesh::Mesh<dim>& mesh, std::size_t number)
{
  const mesh::BoundaryFacet& facet = mesh.boundary()[number];
  return mesh::facet_map(mesh, facet.cell, facet.local);
}

template <int dim>
double area(const mesh::Mesh<dim>& mesh, const contact::FacetPart<dim>& part)
{
  const mesh::BoundaryFacet& facet = mesh.boundary()[part.number];
  return mesh::facet_geometry(mesh, facet.cell, facet.local).measure * fem::fraction<dim - 1>(*part.part);
}

/// The sum over the slave's parts of the integrals of f.
template <int dim, class Function>
double integral(const mesh::Mesh<dim>& mesh, const std::vector<contact::FacetPair<dim>>& pairs,
                const Function& f)
{
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(11);
  double sum = 0;
  for (const contact::FacetPair<dim>& pair : pairs)
    for (int q = 0; q < rule.size(); ++q)
      sum += mesh::factorial<dim - 1> * area(mesh, pair.slave) * rule.weights[q] *
             f(map_of(mesh, pair.slave.number)(fem::point_in<dim - 1>(*pair.slave.part, rule.points[q])));
  return sum;
}

/// The distance between corners, apart from a multiple of e (the slave's normal of each pair if e is 0).
template <int dim>
double largest_deviation(const mesh::Mesh<dim>& mesh, const std::vector<contact::FacetPair<dim>>& pairs,
                         const Point<dim>& direction)
{
  double largest = 0;
  for (const auto& [slave, master] : pairs)
    for (int i = 0; i < dim; ++i)
    {
      const mesh::BoundaryFacet& facet = mesh.boundary()[slave.number];
      const Point<dim> e = direction.norm() > 0 ? Point<dim>(direction.normalized())
                                                : mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
      const Point<dim> apart =
          map_of(mesh, master.number)((*master.part)[i]) - map_of(mesh, slave.number)((*slave.part)[i]);
      largest = std::max(largest, (apart - apart.dot(e) * e).norm());
    }
  return largest;
}

template <class T>
class PairingTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(PairingTest, Dimensions);

/// Moments up to degree 11 of the covered part; boxes turned and partly covered, numbered at random.
TYPED_TEST(PairingTest, CoversEveryPointOnce)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(1);
  const Tensor<dim> turn = rotation<dim>();
  for (int round = 0; round < (dim == 2 ? 30 : 8); ++round)
  {
    SCOPED_TRACE(round);
    const int n_above = 1 + static_cast<int>(random() % (dim == 2 ? 40 : 7));
    const int n_below = 1 + static_cast<int>(random() % (dim == 2 ? 40 : 7));
    const double first = round % 2 == 0 ? 0.0 : std::uniform_real_distribution<double>(-0.5, 0.5)(random);
    const mesh::Mesh<dim> mesh(
        renumbered(mapped(two_slabs<dim>(cubes<dim>(n_above), cubes<dim>(n_below), first, first + 1),
                          [&](const Point<dim>& x) -> Point<dim> { return turn * x; }),
                   round));
    const auto pairs = overlay<dim>(mesh, {"top_below"});
    EXPECT_LE(largest_deviation<dim>(mesh, pairs, Point<dim>::Zero()), 1e-12);
    const double low = std::max(0.0, first);
    const double high = std::min(1.0, first + 1);
    const auto moment = [&](int k) { return (std::pow(high, k + 1) - std::pow(low, k + 1)) / (k + 1); };
    for (int a = 0; a <= 11; ++a)
      for (int b = 0; a + b <= (dim == 2 ? a : 11); ++b)
      {
        const auto monomial = [&](const Point<dim>& x)
        {
          const Point<dim> y = turn.transpose() * x;
          return std::pow(y[0], a) * std::pow(y[dim - 1], dim == 2 ? 0 : b);
        };
        EXPECT_NEAR(integral<dim>(mesh, pairs, monomial), moment(a) * (dim == 2 ? 1 : moment(b)), 1e-12);
      }
  }
}

/// Non-parallel planes: the measures of both sides have the ratio that the planes give.
TYPED_TEST(PairingTest, ProjectsOnInclinedPlanes)
{
  constexpr int dim = TypeParam::value;
  constexpr double slope = 0.3;
  const auto incline = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    if (x[1] < 0) y[1] -= slope * (1 + x[0]);
    return y;
  };
  const mesh::Mesh<dim> mesh(
      renumbered(mapped(two_slabs<dim>(cubes<dim>(3), cubes<dim>(5), -1, 2), incline), 5));
  Point<dim> oblique = Point<dim>::Zero();
  oblique[0] = 0.4;
  oblique[1] = -2;
  for (const Point<dim>& e : {Point<dim>(Point<dim>::Zero()), oblique})
  {
    problem::Pairing<dim> pairing;
    if (e.norm() > 0) pairing.direction = e;
    const auto pairs = overlay<dim>(mesh, {"top_below"}, pairing);
    EXPECT_LE(largest_deviation<dim>(mesh, pairs, e), 1e-12);
    EXPECT_NEAR(integral<dim>(mesh, pairs, [](const Point<dim>&) { return 1.0; }), 1, 1e-13);
    // along (a, -1): |k_m| / |k_s| = sqrt(1 + slope^2) / (1 - a slope)
    const double stretch = std::hypot(1, slope) / (1 - (e.norm() > 0 ? 0.2 * slope : 0));
    for (const auto& [slave, master] : pairs)
      EXPECT_NEAR(area(mesh, master) / area(mesh, slave), stretch, 1e-10);
  }
}

/// Five sixths of two rings, one inside the other: facets facing the slave across the hole are no partners.
TYPED_TEST(PairingTest, CurvedBoundariesMeetTheirOwnSide)
{
  constexpr int dim = TypeParam::value;
  constexpr int n = dim == 2 ? 60 : 30;
  const auto roll = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    const double angle = -5. / 3 * std::acos(-1.0) * x[0];
    y[0] = (1.5 + x[1]) * std::cos(angle);
    y[1] = (1.5 + x[1]) * std::sin(angle);
    return y;
  };
  std::array<int, dim> outer = cubes<dim>(2);
  std::array<int, dim> inner = cubes<dim>(1);
  outer[0] = n;
  inner[0] = n + 7;
  const mesh::Mesh<dim> mesh(renumbered(mapped(two_slabs<dim>(outer, inner, 0, 1), roll), 2));
  const auto concave = facets_named(mesh, "bottom");
  const auto convex = facets_named(mesh, "top_below");
  const double chord = 1.5 * 5. / 3 * std::acos(-1.0) / n;
  for (const auto& [slave, master] : {std::pair(concave, convex), std::pair(convex, concave)})
  {
    const auto pairs = contact::overlay<dim>(mesh, slave, master);
    EXPECT_LE(largest_deviation<dim>(mesh, pairs, Point<dim>::Zero()), 1e-12);
    double covered = 0;
    for (const contact::FacetPair<dim>& pair : pairs)
    {
      covered += area(mesh, pair.slave);
      const Point<dim> apart = map_of(mesh, pair.master.number)((*pair.master.part)[0]) -
                               map_of(mesh, pair.slave.number)((*pair.slave.part)[0]);
      EXPECT_NEAR(apart.norm(), distance, 0.2 * chord * chord);
    }
    double whole = 0;
    for (const std::size_t number : slave)
      whole += area<dim>(mesh, {number, fem::reference_simplex<dim - 1>()});
    // At each end of the slave, a normal half a chord from the end misses the master.
    EXPECT_LE(covered, whole * (1 + 1e-12));
    EXPECT_GE(covered, whole - 1.1 * distance * chord / 1.5);
  }
}

/// Facets that coincide up to rounding; larger shifts leave slivers, which do no harm.
TYPED_TEST(PairingTest, MatchingFacetsAreOneSegment)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(3);
  for (const double size : {0.0, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8})
  {
    SCOPED_TRACE(size);
    std::uniform_real_distribution<double> rounding(-size, size);
    const mesh::Mesh<dim> mesh(mapped(two_slabs<dim>(cubes<dim>(6), cubes<dim>(6), 0, 1),
                                      [&](const Point<dim>& x) -> Point<dim> {
                                        return x + Point<dim>::NullaryExpr([&] { return rounding(random); });
                                      }));
    const auto pairs = overlay<dim>(mesh, {"top_below"});
    if (size <= 1e-14)
    {
      EXPECT_EQ(pairs.size(), facets_named(mesh, "bottom").size());
    }
    EXPECT_NEAR(integral<dim>(mesh, pairs, [](const Point<dim>&) { return 1.0; }), 1, 1e-11 + 20 * size);
  }
}

/// A plate of half the width in front of the lower body hides part of it.
TYPED_TEST(PairingTest, TheNearestFacetIsThePartner)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(
      renumbered(side_by_side(two_slabs<dim>(cubes<dim>(3), cubes<dim>(4), -0.1, 1.2),
                              slab<dim>(0.23, 0.71, -0.08, -0.05, cubes<dim>(2)), "_plate"),
                 7));
  const auto is_on_plate = [&](const contact::FacetPair<dim>& pair)
  { return mesh.boundary_names()[mesh.boundary()[pair.master.number].tag] == "top_plate"; };
  auto pairs = overlay<dim>(mesh, {"top_below", "top_plate"});
  const double on_plate = std::pow(0.71 - 0.23, dim - 1);
  const auto one = [](const Point<dim>&) { return 1.0; };
  EXPECT_NEAR(integral<dim>(mesh, pairs, one), 1, 1e-8);
  std::erase_if(pairs, is_on_plate);
  EXPECT_NEAR(integral<dim>(mesh, pairs, one), 1 - on_plate, 1e-8);
  for (const contact::FacetPair<dim>& pair : pairs)
  {
    const Point<dim> x = map_of(mesh, pair.slave.number)(
        fem::point_in<dim - 1>(*pair.slave.part, Point<dim - 1>::Constant(1.0 / dim)));
    const auto is_beside = [](double t) { return t < 0.23 || t > 0.71; };
    EXPECT_TRUE(is_beside(x[0]) || (dim == 3 && is_beside(x[dim - 1])));
  }
  EXPECT_NEAR(integral<dim>(mesh, overlay<dim>(mesh, {"top_below", "top_plate"}, {.reach = 0.09}), one),
              on_plate, 1e-12);
  EXPECT_TRUE(overlay<dim>(mesh, {"top_below", "top_plate"}, {.reach = 0.04}).empty());
  EXPECT_TRUE(overlay<dim>(mesh, {"bottom_below"}).empty());  // does not face the slave
  EXPECT_TRUE(overlay<dim>(mesh, {}).empty());
}

/// One facet in front and one behind; their order changes, or they are equally far away.
TYPED_TEST(PairingTest, AnAmbiguousPairingIsRefused)
{
  constexpr int dim = TypeParam::value;
  for (const double slope : {0.0, 0.4})
  {
    const auto incline = [&](const Point<dim>& x) -> Point<dim>
    {
      Point<dim> y = x;
      if (x[1] < 0) y[1] -= slope * (x[0] - 0.5);
      return y;
    };
    const mesh::MeshData<dim> below = slab<dim>(0, 1, -2, -1, cubes<dim>(1));
    const mesh::MeshData<dim> above = slab<dim>(0, 1, 0.75, 1, cubes<dim>(1));
    const mesh::MeshData<dim> plate = slab<dim>(-0.1, 1.1, -0.4, -0.3, cubes<dim>(1));
    const mesh::MeshData<dim> slave = slab<dim>(0, 1, 0, 0.5, cubes<dim>(1));
    const mesh::Mesh<dim> mesh(mapped(
        side_by_side(side_by_side(side_by_side(slave, below, "_below"), above, "_above"), plate, "_plate"),
        incline));
    const auto pair = [&](double reach) {
      return overlay<dim>(mesh, {"top_below", "top_above"}, {.reach = reach});
    };
    const std::string message = message_of([&] { return pair(HUGE_VAL); });
    EXPECT_NE(message.find("ambiguous"), std::string::npos) << message;
    EXPECT_NE(message.find("reach"), std::string::npos);
    EXPECT_TRUE(pair(0.7).empty());
    EXPECT_FALSE(overlay<dim>(mesh, {"top_below"}).empty());
    // What a plate hides may lie anywhere.
    const auto pairs = overlay<dim>(mesh, {"top_below", "top_above", "top_plate"});
    EXPECT_NEAR(integral<dim>(mesh, pairs, [](const Point<dim>&) { return 1.0; }), 1, 1e-8);
  }
}

TYPED_TEST(PairingTest, DirectionsPointOutOfTheSlave)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(two_slabs<dim>(cubes<dim>(1), cubes<dim>(1), 0, 1));
  for (const double along_y : {1.0, 0.0, -0.05})
  {
    Point<dim> e = Point<dim>::Zero();
    e[0] = 1;
    e[1] = along_y;
    const std::string message =
        message_of([&] { return overlay<dim>(mesh, {"top_below"}, {.direction = e}); });
    EXPECT_NE(message.find("does not point out of the slave"), std::string::npos) << message;
  }
}

/// A plane that faces the slave but not the direction.
TYPED_TEST(PairingTest, PartnersFaceTheDirection)
{
  constexpr int dim = TypeParam::value;
  const auto incline = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    if (x[1] < 0) y[1] -= 2 * x[0];
    return y;
  };
  const mesh::Mesh<dim> mesh(mapped(two_slabs<dim>(cubes<dim>(2), cubes<dim>(3), 0, 1), incline));
  Point<dim> e = Point<dim>::Zero();
  e[0] = 1;
  e[1] = -0.2;
  EXPECT_TRUE(overlay<dim>(mesh, {"top_below"}, {.direction = e}).empty());
  e[0] = -1;
  EXPECT_FALSE(overlay<dim>(mesh, {"top_below"}, {.direction = e}).empty());
}

/// Meshes that differ by rounding in files match facet by facet; those that differ by more do not.
TYPED_TEST(PairingTest, IdentifiesFacetsThatNearlyMatch)
{
  constexpr int dim = TypeParam::value;
  for (const double aside : {3e-9, 1e-7, -2e-7, 1e-5})
  {
    const mesh::Mesh<dim> mesh(two_slabs<dim>(cubes<dim>(3), cubes<dim>(3), aside, 1 + aside));
    const auto pairs = overlay<dim>(mesh, {"top_below"});
    const bool is_close = std::abs(aside) < 1e-6;
    EXPECT_EQ(pairs.size() == facets_named<dim>(mesh, "bottom").size(), is_close) << aside;
    for (const auto& [slave, master] : pairs)
      for (const auto& part : {*slave.part, *master.part})
        for (const Point<dim - 1>& corner : part)
        {
          const double off = (corner - corner.array().round().matrix()).norm();
          EXPECT_LE(off, is_close ? 1e-12 : 1) << aside;
        }
    EXPECT_LE(largest_deviation<dim>(mesh, pairs, Point<dim>::Zero()),
              is_close ? 2 * std::abs(aside) : 1e-12);
  }
}

/// Segment counts of the independent prototype.
TEST(Pairing, HasAsManySegmentsAsThePrototype)
{
  const auto in_2d = [](int above, int below)
  {
    const mesh::Mesh<2> mesh(two_slabs<2>({above, 1}, {below, 1}, 0, 1));
    return overlay<2>(mesh, {"top_below"}).size();
  };
  EXPECT_EQ(in_2d(8, 6), 12U);
  EXPECT_EQ(in_2d(4, 3), 6U);
  EXPECT_EQ(in_2d(6, 5), 10U);
  const auto in_3d = [](const std::array<int, 3>& above, const std::array<int, 3>& below)
  {
    const mesh::Mesh<3> mesh(two_slabs<3>(above, below, 0, 1));
    return overlay<3>(mesh, {"top_below"}).size();
  };
  EXPECT_EQ(in_3d({4, 2, 2}, {3, 2, 3}), 88U);
  EXPECT_EQ(in_3d({3, 2, 2}, {2, 1, 2}), 28U);
}

}  // namespace

}  // namespace tribound::test
