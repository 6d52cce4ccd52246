/// @file effectivity_3d_test.cpp
/// The bound is above the dual norm of the residual in 3D, at every iterate. The cells of the 3x2x2 box are a
/// third longer than wide, which raises the effectivity for p = 1 from 1.5 to 1.9: see effectivity_test.cpp.

#include <fmt/format.h>

#include "effectivity.h"

namespace tribound::test
{

namespace
{

NamedProblem<3> pulled(const std::string& name, const problem::ContactLaw& law, const problem::Field& gap = 0)
{
  return {name,
          {.boundaries = {clamped<3>("left"), fixed<3>("back", free, free), loaded<3>("top", 0, -0.1),
                          loaded<3>("right", 0.04, 0.03, 0.01), obstacle<3>("bottom", law, gap)},
           .body_force = {0.02, -0.05}}};
}

class Effectivity3D : public ::testing::TestWithParam<int>
{
};

TEST_P(Effectivity3D, IsAtLeastOne)
{
  const std::vector<NamedMesh<3>> meshes{{"box 2x1x1", block<3>({2, 1, 1})},
                                         {"distorted", distorted(block<3>({2, 1, 1}), 1)},
                                         {"box 3x2x2", block<3>({3, 2, 2})}};
  for (const NamedProblem<3>& p : {pulled("frictionless", Frictionless(), formula("0.03*x^2")),
                                   pulled("Tresca", Tresca(0.03)), pulled("Coulomb", Coulomb(0.4))})
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
