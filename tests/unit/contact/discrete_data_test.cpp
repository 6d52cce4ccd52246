/// @file discrete_data_test.cpp
/// Data that jump exactly at a boundary.

#include "tribound/contact/nitsche/discrete_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// The sum of component 1 of the load vector.
template <int dim>
double vertical_load(const contact::NitscheForm<dim>& form)
{
  double sum = 0;
  for (std::size_t i = 1; i < form.load().size(); i += dim) sum += form.load()[i];
  return sum;
}

/// A formula selects the side y = 0.1: its facets are fully loaded, whatever the opposite vertex is.
TEST(DiscreteData, ASideInThePlaneOfASwitchIsLoadedFully)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const double top = 0.1 + 2.1 * (seed + 1) / 20;
    const DiscreteProblem<2> plane(renumbered(box<2>({0, 0.1}, {1, top}, {4, 1}), seed),
                                   {.boundaries = {fixed<2>("left", 0, free), clamped<2>("top"),
                                                   loaded<2>("bottom", 0, formula("y - 0.1 <= 0 ? 1 : 0"))}});
    EXPECT_NEAR(vertical_load(plane.form), 1, 1e-14) << top;
    const DiscreteProblem<3> space(
        renumbered(box<3>({0, 0.1, 0}, {1, top, 1}, {2, 1, 2}), seed),
        {.boundaries = {clamped<3>("top"), loaded<3>("bottom", 0, formula("y == 0.1 ? 1 : 0"))}});
    EXPECT_NEAR(vertical_load(space.form), 1, 1e-14) << top;
    for (std::size_t k = 0; k < space.mesh.boundary().size(); ++k)
      EXPECT_EQ(space.form.data().traction_remainder(k).mean, 0);
  }
}

/// On an inclined plane, rounding puts the points on either side: the remainders cover both decisions.
TEST(DiscreteData, ASwitchThatRoundingDecidesIsLeftToTheBound)
{
  const auto inclined = [](const Point<2>& x) { return Point<2>(x[0], x[1] + 0.1 + 0.5 * x[0]); };
  const DiscreteProblem<2> c(
      mapped(box<2>({0, 0}, {1, 1}, {3, 1}), inclined),
      {.boundaries = {clamped<2>("left"), loaded<2>("top", 0, formula("y >= 1.1 + 0.5*x ? 1 : 0")),
                      obstacle<2>("bottom", Tresca(formula("y > 0.1 + 0.5*x ? 0.3 : 0")))}});
  const double length = std::sqrt(1.25) / 3;
  for (std::size_t k = 0; k < c.mesh.boundary().size(); ++k)
  {
    const std::string& name = c.problem.boundary(c.mesh.boundary()[k].tag).name;
    if (name == "top")
    {
      EXPECT_GE(c.form.data().traction_remainder(k).mean, length * (1 - 1e-12));
    }
  }
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    for (const auto& part : c.form.data().contact_parts(k)) EXPECT_GE(part.strength, 0.15);
    EXPECT_FALSE(c.form.data().contact_parts(k).empty());
  }
}

/// A press fit without loads: its interference sets the scale of what is negligible, like a prescribed
/// displacement.
TEST(DiscreteData, AnInterferenceIsAnEffect)
{
  const auto density = [](const std::string& gap, double displacement)
  {
    const DiscreteProblem<2> c(box<2>({0, 0}, {1, 1}, {2, 2}),
                               {.boundaries = {fixed<2>("top", 0, displacement),
                                               obstacle<2>("bottom", Frictionless(), formula(gap))}});
    return c.form.data().contact_density();
  };
  EXPECT_EQ(density("0.01*exp(x)", 0), 0);
  const double displaced = density("0.01*exp(x)", 0.01 * std::exp(1));
  EXPECT_GT(displaced, 0);
  EXPECT_NEAR(density("-0.01*exp(x)", 0), displaced,
              0.05 * displaced);  // seen at points inside the facets
}

/// A gap is resolved as finely as its stress gamma g requires: not more for a nearly incompressible material,
/// where gamma is limited, and not less for a large gamma_0.
TEST(DiscreteData, GapsAreResolvedForThePenaltyInUse)
{
  const auto parts = [](double nu, std::optional<double> gamma0)
  {
    const DiscreteProblem<2> c(
        box<2>({0, 0}, {1, 1}, {2, 2}),
        {.boundaries = {fixed<2>("top", 0, -0.1),
                        obstacle<2>("bottom", Frictionless(), formula("0.01*(1 + sin(40*x))"))},
         .material = lame(1, nu)},
        {.degree = 1, .gamma0 = gamma0});
    return c.form.data().effort().parts;
  };
  EXPECT_GT(parts(0.3, 1e5), 2 * parts(0.3, {}));
  EXPECT_LE(parts(0.4999, {}), parts(0.485, {}));
}

}  // namespace

}  // namespace tribound::test
