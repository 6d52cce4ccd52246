#pragma once

/// @file discrete_problem.h
/// Everything from the data of a problem up to the discrete problem.

#include <utility>

#include "support/problem_data.h"
#include "tribound/adapt/method.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/mesh.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{

template <int dim>
struct DiscreteProblem
{
  DiscreteProblem(mesh::Mesh<dim> m, const ProblemData<dim>& data,
                  const adapt::Method& options = {.degree = 1})
      : method(options),
        mesh(std::move(m)),
        problem(data.on(mesh)),
        space(mesh, method.degree),
        form(problem, space, method.gamma_0())
  {
  }
  DiscreteProblem(mesh::MeshData<dim> data, const ProblemData<dim>& problem,
                  const adapt::Method& options = {.degree = 1})
      : DiscreteProblem(mesh::Mesh<dim>(std::move(data)), problem, options)
  {
  }
  DiscreteProblem(const DiscreteProblem&) = delete;
  DiscreteProblem& operator=(const DiscreteProblem&) = delete;

  /// With T_delta for delta > 0.
  [[nodiscard]] solve::NewtonResult<dim> solve(double delta = 0,
                                               const solve::NewtonObserver<dim>& observer = {}) const
  {
    return solve_from({}, delta, observer);
  }
  [[nodiscard]] solve::NewtonResult<dim> solve_from(std::span<const double> start, double delta = 0,
                                                    const solve::NewtonObserver<dim>& observer = {}) const
  {
    return tribound::solve::solve<dim>(form, start, method.newton, method.solver, observer, delta);
  }

  adapt::Method method;  ///< what solve() obeys
  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  contact::NitscheForm<dim> form;
};

}  // namespace tribound::test
