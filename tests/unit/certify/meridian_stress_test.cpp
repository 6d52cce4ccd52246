/// @file meridian_stress_test.cpp
/// The equilibrated stress of axisymmetric problems: its identities, and that it does not depend on threads.

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/residual.h"
#include "unit/certify/meridian_testing.h"

namespace tribound::test
{

namespace
{

/// sum_a y_a with y_a int_{omega_a} r = <R, psi_a e_z>, at the vertices without a facet that fixes u_z.
certify::AffineFields<2> remainder(const MeridianProblem& c, std::span<const double> u,
                                   std::span<const Point<2>> t)
{
  const std::vector<double> residual = contact::unconstrained_residual<2>(c.form, u, t);
  std::vector<double> force(c.mesh.n_vertices(), 0.0);
  std::vector<double> radius(c.mesh.n_vertices(), 0.0);
  std::vector<char> fixed(c.mesh.n_vertices(), 0);
  std::vector<char> visited(c.space.n_nodes(), 0);
  for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
    for (const Index v : mesh::facet_vertices(c.mesh.cell(facet.cell), facet.local))
      if (c.problem.boundary(facet.tag).fixes(1)) fixed[v] = 1;
  for (Index k = 0; k < c.mesh.n_cells(); ++k)
  {
    const mesh::Cell<2>& cell = c.mesh.cell(k);
    for (int i = 0; i < 3; ++i)
      radius[cell[i]] += mesh::cell_map(c.mesh, k).measure() *
                         (c.mesh.vertex(cell[0])[0] + c.mesh.vertex(cell[1])[0] + c.mesh.vertex(cell[2])[0]) /
                         3;
    for (int i = 0; i < c.space.basis().n_nodes(); ++i)
    {
      const Index node = c.space.cell_nodes(k)[i];
      if (std::exchange(visited[node], 1) != 0) continue;
      for (int v = 0; v < 3; ++v)
        force[cell[v]] += c.space.basis().node(i)[v] * residual[2 * node + 1] / c.space.degree();
    }
  }
  certify::AffineFields<2> rho(c.mesh.n_cells());
  for (Index k = 0; k < c.mesh.n_cells(); ++k)
  {
    double sum = 0;
    for (const Index v : c.mesh.cell(k)) sum += fixed[v] ? 0 : force[v] / radius[v];
    rho[k].fill(Point<2>(0, sum));
  }
  return rho;
}

class StressOfRevolution : public OnMeridians
{
};

TEST_P(StressOfRevolution, BalancesTheSolution)
{
  const MeridianProblem c(skew_mesh(axis(), 4), pressed(false), {.degree = degree()});
  const auto newton = c.solve();
  const certify::Stress<2> stress = certify::equilibrate<2>(c.form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<2>(c.form, newton.traction, stress).largest(), 1e-10);
}

TEST_P(StressOfRevolution, BalancesAnyDisplacement)
{
  for (const bool held : {false, true})
  {
    const MeridianProblem c(skew_mesh(axis(), 3), pressed(held), {.degree = degree()});
    const std::vector<double> u = any_displacement(c, 1);
    const std::vector<Point<2>> t = c.form.traction(any_displacement(c, 2));
    for (const double delta : {0.0, 0.05})
      for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
      {
        const certify::Stress<2> stress = certify::equilibrate<2>(c.form, u, t, 1, delta, kind);
        const certify::IdentityDefects defects =
            certify::check_identities<2>(c.form, t, stress, remainder(c, u, t));
        EXPECT_EQ(defects.is_symmetric, kind == certify::PatchStress::afw);
        EXPECT_LE(defects.largest(), 1e-12);
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, StressOfRevolution, meridians);

TEST(StressOfRevolution, DoesNotDependOnTheNumberOfThreads)
{
  const MeridianProblem c(skew_mesh(Axis::edges, 8), pressed(true), {.degree = 2});
  const std::vector<double> u = any_displacement(c, 1);
  const std::vector<Point<2>> t = c.form.traction(any_displacement(c, 2));
  const certify::Stress<2> alone = certify::equilibrate<2>(c.form, u, t, 1, 0.05);
  for (const int n_threads : {2, 3})
  {
    const certify::Stress<2> shared = certify::equilibrate<2>(c.form, u, t, n_threads, 0.05);
    EXPECT_EQ(shared.dis, alone.dis);
    EXPECT_EQ(shared.lin, alone.lin);
    EXPECT_EQ(shared.reg, alone.reg);
  }
}

TEST(StressOfRevolution, HasTheLinearisationAlone)
{
  const MeridianProblem c(skew_mesh(Axis::edges, 4), pressed(true), {.degree = 2});
  const std::vector<double> u = any_displacement(c, 1);
  const std::vector<Point<2>> t = c.form.traction(any_displacement(c, 2));
  const certify::Stress<2> whole = certify::equilibrate<2>(c.form, u, t);
  const certify::Stress<2> alone =
      certify::Equilibrator<2>(c.form, certify::PatchStress::rows).linearisation(u, t);
  EXPECT_TRUE(alone.dis.empty());
  EXPECT_EQ(alone.lin_block, whole.lin_block);
  EXPECT_LE(distance(alone.lin, whole.lin), 1e-13 * norm(whole.lin));
}

}  // namespace

}  // namespace tribound::test
