#pragma once

/// @file effectivity.h
/// Bound and dual norm of Newton iterates, for the tests of the effectivity.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "certify/equilibrate.h"
#include "certify/estimate.h"
#include "certify/true_error.h"
#include "support/discrete_case.h"
#include "support/meshes.h"

namespace tribound::test
{

struct NamedText
{
  std::string name;
  std::string text;
};

template <int dim>
struct NamedMesh
{
  std::string name;
  MeshData<dim> data;
};

/// What makes one case: its line in the table.
template <int dim>
struct EffectivityCase
{
  int degree;
  NamedText problem;  ///< TOML of everything but degree and mesh
  NamedMesh<dim> mesh;
};

/// Effectivities of the iterates 1, 2 and last.
struct Effectivities
{
  std::vector<double> of_iterates;
  bool converged = false;

  [[nodiscard]] double last() const { return of_iterates.back(); }
};

/// Prints a line of the table: bound / dual norm of each iterate.
template <int dim>
Effectivities effectivities(const EffectivityCase<dim>& which)
{
  DiscreteCase<dim> c(fmt::format("degree = {}\n", which.degree) + which.problem.text, which.mesh.data);
  DualNorm<dim> dual_norm(c.form, {.refinements = 2, .degree = which.degree + 2});
  Effectivities result;
  std::string line =
      fmt::format("{}D p = {}  {:<22} {:<12}", dim, which.degree, which.problem.name, which.mesh.name);
  const int all_steps = c.config.newton.max_steps;
  for (const int k : {1, 2, all_steps})
  {
    c.config.newton.max_steps = k;
    const NewtonResult<dim> newton = c.solve();
    const Estimate eta = estimate<dim>(c.form, newton.u, equilibrate<dim>(c.form, newton.u, newton.traction));
    const double below = dual_norm(newton.u);
    result.of_iterates.push_back(eta.total_sharp / below);
    result.converged = newton.status == NewtonStatus::converged;
    line += fmt::format("  k = {:<2} {:.4e} / {:.4e} = {:.4f}", newton.steps.size(), eta.total_sharp, below,
                        result.last());
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

/// The mesh without the cells whose centre is in a region, and without the vertices that only they have.
template <int dim, class Inside>
MeshData<dim> without(MeshData<dim> data, const Inside& inside)
{
  std::vector<Cell<dim>> kept;
  for (const Cell<dim>& cell : data.cells)
  {
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : cell) centre += data.vertices[v] / (dim + 1);
    if (!inside(centre)) kept.push_back(cell);
  }
  std::vector<Index> number(data.vertices.size(), -1);
  std::vector<Point<dim>> vertices;
  for (Cell<dim>& cell : kept)
    for (Index& v : cell)
    {
      if (number[v] < 0)
      {
        number[v] = static_cast<Index>(vertices.size());
        vertices.push_back(data.vertices[v]);
      }
      v = number[v];
    }
  std::set<std::set<Index>> facets;
  for (const Cell<dim>& cell : kept)
    for (int i = 0; i <= dim; ++i)
    {
      const auto facet = facet_vertices(cell, i);
      facets.emplace(facet.begin(), facet.end());
    }
  std::erase_if(data.facets,
                [&](TaggedFacet<dim>& facet)
                {
                  for (Index& v : facet.vertices) v = number[v];
                  return !facets.contains(std::set<Index>(facet.vertices.begin(), facet.vertices.end()));
                });
  data.vertices = std::move(vertices);
  data.regions.assign(kept.size(), 0);
  data.cells = std::move(kept);
  return data;
}

}  // namespace tribound::test
