/// @file traction_test.cpp
/// Tractions, states and resultants of contact in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// A block whose flat bottom has the friction law, moved by (0.02, -0.1) and stretched upwards by 1 %. With
/// E = 1, nu = 0.25 in plane strain, lambda = mu = 0.4, sigma_yy = 1.2 * 0.01 and sigma_xy = 0. Facets have
/// length 0.5, so gamma = gamma_0 1.2 / 0.5.
struct FlatBlock
{
  explicit FlatBlock(const problem::ContactLaw& law)
      : c(renumbered(block<2>({4, 2}), 3),
          {.boundaries = {clamped<2>("top"), obstacle<2>("bottom", law, 0.04)}, .material = lame(1, 0.25)},
          {.degree = 2, .gamma0 = 20}),
        u(interpolate<2>(c.space, [](const Point<2>& x) { return Point<2>(0.02, -0.1 + 0.01 * x[1]); }))
  {
  }

  static constexpr double gamma = 20 * 1.2 / 0.5;
  static constexpr double normal = 0.012 - gamma * (0.1 - 0.04);  ///< P^n
  static constexpr double tangential = -gamma * 0.02;             ///< P^t along x

  DiscreteProblem<2> c;
  std::vector<double> u;
};

void expect_constant(std::span<const Point<2>> traction, const Point<2>& expected)
{
  ASSERT_FALSE(traction.empty());
  for (const Point<2>& t : traction) EXPECT_LE((t - expected).norm(), 1e-12) << t.transpose();
}

TEST(Traction, ClosedFormOnAFlatBottom)
{
  using F = FlatBlock;
  const auto traction = [](const problem::ContactLaw& law)
  {
    const FlatBlock block(law);
    return block.c.form.traction(block.u);
  };
  expect_constant(traction(Frictionless()), {0, -F::normal});
  expect_constant(traction(Tresca(5)), {F::tangential, -F::normal});
  expect_constant(traction(Tresca(0.3)), {-0.3, -F::normal});
  expect_constant(traction(Coulomb(0.5)), {F::tangential, -F::normal});
  expect_constant(traction(Coulomb(0.1)), {0.1 * F::normal, -F::normal});
}

TEST(Traction, ClosedAndStickingInTheFirstStep)
{
  using F = FlatBlock;
  const auto traction = [](const problem::ContactLaw& law, double scale)
  {
    const FlatBlock block(law);
    const std::vector<double> zero(block.u.size(), 0.0);
    return block.c.form.linearised_traction(contact::Linearisation::closed_sticking, zero,
                                            sum(zero, scale, block.u));
  };
  const Coulomb slippery(0.001);
  expect_constant(traction(Frictionless(), 1), {0, -F::normal});
  expect_constant(traction(slippery, 1), {F::tangential, -F::normal});
  // even where contact would open
  expect_constant(traction(slippery, 0), {0, -F::gamma * 0.04});
}

TEST(ContactStates, ClosedFormOnAFlatBottom)
{
  const FlatBlock block(Coulomb(0.1));
  const std::vector<Point<1>> middle{Point<1>(0.5)};
  const contact::SegmentTables<2> tables(block.c.space.basis(), block.c.form.segments(), middle);
  for (int k = 0; k < 4; ++k)
  {
    const auto states = block.c.form.contact_states(block.u, k, tables[k]);
    ASSERT_EQ(states.size(), 1u);
    EXPECT_NEAR(std::fmod(states[0].point[0], 0.5), 0.25, 1e-14);
    EXPECT_LE((states[0].normal - Point<2>(0, -1)).norm(), 1e-14);
    EXPECT_NEAR(states[0].pressure, -FlatBlock::normal, 1e-12);
    EXPECT_NEAR(states[0].limit, -0.1 * FlatBlock::normal, 1e-12);
    EXPECT_EQ(states[0].status, problem::ContactStatus::slip);
    EXPECT_NEAR(states[0].gap, 0.04 - 0.1, 1e-14);
    EXPECT_LE((states[0].slip - Point<2>(0.02, 0)).norm(), 1e-14);
  }
}

TEST(ContactResultants, OfAConstantTraction)
{
  const FlatBlock block((Frictionless()));
  const std::vector<Point<2>> t(block.c.form.n_contact_points(), Point<2>(0.3, 0.5));
  const contact::ContactResultants<2> sum = contact::contact_resultants<2>(block.c.form, t);
  EXPECT_LE((sum.force - Point<2>(0.6, 1.0)).norm(), 1e-13);
  EXPECT_NEAR(sum.normal, -1.0, 1e-13);
  EXPECT_NEAR(sum.tangential, 0.6, 1e-13);  // n = (0, -1) turned by +90 degrees is (1, 0)
  EXPECT_NEAR(sum.abs_tangential, 0.6, 1e-13);
  EXPECT_NEAR(sum.abs_normal, 1.0, 1e-13);
  EXPECT_EQ(contact::contact_resultants<2>(block.c.form, t, 99).normal, 0);
}

}  // namespace

}  // namespace tribound::test
