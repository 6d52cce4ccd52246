/// @file estimate_test.cpp
/// The components of the bound where the answer is known: eta_tot falls like the error, h^p, the oscillation
/// like h^(p+1); all components vanish where the stress is constant. Prints the values.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "verification/affine.h"
#include "verification/manufactured.h"
#include "verification/solutions.h"

namespace tribound::test
{

namespace
{

/// Rates between the last two meshes, with n = first, 2 first, ... cells along y.
struct BoundRates
{
  double total;
  double oscillation;
};

template <int dim>
BoundRates finest_rates(const Manufactured<dim>& solution, int p, int first, int levels)
{
  fmt::print("{}, p = {}\n{:>8} {:>10} {:>12} {:>6} {:>12} {:>6}\n", solution.name, p, "n", "cells",
             "eta_tot", "rate", "eta_osc", "rate");
  certify::BoundComponents last;
  double last_total = 0;
  BoundRates rates{0, 0};
  for (int level = 0, n = first; level < levels; ++level, n *= 2)
  {
    const DiscreteProblem<dim> c = manufactured_problem(solution, p, n);
    const solve::NewtonResult<dim> newton = c.solve();
    EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
    const certify::Estimate eta = certify::estimate<dim>(
        c.form, newton.u, certify::equilibrate<dim>(c.form, newton.u, newton.traction));
    if (level > 0) rates = {std::log2(last_total / eta.total_sharp), std::log2(last.osc / eta.global.osc)};
    last = eta.global;
    last_total = eta.total_sharp;
    fmt::print("{:>8} {:>10} {:>12.4e} {:>6.3f} {:>12.4e} {:>6.3f}\n", n, c.mesh.n_cells(), last_total,
               rates.total, last.osc, rates.oscillation);
  }
  return rates;
}

template <int dim>
void expect_rates(const Manufactured<dim>& solution, int p, int first, int levels)
{
  SCOPED_TRACE(solution.name);
  const BoundRates rates = finest_rates(solution, p, first, levels);
  EXPECT_NEAR(rates.total, p, 0.15);
  EXPECT_NEAR(rates.oscillation, p + 1, 0.15);
}

class BoundRates2D : public ::testing::TestWithParam<int>
{
};

TEST_P(BoundRates2D, Stick)
{
  expect_rates(smooth_stick(), GetParam(), 4, 3);
}

TEST_P(BoundRates2D, Slip)
{
  expect_rates(full_slip(2, 2), GetParam(), 4, 3);
}

TEST_P(BoundRates2D, SlipCoulomb)
{
  expect_rates(coulomb_slip(), GetParam(), 4, 3);
}

INSTANTIATE_TEST_SUITE_P(Degrees, BoundRates2D, ::testing::Range(1, 4));

TEST(BoundRates3D, TurningSlip)
{
  expect_rates(turning_slip(), 1, 2, 3);
  expect_rates(turning_slip(), 2, 2, 2);
}

/// Cells of all shapes in the box (0,2) x (0,1) (x (0,1)) rotated by `frame`; its sides stay flat.
template <int dim>
mesh::MeshData<dim> irregular_box(const Tensor<dim>& frame)
{
  const auto map = [&](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    for (int a = 0; a < dim; ++a)
      y[a] += 0.1 * std::sin(std::numbers::pi * x[a] / (a == 0 ? 2 : 1)) * std::cos(2 * x[(a + 1) % dim] + a);
    return frame * y;
  };
  return renumbered(mapped(structured<dim>(), map), 11);
}

/// Every component, not only the bound, is round-off.
void expect_nothing(const certify::BoundComponents& eta)
{
  constexpr double tolerance = 1e-11;
  EXPECT_LE(eta.osc, tolerance);
  EXPECT_LE(eta.str, tolerance);
  EXPECT_LE(eta.neu, tolerance);
  EXPECT_LE(eta.lin1, tolerance);
  EXPECT_LE(eta.cnt, tolerance);
  EXPECT_LE(eta.frc, tolerance);
  EXPECT_LE(eta.lin2n, tolerance);
  EXPECT_LE(eta.lin2t, tolerance);
}

template <int dim>
void constant_stress(const Tensor<dim>& frame, int p)
{
  for_all_states<dim>(frame,
                      [&](const AffineCase<dim>& exact, const Point<dim>& right, const Point<dim>&)
                      {
                        const DiscreteProblem<dim> c(irregular_box<dim>(frame),
                                                     affine_data<dim>(exact, right), affine_method(p));
                        const solve::NewtonResult<dim> newton = c.solve();
                        ASSERT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
                        const certify::Estimate eta = certify::estimate<dim>(
                            c.form, newton.u, certify::equilibrate<dim>(c.form, newton.u, newton.traction));
                        fmt::print("{:<20} {}D, p = {}: eta_tot {:.1e}\n", exact.name, dim, p, eta.total);
                        expect_nothing(eta.global);
                      });
}

class ConstantStress2D : public ::testing::TestWithParam<int>
{
};

TEST_P(ConstantStress2D, LeavesNoComponent)
{
  constant_stress<2>(Tensor<2>::Identity(), GetParam());
}

TEST_P(ConstantStress2D, LeavesNoComponentWhenTurned)
{
  constant_stress<2>(rotation<2>(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, ConstantStress2D, ::testing::Range(1, 5));

class ConstantStress3D : public ::testing::TestWithParam<int>
{
};

TEST_P(ConstantStress3D, LeavesNoComponent)
{
  constant_stress<3>(Tensor<3>::Identity(), GetParam());
}

TEST_P(ConstantStress3D, LeavesNoComponentWhenTurned)
{
  constant_stress<3>(rotation<3>(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, ConstantStress3D, ::testing::Range(1, 3));

}  // namespace

}  // namespace tribound::test
