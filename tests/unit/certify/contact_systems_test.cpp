/// @file contact_systems_test.cpp
/// Systems that differ on the contact boundary alone: condensed from one factorisation, and one by one.

#include "tribound/certify/energy/contact_systems.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/algebra/cholesky.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::test
{

namespace
{

using certify::OnContact;

/// Springs of different stiffness along and across the contact boundary, coupled.
template <int dim>
algebra::Triplets springs(const contact::NitscheForm<dim>& form)
{
  algebra::Triplets entries;
  for (const Index i : solve::condensed_dofs(form).trace)
  {
    entries.add(i, i, 3.0 + i % dim);
    if (i % dim > 1) continue;
    if (const Index other = i % dim == 0 ? i + 1 : i - 1; form.constraints().fixed[other] == 0)
      entries.add(i, other, 0.5);
  }
  return entries;
}

template <int dim>
void expect_the_same(const DiscreteProblem<dim>& c, int n_factorisations)
{
  certify::ContactSystems<dim> shared(c.form, {}, true);
  certify::ContactSystems<dim> alone(c.form, {}, false);
  shared.set_springs(springs<dim>(c.form));
  alone.set_springs(springs<dim>(c.form));
  std::vector<std::vector<double>> loads;
  std::vector<std::vector<double>> starts;
  for (const unsigned seed : {3U, 5U})
  {
    loads.push_back(random_free_vector(c.form.constraints(), 1, seed));
    starts.push_back(random_free_vector(c.form.constraints(), 0.1, seed + 1));
  }
  std::array<int, 2> counts{};
  for (const OnContact how : {OnContact::free, OnContact::held, OnContact::springs, OnContact::held})
  {
    int before = algebra::n_factorisations();
    const std::vector<std::vector<double>> u = shared.solve(how, loads, starts, 1e-12);
    counts[0] += algebra::n_factorisations() - before;
    before = algebra::n_factorisations();
    const std::vector<std::vector<double>> v = alone.solve(how, loads, starts, 1e-12);
    counts[1] += algebra::n_factorisations() - before;
    for (std::size_t k = 0; k < v.size(); ++k)
      EXPECT_LE(norm(sum(u[k], -1, v[k])), 1e-9 * norm(v[k])) << "on contact: " << static_cast<int>(how);
  }
  EXPECT_EQ(counts[0], n_factorisations);
  EXPECT_EQ(counts[1], 3);
}

TEST(ContactSystems, ShareAFactorisationIn2D)
{
  for (const int p : {1, 2, 3})
    expect_the_same<2>({block<2>({16, 8}),
                        {.boundaries = {clamped<2>("left"), obstacle<2>("bottom", Tresca(0.02))}},
                        {.degree = p}},
                       1);
}

TEST(ContactSystems, AreSolvedOneByOneIn3D)
{
  expect_the_same<3>({block<3>({3, 2, 2}),
                      {.boundaries = {clamped<3>("left"), obstacle<3>("bottom", Tresca(0.02))}},
                      {.degree = 2}},
                     3);
}

}  // namespace

}  // namespace tribound::test
