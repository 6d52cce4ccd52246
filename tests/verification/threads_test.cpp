/// @file threads_test.cpp
/// Results of threaded computations are the same for any number of threads, to the last bit.

#include <gtest/gtest.h>
#include <omp.h>

#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/algebra/petsc.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::test
{

namespace
{

/// A slab with enough facets, nodes and cells that loops over each of them use threads.
template <int dim>
ProblemData<dim> slab(const problem::ContactLaw& law)
{
  return {.boundaries = {fixed<dim>("left", 0, formula("0.01*y")), loaded<dim>("top", 0.01, -0.1, 0.02),
                         obstacle<dim>("bottom", law, formula("0.002*x"))}};
}

template <int dim>
struct Results
{
  std::vector<double> stiffness;
  std::vector<double> product;
  std::vector<double> contact_tangent;
  std::vector<Point<dim>> traction;
  std::vector<double> norms;
  std::vector<double> identities;
};

template <int dim>
Results<dim> results(const DiscreteProblem<dim>& c, std::span<const double> u,
                     const certify::Stress<dim>& stress, int n_threads)
{
  omp_set_num_threads(n_threads);
  Results<dim> r;
  const algebra::SparseRows k = contact::stiffness(c.problem, c.space, c.form.constraints());
  r.stiffness = k.values;
  r.product = algebra::SparseMatrix(dim, k).multiply(u);
  r.contact_tangent = c.form.contact_tangent(contact::Linearisation::newton, u).values;
  r.traction = c.form.traction(u);
  const contact::StressNorms norms = contact::stress_norms(c.problem, c.space, u);
  r.norms = {norms.energy, norms.sigma};
  const certify::IdentityDefects d = certify::check_identities<dim>(c.form, r.traction, stress);
  r.identities = {d.divergence, d.jump, d.neumann, d.contact, d.symmetry};
  return r;
}

template <int dim>
void expect_the_same(mesh::MeshData<dim> mesh, int degree)
{
  const int available = omp_get_max_threads();
  const DiscreteProblem<dim> c(renumbered(std::move(mesh), 1), slab<dim>(Coulomb(0.3)), {.degree = degree});
  ASSERT_GE(c.space.n_nodes(), 15'000);  // three parts of the stiffness
  const std::vector<double> u = random_free_vector(c.form.constraints(), 0.01, 2);
  const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, u, c.form.traction(u), 1);
  const Results<dim> alone = results<dim>(c, u, stress, 1);
  EXPECT_GT(alone.norms[0], 0);
  for (const int n_threads : {2, 3})
  {
    const Results<dim> shared = results<dim>(c, u, stress, n_threads);
    EXPECT_EQ(shared.stiffness, alone.stiffness);
    EXPECT_EQ(shared.contact_tangent, alone.contact_tangent);
    EXPECT_EQ(shared.traction, alone.traction);
    EXPECT_EQ(shared.norms, alone.norms);
    EXPECT_EQ(shared.identities, alone.identities);
    // PETSc's product, used with one thread, may sum in another order.
    EXPECT_LE(norm(sum(shared.product, -1, alone.product)), 1e-14 * norm(alone.product));
  }
  omp_set_num_threads(available);
}

TEST(Threads, TheSameInThePlane)
{
  expect_the_same<2>(block<2>({2500, 2}), 2);
}

TEST(Threads, TheSameInSpace)
{
  expect_the_same<3>(block<3>({90, 90, 1}), 1);
}

}  // namespace

}  // namespace tribound::test
