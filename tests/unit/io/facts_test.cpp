#include "tribound/io/record/facts.h"

#include <gtest/gtest.h>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{
namespace
{

TEST(Facts, MaterialInEngineersConstants)
{
  EXPECT_EQ(io::describe(problem::lame(2.1e5, 0.3, problem::PlaneModel::strain), 2),
            "E = 210000, nu = 0.3, plane strain");
  EXPECT_EQ(io::describe(problem::lame(2.1e5, 0.3, problem::PlaneModel::stress), 2),
            "E = 210000, nu = 0.3, plane stress");
  EXPECT_EQ(io::describe(problem::lame(1.0, -0.25, problem::PlaneModel::strain), 3), "E = 1, nu = -0.25");
}

TEST(Facts, NumbersInWordsCarryTheirUnits)
{
  const problem::Units units("mm", "N");
  EXPECT_EQ(io::describe(problem::lame(2.1e5, 0.3, problem::PlaneModel::strain), 3, units),
            "E = 210000 MPa, nu = 0.3");
  EXPECT_EQ(io::describe(loaded<2>(fixed<2>("left", 0.1, free), 0, 0.5), units),
            "displacement (0.1, free) mm, traction (0, 0.5) MPa");
  EXPECT_EQ(io::describe(obstacle<2>("bottom", Tresca(0.03), 0.25), units),
            "contact, Tresca friction, threshold 0.03 MPa, gap 0.25 mm");
}

TEST(Facts, MeshAndBoundary)
{
  const DiscreteProblem<2> box(
      block<2>({4, 2}),
      {.boundaries = {loaded<2>(fixed<2>("left", 0, free), 0, 0.5), loaded<2>("right", 0, formula("x*y")),
                      obstacle<2>("bottom", Tresca(0.03))}},
      {.degree = 2});
  const io::MeshFacts mesh = io::mesh_facts(box.problem, box.space, box.form.constraints());
  EXPECT_EQ(mesh.vertices, 15);
  EXPECT_EQ(mesh.cells, 16);
  EXPECT_EQ(mesh.free_dofs, 2 * 9 * 5 - 5);
  EXPECT_NEAR(mesh.smallest_cell, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(mesh.largest_cell, std::sqrt(0.5), 1e-15);
  ASSERT_EQ(mesh.regions.size(), 1u);
  EXPECT_EQ(mesh.regions[0].cells, 16);
  EXPECT_NEAR(mesh.regions[0].measure, 2.0, 1e-14);
  ASSERT_EQ(mesh.boundaries.size(), 4u);
  for (const io::BoundaryFacts& boundary : mesh.boundaries)
  {
    const bool side = boundary.name == "left" || boundary.name == "right";
    EXPECT_EQ(boundary.facets, side ? 2 : 4) << boundary.name;
    EXPECT_NEAR(boundary.measure, side ? 1.0 : 2.0, 1e-15) << boundary.name;
    const std::string expected = boundary.name == "left"    ? "displacement (0, free), traction (0, 0.5)"
                                 : boundary.name == "right" ? "traction (0, varies)"
                                 : boundary.name == "bottom"
                                     ? "contact, Tresca friction, threshold 0.03, gap 0"
                                     : "traction-free";
    EXPECT_EQ(boundary.condition, expected) << boundary.name;
  }
}

}  // namespace
}  // namespace tribound::test
