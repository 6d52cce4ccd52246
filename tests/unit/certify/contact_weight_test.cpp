/// @file contact_weight_test.cpp
/// Weights of contact forces beside fixed displacements.

#include "tribound/certify/energy/contact_weight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/mesh/refine.h"

namespace tribound::test
{

namespace
{

/// A block held at x = 0 on one that reaches from z = 0 to `end` alone: contact covers parts of the edges at
/// x = 0.
mesh::MeshData<3> on_narrow_block(double end)
{
  const mesh::MeshData<3> upper = box<3>(Point<3>(0, 0, 0), Point<3>(2, 1, 1), {2, 1, 2});
  const mesh::MeshData<3> lower = box<3>(Point<3>(0, -1, 0), Point<3>(2, 0, end), {3, 1, 2});
  mesh::MeshData<3> data = side_by_side(upper, lower, "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  return data;
}

/// Weights are linear on facets of the first mesh, which are 1 wide, and vanish at x = 0: they are at most as
/// large as x. On the refined mesh contact ends at a vertex of the first mesh or inside one of its edges.
TEST(ContactWeights, VanishAlongEdgesThatContactReachesInside)
{
  const ProblemData<3> data{
      .boundaries = {clamped<3>("left"), clamped<3>("bottom_below")},
      .pairs = {pair<3>("bottom", "top_below", problem::ContactLaw(problem::Frictionless()))}};
  for (const double end : {0.3, 0.5, 0.7, 0.9, 1.0})
  {
    SCOPED_TRACE(end);
    const mesh::Mesh<3> first(on_narrow_block(end));
    const DiscreteProblem<3> c(std::move(mesh::refine_uniformly(first, 1).mesh), data);
    const std::vector<char> junctions(c.space.n_dofs(), 0);
    certify::ContactResultant<3> resultant;
    resultant.motion.translation = Point<3>(0, 1, 0);
    const certify::ContactWeight<3> weight =
        certify::ContactWeights<3>(c.form, junctions)(c.form, resultant, 0.5);
    ASSERT_EQ(weight.reason, "");
    double largest = 0;
    for (std::size_t i = 0; i < weight.at_points.size(); ++i)
    {
      const double w = weight.at_points[i].norm();
      EXPECT_LE(w, c.form.contact_points()[i].x[0] + 1e-12);
      largest = std::max(largest, w);
    }
    EXPECT_NEAR(largest, 1, 1e-12);
  }
}

}  // namespace

}  // namespace tribound::test
