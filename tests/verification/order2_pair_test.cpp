/// @file order2_pair_test.cpp
/// A ball on a curved seat, both given by second-order facets: gap, pressure from either side, bound.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/edge_nodes.h"
#include "tribound/case/surface_points.h"
#include "tribound/mesh/refine.h"
#include "verification/arched_block.h"
#include "verification/sound_effectivity.h"

namespace tribound::test
{

namespace
{

constexpr double flatter = 1.25;
constexpr int bottom = 2;  ///< of the ball
constexpr int top = 3;     ///< of the seat by itself

/// A box whose side y = 0 is moved to the ball of radius r that touches y = 0 at the origin from above, with
/// second-order nodes there.
template <int dim>
mesh::MeshData<dim> on_ball(double half_width, std::array<double, 2> heights, int tag, double r,
                            const std::array<int, dim>& cells)
{
  Point<dim> lower = Point<dim>::Constant(-half_width);
  Point<dim> upper = Point<dim>::Constant(half_width);
  lower[1] = heights[0];
  upper[1] = heights[1];
  const Point<dim> centre = r * Point<dim>::Unit(1);
  mesh::MeshData<dim> data = mapped<dim>(box<dim>(lower, upper, cells),
                                         [&](Point<dim> x) -> Point<dim>
                                         {
                                           const double square = x.squaredNorm() - x[1] * x[1];
                                           x[1] += (1 - std::abs(x[1])) * (r - std::sqrt(r * r - square));
                                           return x;
                                         });
  return with_edge_nodes<dim>(std::move(data), tag,
                              [&](const Point<dim>& x) -> Point<dim>
                              { return centre + r * (x - centre).normalized(); });
}

/// The ball above its seat.
template <int dim>
mesh::Mesh<dim> ball_on_seat(int n)
{
  std::array<int, dim> above;
  above.fill(n);
  std::array<int, dim> below;
  below.fill(n + 1);
  if (dim == 3) above[1] = below[1] = std::max(1, n / 2);
  mesh::MeshData<dim> data = side_by_side(on_ball<dim>(0.5, {0, 1}, bottom, 1, above),
                                          on_ball<dim>(0.6, {-1, 0}, top, flatter, below), "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  return mesh::Mesh<dim>(std::move(data));
}

template <int dim>
auto surface_of(const mesh::Mesh<dim>& mesh, const std::string& name)
{
  const auto& names = mesh.labels().boundary_names;
  const auto tag = static_cast<int>(std::ranges::find(names, name) - names.begin());
  return std::make_shared<const mesh::QuadraticSurface<dim>>(*mesh.labels().quadratic_facets, std::array{tag},
                                                             Where{});
}

/// Contact of `slave` with `master` along the normals of the master.
template <int dim>
problem::Contact contact_between(const mesh::Mesh<dim>& mesh, const std::string& slave,
                                 const std::string& master, const problem::ContactLaw& law)
{
  const case_file::PointGeometry<dim> geometry{
      .obstacle = case_file::points_around<dim>(surface_of(mesh, master)),
      .shape = case_file::points_on<dim>(surface_of(mesh, slave)),
      .where = {.file = {}, .key = "contact"}};
  problem::Contact contact(law, case_file::gap_of(geometry));
  contact.normal = case_file::direction_of_obstacle(geometry);
  contact.true_surface = case_file::distance_of_shape(geometry);
  return contact;
}

template <int dim>
ProblemData<dim> pressed(const mesh::Mesh<dim>& mesh, const problem::ContactLaw& law,
                         bool is_ball_slave = true)
{
  const std::string slave = is_ball_slave ? "bottom" : "top_below";
  const std::string master = is_ball_slave ? "top_below" : "bottom";
  ProblemData<dim> data{.boundaries = {fixed<dim>("top", 0.001, -0.01, 0.001), clamped<dim>("bottom_below")},
                        .material = lame(1, 0.3),
                        .pairs = {pair<dim>(slave, master, law)}};
  data.pairs[0].contact = contact_between(mesh, slave, master, law);
  data.pairs[0].pairing.direction = (is_ball_slave ? -1 : 1) * Point<dim>::Unit(1);
  return data;
}

/// At points of the facets, against the two balls that carry the nodes.
template <int dim>
void expect_third_order(const std::vector<int>& sizes)
{
  const auto ball = [](double r, problem::Positive side) {
    return problem::sphere(dim == 2 ? std::vector<double>{0, r} : std::vector<double>{0, r, 0}, r, side);
  };
  const problem::ContactGeometry exact{.obstacle = ball(flatter, problem::Positive::inside),
                                       .shape = ball(1, problem::Positive::outside)};
  const problem::Field gap = problem::gap_of(exact);
  std::vector<double> errors;
  for (const int n : sizes)
  {
    const mesh::Mesh<dim> mesh = ball_on_seat<dim>(n);
    const problem::Contact contact = contact_between<dim>(mesh, "bottom", "top_below", Frictionless());
    errors.push_back(0);
    for (const mesh::BoundaryFacet& facet : mesh.boundary())
      for (int i = 0; facet.tag == bottom && i <= 10; ++i)
      {
        const auto at = mesh::facet_map(mesh, facet.cell, facet.local);
        const Point<dim> x = at(Point<dim - 1>::Constant(i / (10.0 * (dim - 1))));
        errors.back() = std::max(errors.back(), std::abs((*contact.gap)(x)-gap(x)));
      }
  }
  for (std::size_t i = 0; i + 1 < errors.size(); ++i)
  {
    const double rate = std::log2(errors[i] / errors[i + 1]);
    fmt::print("{}D: {:.2e} {:.2e}, rate {:.2f}\n", dim, errors[i], errors[i + 1], rate);
    EXPECT_GT(rate, 2.7);
  }
}

TEST(Order2Pair, TheGapConvergesToThatOfTheBalls)
{
  expect_third_order<2>({8, 16, 32, 64});
  expect_third_order<3>({4, 8, 16});
}

/// The pressure does not depend on which side has the contact terms.
TEST(Order2Pair, EitherSideMayBeTheSlave)
{
  const mesh::Mesh<2> coarse = ball_on_seat<2>(10);
  std::vector<double> largest;
  for (const bool is_ball_slave : {true, false})
  {
    const DiscreteProblem<2> c(mesh::refine_uniformly(coarse, 1).mesh,
                               pressed(coarse, Frictionless(), is_ball_slave), {.degree = 2});
    const std::vector<Point<2>> traction = c.form.traction(c.solve().u);
    largest.push_back(0);
    for (const Point<2>& t : traction) largest.back() = std::max(largest.back(), t.norm());
  }
  fmt::print("largest pressure: {:.6f} {:.6f}\n", largest[0], largest[1]);
  EXPECT_NEAR(largest[0], largest[1], 5e-3 * largest[0]);
}

TEST(Order2Pair, IsCertifiedIn2D)
{
  const mesh::Mesh<2> coarse = ball_on_seat<2>(3);
  for (const bool is_ball_slave : {true, false})
    for (const int p : {1, 2, 3})
    {
      const DiscreteProblem<2> c(mesh::refine_uniformly(coarse, 1).mesh,
                                 pressed(coarse, laws()[p - 1], is_ball_slave), {.degree = p});
      const double ratio = sound_effectivity(c);
      fmt::print("p = {}: {:.3f}\n", p, ratio);
      EXPECT_GE(ratio, 1) << "p = " << p;
      EXPECT_LE(ratio, 8) << "p = " << p;
    }
}

TEST(Order2Pair, IsCertifiedIn3D)
{
  const mesh::Mesh<3> mesh = ball_on_seat<3>(2);
  const DiscreteProblem<3> c(ball_on_seat<3>(2), pressed(mesh, Coulomb(0.3)), {.degree = 1});
  const double ratio = sound_effectivity(c);
  fmt::print("ball: {:.3f}\n", ratio);
  EXPECT_GE(ratio, 1);
  EXPECT_LE(ratio, 8);
}

/// Gap and direction are unknown between the points of evaluation.
TEST(Order2Pair, TheCertificateSaysThatNothingIsEnclosed)
{
  const mesh::Mesh<2> mesh = ball_on_seat<2>(2);
  const DiscreteProblem<2> c(ball_on_seat<2>(2), pressed(mesh, Frictionless()), {.degree = 1});
  EXPECT_GT(c.form.data().effort().unenclosed, 0);
}

}  // namespace

}  // namespace tribound::test
