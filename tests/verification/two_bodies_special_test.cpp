/// @file two_bodies_special_test.cpp
/// Bodies that meet in unusual ways: the bound stays above the dual norm, and results do not depend on the
/// order of the sides where they should not.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "support/dimensions.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

namespace
{

template <int dim>
struct Certified
{
  solve::NewtonResult<dim> newton;
  certify::Estimate bound;
};

template <int dim>
Certified<dim> certified(const DiscreteProblem<dim>& c)
{
  solve::NewtonResult<dim> newton = c.solve();
  EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<dim>(c.form, newton.traction, stress).largest(), 1e-11);
  certify::Estimate bound = certify::estimate<dim>(c.form, newton.u, stress);
  return {std::move(newton), std::move(bound)};
}

/// The bound is above the dual norm, and not far above.
template <int dim>
void expect_sharp(const DiscreteProblem<dim>& c, double most)
{
  const Certified<dim> found = certified(c);
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = 1, .degree = c.space.degree() + 2});
  const double quotient = found.bound.total_sharp / dual_norm(found.newton.u);
  fmt::print("{} cells, p = {}: effectivity {:.3f}, mor {:.3g} of {:.3g}\n", c.mesh.n_cells(),
             c.space.degree(), quotient, found.bound.global.mor, found.bound.total_sharp);
  EXPECT_GE(quotient, 1);
  EXPECT_LE(quotient, most);
}

adapt::Method method(int degree)
{
  return {.degree = degree, .newton = {.tolerance = 1e-12}};
}

template <class T>
class SpecialPairs : public ::testing::Test
{
};
TYPED_TEST_SUITE(SpecialPairs, Dimensions);

template <int dim>
Point<dim> corner(double x, double y, double z)
{
  Point<dim> result;
  result[0] = x;
  result[1] = y;
  result[dim - 1] = dim == 3 ? z : y;
  return result;
}

template <int dim>
std::array<int, dim> cells(int x, int y, int z)
{
  if constexpr (dim == 2)
    return {x, y};
  else
    return {x, y, z};
}

/// A block on a wider one; their sides may touch.
template <int dim>
mesh::MeshData<dim> on_a_wider_block(double distance = 0)
{
  mesh::MeshData<dim> data = side_by_side(
      box<dim>(corner<dim>(0, distance, 0), corner<dim>(2, 1, 1), cells<dim>(4, 2, 1)),
      box<dim>(corner<dim>(-0.5, -1, -0.2), corner<dim>(2.5, 0, 1.1), cells<dim>(5, 2, 2)), "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  return data;
}

template <int dim>
ProblemData<dim> pressed(std::vector<problem::ContactPair<dim>> pairs)
{
  return {.boundaries = {clamped<dim>("bottom_below"), clamped<dim>("left"), loaded<dim>("top", 0.02, -0.1)},
          .regions = {{.name = "box_below", .material = lame(3, 0.2)}},
          .pairs = std::move(pairs)};
}

/// On a flat interface, exchanging the sides gives the same energy, bound and components.
TYPED_TEST(SpecialPairs, EitherSideMayBeTheSlave)
{
  constexpr int dim = TypeParam::value;
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.02)),
        problem::ContactLaw(Coulomb(0.3)), problem::ContactLaw(Tied())})
    for (int degree = 1; degree <= (dim == 2 ? 4 : 2); ++degree)
    {
      SCOPED_TRACE(fmt::format("{}, p = {}", problem::words(law), degree));
      const auto solved = [&](const char* slave, const char* master)
      {
        const DiscreteProblem<dim> c(on_a_wider_block<dim>(), pressed<dim>({pair<dim>(slave, master, law)}),
                                     method(degree));
        return certified(c);
      };
      const Certified<dim> one = solved("bottom", "top_below");
      const Certified<dim> other = solved("top_below", "bottom");
      double largest = 0;
      for (const double x : one.newton.u) largest = std::max(largest, std::abs(x));
      for (std::size_t i = 0; i < one.newton.u.size(); ++i)
        EXPECT_NEAR(one.newton.u[i], other.newton.u[i], 1e-9 * largest);
      for (const certify::Component& component : certify::all_components)
        EXPECT_NEAR(one.bound.global.*component.value, other.bound.global.*component.value,
                    1e-8 * one.bound.total)
            << component.name;
    }
}

/// Along converging normals, images of the slave's facets overlap; along diverging ones part of the master is
/// left out.
TYPED_TEST(SpecialPairs, SocketsAndRidges)
{
  constexpr int dim = TypeParam::value;
  for (const double slope : {-0.3, 0.3})
    for (int degree = 1; degree <= (dim == 2 ? 3 : 1); ++degree)
    {
      const auto bent = [&](Point<dim> x)
      {
        x[1] += slope * std::abs(x[0] - 1);
        return x;
      };
      problem::ContactPair<dim> contact = pair<dim>("bottom", "top_below", Coulomb(0.3));
      contact.contact.gap = problem::Field(-0.01);
      expect_sharp<dim>(DiscreteProblem<dim>(mapped<dim>(on_a_wider_block<dim>(0.1), bent),
                                             pressed<dim>({contact}), method(degree)),
                        dim == 2 ? 2 : 4);
    }
}

