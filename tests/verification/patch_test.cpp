/// @file patch_test.cpp
/// Constant-stress patch tests: every degree reproduces an affine displacement on every mesh, in every state
/// of contact.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/contact_points.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "verification/affine.h"
#include "verification/data_mesh.h"

namespace tribound::test
{

namespace
{

/// max |u_h - u| / max |u| over the nodes.
template <int dim>
double displacement_error(const DiscreteProblem<dim>& d, std::span<const double> u,
                          const AffineCase<dim>& exact)
{
  double error = 0;
  double largest = 0;
  const std::vector<Point<dim>> nodes = d.space.node_points();
  for (Index i = 0; i < d.space.n_nodes(); ++i)
  {
    const Point<dim> value = exact.gradient * nodes[i] + exact.offset;
    const Eigen::Map<const Point<dim>> discrete(u.data() + dim * static_cast<std::size_t>(i));
    error = std::max(error, (discrete - value).norm());
    largest = std::max(largest, value.norm());
  }
  return error / largest;
}

template <int dim>
void expect_exact(const DiscreteProblem<dim>& d, const AffineCase<dim>& exact, const Point<dim>& normal)
{
  constexpr double volume = 2;
  constexpr double contact_measure = 2;
  constexpr double tolerance = 1e-11;
  const solve::NewtonResult<dim> newton = d.solve();
  ASSERT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  const double error = displacement_error<dim>(d, newton.u, exact);
  fmt::print("{:<20} {:>5} dofs {:>3} steps   error {:.1e}\n", exact.name, d.space.n_dofs(),
             newton.steps.size(), error);
  EXPECT_LE(error, tolerance);

  const Tensor<dim> stress = contact::sigma<dim>(affine_material, exact.gradient);
  const contact::StressNorms norms = contact::stress_norms<dim>(d.problem, d.space, newton.u);
  const double energy = volume * stress.cwiseProduct(exact.gradient).sum();
  EXPECT_NEAR(norms.energy, energy, tolerance * energy);
  EXPECT_NEAR(norms.sigma, std::sqrt(volume) * stress.norm(), tolerance * stress.norm());

  const contact::ContactResultants<dim> contact = contact::contact_resultants<dim>(d.form, newton.traction);
  const Point<dim> force = contact_measure * stress * normal;
  EXPECT_LE((contact.force - force).norm(), tolerance * stress.norm());
  EXPECT_NEAR(contact.normal, force.dot(normal), tolerance * stress.norm());
  EXPECT_NEAR(contact.abs_tangential, (force - force.dot(normal) * normal).norm(), tolerance * stress.norm());

  for (const contact::ContactState<dim>& state : contact_states(d.form, newton.u))
    EXPECT_EQ(state.status, exact.status) << "at " << state.point.transpose();
}

/// Checks every state on the meshes that `make_mesh` makes of the box rotated by `frame`.
template <int dim, class MakeMesh>
void expect_exact_on(const MakeMesh& make_mesh, const Tensor<dim>& frame, int p)
{
  for_all_states<dim>(frame,
                      [&](const AffineCase<dim>& c, const Point<dim>& right, const Point<dim>& bottom)
                      {
                        const DiscreteProblem<dim> d(make_mesh(), affine_data<dim>(c, right),
                                                     affine_method(p));
                        expect_exact<dim>(d, c, bottom);
                      });
}

template <int dim>
void structured_patch(int p)
{
  expect_exact_on<dim>(structured<dim>, Tensor<dim>::Identity(), p);
}

/// Vertices and cells in random order, no side along an axis.
template <int dim>
void turned_patch(int p)
{
  const Tensor<dim> frame = rotation<dim>();
  const auto turn = [&](const Point<dim>& x) -> Point<dim> { return frame * x; };
  expect_exact_on<dim>([&] { return renumbered<dim>(mapped<dim>(structured<dim>(), turn), 7); }, frame, p);
}

template <int dim>
void unstructured_patch(int p)
{
  expect_exact_on<dim>([] { return data_mesh<dim>("box"); }, Tensor<dim>::Identity(), p);
}

class Patch : public ::testing::TestWithParam<int>
{
};

TEST_P(Patch, Structured2D)
{
  structured_patch<2>(GetParam());
}
TEST_P(Patch, Turned2D)
{
  turned_patch<2>(GetParam());
}
TEST_P(Patch, Unstructured2D)
{
  unstructured_patch<2>(GetParam());
}
TEST_P(Patch, Structured3D)
{
  structured_patch<3>(GetParam());
}
TEST_P(Patch, Turned3D)
{
  turned_patch<3>(GetParam());
}
TEST_P(Patch, Unstructured3D)
{
  unstructured_patch<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, Patch, ::testing::Values(1, 2, 3, 4));

}  // namespace

}  // namespace tribound::test
