/// @file almost_along_test.cpp
/// Facets of Gamma_D almost along a component that is fixed on them: the bound, the identities and the stress
/// do not depend on how small the angle is. Prints a table of effectivities.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/dense_patch.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/mesh/geometry.h"
#include "verification/affine.h"

namespace tribound::test
{

namespace
{

/// From far above to below what counts as along the component.
constexpr std::array turns{0.0, 1e-10, 5e-9, 2e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-2, 0.1, 0.3};
constexpr double along = 1e-8;

/// The block with its top turned by the angle `turn`, in 3D about both axes; the right side likewise.
template <int dim>
mesh::MeshData<dim> turned_block(const std::array<int, 2>& cells_2d, const std::array<int, 3>& cells_3d,
                                 double turn)
{
  return mapped<dim>(block<dim>(cells_2d, cells_3d),
                     [&](const Point<dim>& x) -> Point<dim>
                     {
                       Point<dim> y = x;
                       y[1] += turn * x[1] * (x[0] + (dim == 3 ? 0.3 * x[dim - 1] : 0));
                       y[0] += 0.5 * turn * x[0] * x[1];
                       return y;
                     });
}

/// Planes of antisymmetry, which take shear but no pressure, on top and on the right, where they meet
/// contact.
template <int dim>
ProblemData<dim> between_antisymmetries(const problem::ContactLaw& law)
{
  return {.boundaries = {clamped<dim>("left"), loaded<dim>(fixed<dim>("top", 0, free), 0, -0.1),
                         loaded<dim>(fixed<dim>("right", free, 0), 0.04, 0), obstacle<dim>("bottom", law)},
          .body_force = components<dim>(formula("0.1*x"), formula("-0.05*(1 + x)"), formula("0.02*y"))};
}

adapt::Method almost_along_method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-12}};
}

/// Bound over dual norm at convergence, with symmetric stresses. Identities there and at the first iterates
/// hold up to rounding, or, symmetric, up to a fraction of the angle if the top counts as along the
/// component. Rows do not feel the angle, and their bounds are smaller.
template <int dim>
double effectivity_of(int p, double turn)
{
  DiscreteProblem<dim> c(turned_block<dim>({6, 3}, {2, 1, 1}, turn),
                         between_antisymmetries<dim>(Tresca(0.03)), almost_along_method(p));
  double effectivity = 0;
  for (const int k : {1, 2, 30})
  {
    c.method.newton.max_steps = k;
    const solve::NewtonResult<dim> newton = c.solve();
    certify::DualNorm<dim> dual_norm(c.form, {.refinements = 1, .degree = p + 2});
    const double norm = dual_norm(newton.u);
    const auto bound = [&](certify::PatchStress patches, double limit)
    {
      const certify::Stress<dim> stress =
          certify::equilibrate<dim>(c.form, newton.u, newton.traction, 0, 0, patches);
      EXPECT_LE(certify::check_identities<dim>(c.form, newton.traction, stress).largest(), limit + 1e-11)
          << dim << "D, p = " << p << ", turned by " << turn << ", iterate " << k;
      return certify::estimate<dim>(c.form, newton.u, stress).total_sharp;
    };
    const double by_rows = bound(certify::PatchStress::rows, 0);
    effectivity = bound(certify::PatchStress::afw, turn < along ? turn : 0) / norm;
    EXPECT_GE(by_rows / norm, 1.0);
    EXPECT_LE(by_rows / norm, effectivity);
  }
  return effectivity;
}

template <int dim>
void expect_bounded(int p)
{
  double smallest = 1e300;
  double largest = 0;
  std::string line = fmt::format("{}D, p = {}:", dim, p);
  for (const double turn : turns)
  {
    const double effectivity = effectivity_of<dim>(p, turn);
    line += fmt::format(" {:.3f}", effectivity);
    smallest = std::min(smallest, effectivity);
    largest = std::max(largest, effectivity);
  }
  fmt::print("{}\n", line);
  EXPECT_LE(largest, 1.3 * smallest) << dim << "D, p = " << p;
}

class AlmostAlong : public ::testing::TestWithParam<int>
{
};

TEST_P(AlmostAlong, TheBoundDoesNotDependOnTheAngle)
{
  expect_bounded<2>(GetParam());
  if (GetParam() <= 2) expect_bounded<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, AlmostAlong, ::testing::Range(1, 4));

