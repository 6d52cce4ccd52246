/// @file effectivity_3d_test.cpp
/// The bound is above the dual norm of the residual in 3D, at every iterate. The cells of the 3x2x2 box are a
/// third longer than wide, which for p = 1 raises the effectivity from 1.5 to 1.9: see effectivity_test.cpp.

#include <fmt/format.h>

#include "effectivity.h"

namespace tribound::test
{

namespace
{

NamedText problem(const std::string& name, const std::string& contact)
{
  return {name,
          "material = { E = 1.0, nu = 0.3 }\nnewton.tolerance = 1e-11\nload.body = [0.02, -0.05, 0]\n"
          "boundary.left.displacement = [0, 0, 0]\nboundary.back.displacement = [\"free\", \"free\", 0]\n"
          "boundary.top.traction = [0, -0.1, 0]\nboundary.right.traction = [0.04, 0.03, 0.01]\n"
          "boundary.bottom.contact = " +
              contact + "\n"};
}

class Effectivity3D : public ::testing::TestWithParam<int>
{
};

TEST_P(Effectivity3D, IsAtLeastOne)
{
  const std::vector<NamedMesh<3>> meshes{{"box 2x1x1", box<3>({0, 0, 0}, {2, 1, 1}, {2, 1, 1})},
                                         {"distorted", distorted(box<3>({0, 0, 0}, {2, 1, 1}, {2, 1, 1}), 1)},
                                         {"box 3x2x2", box<3>({0, 0, 0}, {2, 1, 1}, {3, 2, 2})}};
  for (const NamedText& p : {problem("frictionless", "{ gap = \"0.03*x^2\" }"),
                             problem("Tresca", "{ friction = \"tresca\", threshold = 0.03 }"),
                             problem("Coulomb", "{ friction = \"coulomb\", coefficient = 0.4 }")})
    for (const NamedMesh<3>& mesh : meshes)
    {
      const std::string name = fmt::format("p{} {} {}", GetParam(), p.name, mesh.name);
      const Effectivities found = effectivities<3>({GetParam(), p, mesh});
      expect_guaranteed(found, name);
    }
}

INSTANTIATE_TEST_SUITE_P(Degrees, Effectivity3D, ::testing::Range(1, 3));

}  // namespace

}  // namespace tribound::test
