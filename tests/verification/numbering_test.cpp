/// @file numbering_test.cpp
/// The order of vertices, of cells and of vertices in cells changes only rounding.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::test
{

namespace
{

/// Clamped on the left, loaded from above and pressed on the bottom.
template <int dim>
ProblemData<dim> held_block(const std::array<const char*, 3>& body,
                            const std::array<const char*, 3>& traction, const problem::ContactLaw& law,
                            const char* gap)
{
  const auto [t_x, t_y, t_z] = traction;
  return {.boundaries = {clamped<dim>("left"), loaded<dim>("top", formula(t_x), formula(t_y), formula(t_z)),
                         obstacle<dim>("bottom", law, formula(gap))},
          .body_force = components<dim>(formula(body[0]), formula(body[1]), formula(body[2]))};
}

template <int dim>
struct NamedData
{
  const char* name;
  ProblemData<dim> data;
};

/// Data that rules integrate directly, and data for which cells and facets are cut and halved.
template <int dim>
std::vector<NamedData<dim>> all_data()
{
  constexpr std::array smooth_body = {"0.02*exp(x - y)", "-0.05*cos(2*x + y)", "0.03*sin(x*y)"};
  constexpr std::array smooth_traction = {"0.03*cos(x)", "-0.1*exp(0.5*x)", "0.01*y"};
  return {{"smooth, Tresca", held_block<dim>(smooth_body, smooth_traction,
                                             Tresca(formula("0.02 + 0.01*sin(3*x)")), "0.003*exp(x)")},
          {"smooth, Coulomb", held_block<dim>(smooth_body, smooth_traction, Coulomb(0.3), "0.003*exp(x)")},
          {"kinks and jumps, Coulomb",
           held_block<dim>({"0.1*max(0, x - 0.6*y)^2*exp(x)", "x < 0.43 ? -0.05*exp(y) : 0.02*cos(x)",
                            "0.03*abs(x - y)*exp(x)"},
                           {"0.03*abs(x - 0.37)*exp(x)", "-0.1*max(0, sin(9*x))", "0.01*y"}, Coulomb(0.3),
                           "0.004*abs(x - 0.52)*exp(x)")}};
}

adapt::Method method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-13}, .solver = {.method = algebra::LinearMethod::direct}};
}

template <int dim>
struct Solved
{
  contact::StressNorms norms;
  certify::Estimate eta;
  std::map<std::vector<double>, Point<dim>> u;  ///< at the vertices, by their coordinates
};

template <int dim>
Solved<dim> solved(const mesh::MeshData<dim>& mesh, const ProblemData<dim>& data, int p)
{
  const DiscreteProblem<dim> c(mesh, data, method(p));
  const solve::NewtonResult<dim> newton = c.solve();
  EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  Solved<dim> result;
  result.norms = contact::stress_norms<dim>(c.problem, c.space, newton.u);
  result.eta =
      certify::estimate<dim>(c.form, newton.u, certify::equilibrate<dim>(c.form, newton.u, newton.traction));
  for (Index v = 0; v < c.mesh.n_vertices(); ++v)
  {
    const Point<dim> x = c.mesh.vertex(v);
    result.u[{x.data(), x.data() + dim}] =
        Eigen::Map<const Point<dim>>(&newton.u[static_cast<std::size_t>(dim) * v]);
  }
  return result;
}

/// Components relative to the bound: vanishing ones are rounding.
template <int dim>
void expect_same(const Solved<dim>& a, const Solved<dim>& b)
{
  constexpr double tolerance = 1e-12;
  EXPECT_NEAR(b.norms.energy, a.norms.energy, tolerance * a.norms.energy);
  EXPECT_NEAR(b.norms.sigma, a.norms.sigma, tolerance * a.norms.sigma);
  EXPECT_NEAR(b.eta.total, a.eta.total, tolerance * a.eta.total);
  EXPECT_NEAR(b.eta.total_sharp, a.eta.total_sharp, tolerance * a.eta.total);
  for (const certify::Component& c : certify::plain_components)
    EXPECT_NEAR(b.eta.global.*c.value, a.eta.global.*c.value, tolerance * a.eta.total) << c.name;
  double largest = 0;
  double difference = 0;
  ASSERT_EQ(a.u.size(), b.u.size());
  for (const auto& [x, u] : a.u)
  {
    largest = std::max(largest, u.norm());
    difference = std::max(difference, (u - b.u.at(x)).norm());
  }
  EXPECT_LE(difference, tolerance * largest);
}

template <int dim>
void expect_same_for_every_numbering(const mesh::MeshData<dim>& mesh, int p)
{
  for (const auto& [name, data] : all_data<dim>())
  {
    SCOPED_TRACE(fmt::format("{}D, p = {}, {}", dim, p, name));
    const Solved<dim> first = solved<dim>(mesh, data, p);
    for (const unsigned seed : {1U, 2U})
      expect_same<dim>(first, solved<dim>(renumbered(mesh, seed), data, p));
  }
}

}  // namespace

TEST(Numbering, ChangesNothingIn2D)
{
  for (int p = 1; p <= 3; ++p)
  {
    expect_same_for_every_numbering<2>(box<2>({0, 0}, {1.3, 0.7}, {5, 3}), p);
    expect_same_for_every_numbering<2>(distorted(box<2>({0, 0}, {1.3, 0.7}, {5, 3}), 3), p);
  }
}

TEST(Numbering, ChangesNothingIn3D)
{
  for (int p = 1; p <= 2; ++p)
  {
    expect_same_for_every_numbering<3>(box<3>({0, 0, 0}, {1.3, 0.7, 0.6}, {4, 2, 2}), p);
    expect_same_for_every_numbering<3>(distorted(box<3>({0, 0, 0}, {1.3, 0.7, 0.6}, {4, 2, 2}), 3), p);
  }
}

}  // namespace tribound::test