/// Splits a boundary: facets with a centre left of x = 1 become a group of their own.
template <int dim>
void divide(mesh::MeshData<dim>& data, const std::string& name)
{
  const auto group =
      static_cast<int>(std::ranges::find(data.boundary_names, name) - data.boundary_names.begin());
  for (mesh::TaggedFacet<dim>& facet : data.facets)
  {
    double x = 0;
    for (const Index v : facet.vertices) x += data.vertices[v][0] / dim;
    if (facet.tag == group && x < 1) facet.tag = static_cast<int>(data.boundary_names.size());
  }
  data.boundary_names.push_back(name + "_left");
}

/// A tie and friction meet at a vertex, on both sides.
TYPED_TEST(SpecialPairs, ATieBesideFriction)
{
  constexpr int dim = TypeParam::value;
  mesh::MeshData<dim> data =
      side_by_side(box<dim>(corner<dim>(0, 0, 0), corner<dim>(2, 1, 1), cells<dim>(4, 2, 1)),
                   box<dim>(corner<dim>(0, -1, 0), corner<dim>(2, 0, 1), cells<dim>(6, 2, 2)), "_below");
  divide(data, "bottom");
  divide(data, "top_below");
  data.interfaces = {{{{{"bottom", "bottom_left"}, {"top_below", "top_below_left"}}}}};
  ProblemData<dim> problem{.boundaries = {clamped<dim>("bottom_below"), loaded<dim>("top", 0.05, -0.1),
                                          loaded<dim>("right", 0.1, 0.05)},
                           .pairs = {pair<dim>("bottom_left", "top_below_left", Tied()),
                                     pair<dim>("top_below", "bottom", Coulomb(0.2))}};
  for (int degree = 1; degree <= (dim == 2 ? 3 : 1); ++degree)
    expect_sharp<dim>(DiscreteProblem<dim>(data, problem, method(degree)), dim == 2 ? 2 : 4);
}

/// Two blocks side by side below one: a chain that closes, and a point where all three meet.
TYPED_TEST(SpecialPairs, ThreeBodiesMeet)
{
  constexpr int dim = TypeParam::value;
  mesh::MeshData<dim> data = side_by_side(
      side_by_side(box<dim>(corner<dim>(0, 0, 0), corner<dim>(2, 1, 1), cells<dim>(5, 2, 1)),
                   box<dim>(corner<dim>(0, -1, 0), corner<dim>(1.1, 0, 1), cells<dim>(3, 2, 1)), "_1"),
      box<dim>(corner<dim>(1.1, -1, 0), corner<dim>(2, 0, 1), cells<dim>(2, 3, 2)), "_2");
  data.interfaces = {{{{{"bottom"}, {"top_1", "top_2"}}}}, {{{{"right_1"}, {"left_2"}}}}};
  problem::ContactPair<dim> above = pair<dim>("bottom", "top_1", Coulomb(0.3));
  above.master.push_back("top_2");
  const ProblemData<dim> problem{
      .boundaries = {clamped<dim>("bottom_1"), clamped<dim>("bottom_2"), loaded<dim>("top", 0.02, -0.1)},
      .regions = {{.name = "box_2", .material = lame(10, 0.3)}},
      .pairs = {above, pair<dim>("right_1", "left_2", Tresca(0.01))}};
  for (int degree = 1; degree <= (dim == 2 ? 3 : 1); ++degree)
    expect_sharp<dim>(DiscreteProblem<dim>(data, problem, method(degree)), dim == 2 ? 2 : 4);
}

/// On matching meshes nothing is lost.
TYPED_TEST(SpecialPairs, NothingIsLostBetweenMeshesThatMatch)
{
  constexpr int dim = TypeParam::value;
  mesh::MeshData<dim> data =
      side_by_side(box<dim>(corner<dim>(0, 0, 0), corner<dim>(2, 1, 1), cells<dim>(4, 2, 2)),
                   mapped<dim>(box<dim>(corner<dim>(0, 0, 0), corner<dim>(2, 1, 1), cells<dim>(4, 2, 2)),
                               [](const Point<dim>& x)
                               {
                                 Point<dim> y = x;
                                 y[1] -= 1;
                                 return y;
                               }),
                   "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  for (const problem::ContactLaw& law : {problem::ContactLaw(Coulomb(0.3)), problem::ContactLaw(Tied())})
    for (int degree = 1; degree <= 2; ++degree)
    {
      const DiscreteProblem<dim> c(data, pressed<dim>({pair<dim>("bottom", "top_below", law)}),
                                   method(degree));
      const Certified<dim> found = certified(c);
      EXPECT_LE(found.bound.global.mor, 1e-13);
    }
}

}  // namespace

}  // namespace tribound::test
