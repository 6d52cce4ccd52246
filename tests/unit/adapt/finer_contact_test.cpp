/// @file finer_contact_test.cpp
/// Solutions carried to finer meshes for error bars: a changed function is noticed.

#include "tribound/adapt/finer_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "support/two_blocks.h"
#include "tribound/base/error.h"

namespace tribound::test
{

namespace
{

/// A block pressed on another one, which is held.
template <int dim>
ProblemData<dim> pressed_blocks()
{
  return {.boundaries = {clamped<dim>("left"), clamped<dim>("bottom_below"), loaded<dim>("top", 0.01, -0.1)},
          .pairs = {pair<dim>("bottom", "top_below", Tresca(0.03))}};
}

/// A wave plus a rigid motion; the lower block has half the amplitude, so contact opens and closes.
template <int dim>
std::vector<double> wave(const fem::LagrangeSpace<dim>& space, double motion)
{
  std::vector<double> height(space.n_nodes(), 0.05);
  for (Index c = 0; c < space.mesh().n_cells(); ++c)
    for (const Index node : space.cell_nodes(c))
      if (space.mesh().region(c) == 1) height[node] = 0.025;
  const std::vector<Point<dim>> points = space.node_points();
  std::vector<double> u;
  for (Index node = 0; node < space.n_nodes(); ++node)
    for (int a = 0; a < dim; ++a)
    {
      const Point<dim>& x = points[node];
      u.push_back(motion + height[node] * std::sin(5 * x[0] + 2 * x[1] + 3 * x[dim - 1] + a));
    }
  return u;
}

/// `finer(form, u)` represents u, and two swapped values in one cell are noticed. Large rigid motions, which
/// have no energy, are not an error.
template <int dim, class MakeFiner>
void expect_noticed(const DiscreteProblem<dim>& c, const MakeFiner& finer)
{
  for (const double motion : {0.0, 1e4})
  {
    const std::vector<double> u = wave<dim>(c.space, motion);
    const auto carried = finer(c.form, u);
    ASSERT_TRUE(carried) << dim << "D, p = " << c.space.degree();
    EXPECT_NO_THROW(adapt::require_carried<dim>(c.form, u, *carried));
    const auto nodes = carried->form->space().cell_nodes(0);
    std::swap(carried->u[dim * nodes[0]], carried->u[dim * nodes[1]]);
    EXPECT_THROW(adapt::require_carried<dim>(c.form, u, *carried), SolveError);
  }
}

TEST(FinerContact, AnotherFunctionIsNoticed)
{
  for (int p = 1; p <= 3; ++p)
  {
    expect_noticed<2>(DiscreteProblem<2>(two_blocks<2>(), pressed_blocks<2>(), {.degree = p}),
                      adapt::matching_contact<2>);
    expect_noticed<2>(DiscreteProblem<2>(matching_blocks<2>(2), pressed_blocks<2>(), {.degree = p}),
                      adapt::finer_contact<2>);
    if (p < 3)
      expect_noticed<3>(DiscreteProblem<3>(matching_blocks<3>(2), pressed_blocks<3>(), {.degree = p}),
                        adapt::finer_contact<3>);
  }
}

}  // namespace

}  // namespace tribound::test
