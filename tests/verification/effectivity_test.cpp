/// @file effectivity_test.cpp
/// The bound is above the dual norm of the residual, and not far above: on every mesh, at every iterate.
///
/// Results. At convergence, with cells of about the same size in all directions, the effectivity is 1.25 to
/// 1.6, whatever the degree, the friction law and the singularities (clamped corners, re-entrant corner).
/// Before convergence it reaches 2.8: by the triangle inequality sigma_lin enters the bound three times
/// (lin1, lin2n, lin2t), but the residual once. Two things raise it at convergence.
///
/// A bent contact boundary (the distorted mesh, 1.35 to 1.5): the normal jumps between facets, and P^n with
/// it. For p = 3 without friction cnt is half of the bound there, on the box a fifth.
///
/// Stretched cells, above all for p = 1: without friction 2.8, 4.5 and 6.6 for cells that are 2, 3 and 4
/// times as long as high, against 1.2 for squares; cells that are higher than long do no harm. This is the
/// price of working on patches: for scalar problems the estimate is efficient up to a factor 1 + C h_patch
/// max |grad psi_a|, which grows like the aspect ratio. The bound remains a bound, and only that is tested on
/// such cells.

#include <fmt/format.h>

#include "effectivity.h"

namespace tribound::test
{

namespace
{

NamedProblem<2> pulled(const std::string& name, const problem::ContactLaw& law, const problem::Field& gap = 0)
{
  return {name,
          {.boundaries = {clamped<2>("left"), loaded<2>("top", 0, -0.1), loaded<2>("right", 0.04, 0.03),
                          obstacle<2>("bottom", law, gap)},
           .body_force = {0.02, -0.05}}};
}

std::vector<NamedProblem<2>> problems()
{
  return {pulled("frictionless", Frictionless(), formula("0.03*x^2")), pulled("Tresca", Tresca(0.03)),
          pulled("Coulomb", Coulomb(0.4), formula("0.004*x^2"))};
}

std::vector<NamedMesh<2>> meshes()
{
  const auto corner = [](const Point<2>& x) { return x[0] > 1 && x[1] > 0.5; };
  return {{"box 4x2", block<2>({4, 2})},
          {"box 8x4", block<2>({8, 4})},
          {"distorted", distorted(block<2>({5, 3}), 1)},
          {"L-shape", without(block<2>({6, 4}), corner)}};
}

class Effectivity2D : public ::testing::TestWithParam<int>
{
};

TEST_P(Effectivity2D, IsAtLeastOneAndModerate)
{
  for (const NamedProblem<2>& p : problems())
    for (const NamedMesh<2>& mesh : meshes())
    {
      const std::string name = fmt::format("p{} {} {}", GetParam(), p.name, mesh.name);
      const Effectivities found = effectivities<2>({GetParam(), p, mesh});
      expect_guaranteed(found, name);
      EXPECT_GE(found.last(), 1.1) << name;
      EXPECT_LE(found.last(), 1.7) << name;
    }
}

TEST_P(Effectivity2D, IsAtLeastOneOnStretchedCells)
{
  for (const NamedProblem<2>& p : problems())
    for (const auto& [nx, ny] : {std::pair{2, 4}, {8, 2}})
    {
      const NamedMesh<2> mesh{fmt::format("box {}x{}", nx, ny), block<2>({nx, ny})};
      expect_guaranteed(effectivities<2>({GetParam(), p, mesh}), p.name + " " + mesh.name);
    }
}

/// Loads, gap, threshold and displacement vary; only the displacement is in the spaces of the method.
TEST_P(Effectivity2D, IsAtLeastOneWithDataThatAreNotPolynomials)
{
  const auto varying = [](const std::string& name, const problem::ContactLaw& law) -> NamedProblem<2>
  {
    return {name,
            {.boundaries = {fixed<2>("left", formula("0.01*y"), free),
                            loaded<2>("top", 0, formula("-0.1*cos(2*x)^2")),
                            pressed<2>("right", formula("0.05*exp(y)")),
                            obstacle<2>("bottom", law, formula("0.01*(1-cos(x))"))},
             .body_force = {formula("0.05*sin(3*y)"), formula("-0.05*exp(x-y)")}}};
  };
  for (const NamedProblem<2>& p : {varying("Tresca, varying", Tresca(formula("0.02*(1+sin(4*x))"))),
                                   varying("Coulomb, varying", Coulomb(0.3))})
    for (const NamedMesh<2>& mesh : meshes())
      expect_guaranteed(effectivities<2>({GetParam(), p, mesh}), p.name + " " + mesh.name);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Effectivity2D, ::testing::Range(1, 4));

}  // namespace

}  // namespace tribound::test
