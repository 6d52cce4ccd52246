/// @file effectivity_test.cpp
/// The bound is above the dual norm of the residual, and not far above: on every mesh, at every iterate.
///
/// What the table says. At convergence, with cells of about the same size in all directions, the effectivity
/// is 1.25 to 1.6, whatever the degree, the friction law and the singularities (clamped corners, re-entrant
/// corner). Before convergence it reaches 2.8: sigma_lin enters the bound by the triangle inequality, three
/// times (lin1, lin2n, lin2t), and the residual once. Two things raise it at convergence.
///
/// A bent contact boundary (the distorted mesh, 1.35 to 1.5): the normal jumps from facet to facet, and P^n
/// with it. For p = 3 without friction cnt is half as large as the bound there, on the box a fifth.
///
/// Stretched cells, most of all for p = 1: without friction 2.8, 4.5 and 6.6 where the cells are 2, 3 and 4
/// times as long as high, against 1.2 for squares; cells that are higher than long do no harm. It is the
/// price of working on patches: for scalar problems the estimate is efficient up to a factor 1 + C h_patch
/// max |grad psi_a|, which grows like the aspect ratio. The bound remains a bound, and that alone is tested
/// on such cells.

#include <fmt/format.h>

#include "effectivity.h"

namespace tribound::test
{

namespace
{

NamedText problem(const std::string& name, const std::string& contact)
{
  return {name,
          "material = { E = 1.0, nu = 0.3 }\nnewton.tolerance = 1e-11\nload.body = [0.02, -0.05]\n"
          "boundary.left.displacement = [0, 0]\nboundary.top.traction = [0, -0.1]\n"
          "boundary.right.traction = [0.04, 0.03]\nboundary.bottom.contact = " +
              contact + "\n"};
}

std::vector<NamedText> problems()
{
  return {problem("frictionless", "{ gap = \"0.03*x^2\" }"),
          problem("Tresca", "{ friction = \"tresca\", threshold = 0.03 }"),
          problem("Coulomb", "{ friction = \"coulomb\", coefficient = 0.4, gap = \"0.004*x^2\" }")};
}

std::vector<NamedMesh<2>> meshes()
{
  const auto corner = [](const Point<2>& x) { return x[0] > 1 && x[1] > 0.5; };
  return {{"box 4x2", box<2>({0, 0}, {2, 1}, {4, 2})},
          {"box 8x4", box<2>({0, 0}, {2, 1}, {8, 4})},
          {"distorted", distorted(box<2>({0, 0}, {2, 1}, {5, 3}), 1)},
          {"L-shape", without(box<2>({0, 0}, {2, 1}, {6, 4}), corner)}};
}

class Effectivity2D : public ::testing::TestWithParam<int>
{
};

TEST_P(Effectivity2D, IsAtLeastOneAndModerate)
{
  for (const NamedText& p : problems())
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
  for (const NamedText& p : problems())
    for (const auto& [nx, ny] : {std::pair{2, 4}, {8, 2}})
    {
      const NamedMesh<2> mesh{fmt::format("box {}x{}", nx, ny), box<2>({0, 0}, {2, 1}, {nx, ny})};
      expect_guaranteed(effectivities<2>({GetParam(), p, mesh}), p.name + " " + mesh.name);
    }
}

/// Loads, gap, threshold and displacement vary; none but the displacement is in the spaces of the method.
TEST_P(Effectivity2D, IsAtLeastOneWithDataThatAreNotPolynomials)
{
  const std::string toml =
      "material = { E = 1.0, nu = 0.3 }\nnewton.tolerance = 1e-11\n"
      "load.body = [\"0.05*sin(3*y)\", \"-0.05*exp(x-y)\"]\n"
      "boundary.left.displacement = [\"0.01*y\", \"free\"]\nboundary.top.traction = [0, "
      "\"-0.1*cos(2*x)^2\"]\n"
      "boundary.right.pressure = \"0.05*exp(y)\"\nboundary.bottom.contact = ";
  const std::vector<NamedText> varying{
      {"Tresca, varying",
       toml + "{ friction = \"tresca\", threshold = \"0.02*(1+sin(4*x))\", gap = \"0.01*(1-cos(x))\" }\n"},
      {"Coulomb, varying",
       toml + "{ friction = \"coulomb\", coefficient = 0.3, gap = \"0.01*(1-cos(x))\" }\n"}};
  for (const NamedText& p : varying)
    for (const NamedMesh<2>& mesh : meshes())
      expect_guaranteed(effectivities<2>({GetParam(), p, mesh}), p.name + " " + mesh.name);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Effectivity2D, ::testing::Range(1, 4));

}  // namespace

}  // namespace tribound::test
