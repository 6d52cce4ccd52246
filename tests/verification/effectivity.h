#pragma once

/// @file effectivity.h
/// Bound and dual norm of Newton iterates, for effectivity tests.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

template <int dim>
struct NamedProblem
{
  std::string name;
  ProblemData<dim> data;
};

template <int dim>
struct NamedMesh
{
  std::string name;
  mesh::MeshData<dim> data;
};

/// The data of one case, and its line in the table.
template <int dim>
struct EffectivityCase
{
  int degree;
  NamedProblem<dim> problem;
  NamedMesh<dim> mesh;
  double newton_tolerance = 1e-11;
};

/// Effectivities of iterates 1, 2 and the last, each with patches row by row and in the Arnold-Falk-Winther
/// spaces.
struct Effectivities
{
  std::vector<double> of_iterates;
  bool converged = false;

  [[nodiscard]] double last() const { return of_iterates.back(); }
};

/// Prints a line of the table: bound / dual norm of each iterate; with T_delta for delta > 0.
template <int dim>
Effectivities effectivities(const EffectivityCase<dim>& which, double delta = 0)
{
  DiscreteProblem<dim> c(which.mesh.data, which.problem.data,
                         {.degree = which.degree, .newton = {.tolerance = which.newton_tolerance}});
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = 2, .degree = which.degree + 2});
  Effectivities result;
  std::string line =
      fmt::format("{}D p = {}  {:<22} {:<12}", dim, which.degree, which.problem.name, which.mesh.name);
  const int all_steps = c.method.newton.max_steps;
  for (const int k : {1, 2, all_steps})
  {
    c.method.newton.max_steps = k;
    const solve::NewtonResult<dim> newton = c.solve(delta);
    const double below = dual_norm(newton.u);
    line += fmt::format("  k = {:<2}", newton.steps.size());
    for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
    {
      const certify::Estimate eta = certify::estimate<dim>(
          c.form, newton.u, certify::equilibrate<dim>(c.form, newton.u, newton.traction, 0, delta, kind));
      result.of_iterates.push_back(eta.total_sharp / below);
      line += fmt::format(" {:.4e} / {:.4e} = {:.4f}", eta.total_sharp, below, result.last());
    }
    if (delta == 0 &&
        !c.problem.has_rigid_parts())  // sums over patches need not be ordered, nor moments left
    {
      EXPECT_LE(*(result.of_iterates.end() - 2), result.last()) << "row by row, k = " << k;
    }
    result.converged = newton.status == solve::NewtonStatus::converged;
  }
  std::cout << line << std::endl;
  return result;
}

/// The guarantee, at every iterate.
inline void expect_guaranteed(const Effectivities& found, const std::string& name)
{
  EXPECT_TRUE(found.converged) << name;
  for (const double e : found.of_iterates) EXPECT_GE(e, 1.0) << name;
}

}  // namespace tribound::test