/// ||a - b|| / ||a||.
double distance(const std::vector<double>& a, const std::vector<double>& b)
{
  double square = 0;
  double norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    square += std::pow(a[i] - b[i], 2);
    norm += a[i] * a[i];
  }
  return std::sqrt(square / norm);
}

/// The rounding of a stress is that of the reactions, whose lever arms are as small as the angle.
template <int dim>
void expect_dense_kernel_agrees(int p, double turn)
{
  DiscreteProblem<dim> c(turned_block<dim>({4, 2}, {2, 1, 1}, turn),
                         between_antisymmetries<dim>(Coulomb(0.4)), almost_along_method(p));
  for (const int k : {1, 30})
  {
    c.method.newton.max_steps = k;
    const solve::NewtonResult<dim> newton = c.solve();
    const certify::Stress<dim> fast =
        certify::equilibrate<dim>(c.form, newton.u, newton.traction, 0, 0, certify::PatchStress::afw);
    const certify::Stress<dim> dense =
        dense_equilibrate<dim>(c.form, newton.u, newton.traction, certify::PatchStress::afw);
    const double d = distance(fast.dis, dense.dis);
    EXPECT_LE(d, 1e-12 / turn) << dim << "D, p = " << p << ", turned by " << turn << ", iterate " << k;
  }
}

TEST(AlmostAlongDense, KernelAgrees)
{
  for (const double turn : {1e-5, 1e-3, 0.1, 0.3})
  {
    for (int p = 1; p <= 3; ++p) expect_dense_kernel_agrees<2>(p, turn);
    expect_dense_kernel_agrees<3>(1, turn);
  }
}

/// A constant stress leaves nothing to estimate, whatever the angle, except rounding of reactions with short
/// lever arms.
template <int dim>
void expect_exact_for_constant_stress(int p, double turn)
{
  Tensor<dim> gradient = Tensor<dim>::Zero();
  gradient.template topLeftCorner<2, 2>() << 0.1, 0.2, 0, -0.3;
  const std::array<problem::Field, 3> u = affine_field<dim>(gradient, 0.05 * Point<dim>::Unit(0));
  mesh::Mesh<dim> mesh(turned_block<dim>({4, 2}, {2, 2, 2}, turn));
  const Tensor<dim> stress = contact::sigma<dim>(affine_material, gradient);
  Point<dim> top = Point<dim>::Zero();  // the outward normal of the top
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.tag >= 0 && mesh.boundary_names()[facet.tag] == "top")
      top = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
  const Point<dim> t = stress * top;
  ProblemData<dim> data{
      .boundaries = {fixed<dim>("left", u[0], u[1], u[2]), fixed<dim>("right", u[0], u[1], u[2]),
                     loaded<dim>(fixed<dim>("top", u[0], free, free), 0, t[1], t[dim - 1]),
                     obstacle<dim>("bottom", Tresca(0.2 * affine_material.mu))},
      .material = affine_material};
  for (const std::string side : {"back", "front"})
    if (dim == 3) data.boundaries.push_back(fixed<dim>(side, free, free, 0));
  const DiscreteProblem<dim> c(std::move(mesh), data, affine_method(p));
  const solve::NewtonResult<dim> newton = c.solve();
  ASSERT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  for (const certify::PatchStress patches : {certify::PatchStress::rows, certify::PatchStress::afw})
  {
    const double lever = patches == certify::PatchStress::rows ? 1 : turn;
    const certify::Stress<dim> sigma =
        certify::equilibrate<dim>(c.form, newton.u, newton.traction, 0, 0, patches);
    EXPECT_LE(certify::estimate<dim>(c.form, newton.u, sigma).total, 1e-12 + 1e-14 / lever)
        << dim << "D, p = " << p << ", turned by " << turn << ", " << certify::to_string(patches);
  }
}

TEST(AlmostAlongConstant, StressLeavesNothing)
{
  for (const double turn : {1e-6, 1e-4, 1e-2, 0.3})
    for (int p = 1; p <= 3; ++p)
    {
      expect_exact_for_constant_stress<2>(p, turn);
      if (p <= 2) expect_exact_for_constant_stress<3>(p, turn);
    }
}

}  // namespace

}  // namespace tribound::test
