#pragma once

/// @file meridian_problem.h
/// Axisymmetric problems up to the discrete problem, and meshes of meridians.

#include <random>
#include <utility>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/adapt/method.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{

struct MeridianProblem
{
  MeridianProblem(mesh::MeshData<2> data, const ProblemData<2>& of, const adapt::Method& options)
      : method(options),
        mesh(std::move(data)),
        problem(of.on(mesh).axisymmetric()),
        space(mesh, method.degree),
        form(problem, space, method.gamma_0())
  {
  }
  MeridianProblem(const MeridianProblem&) = delete;
  MeridianProblem& operator=(const MeridianProblem&) = delete;

  [[nodiscard]] solve::NewtonResult<2> solve() const
  {
    return tribound::solve::solve<2>(form, {}, method.newton, method.solver, {}, 0);
  }

  adapt::Method method;  ///< what solve() obeys
  mesh::Mesh<2> mesh;
  problem::Problem<2> problem;
  fem::LagrangeSpace<2> space;
  contact::NitscheForm<2> form;
};

/// A rectangle of n x n squares from r = `inner` to 1 and of height 1, numbered at random, with vertices
/// moved at random along the sides and inside; the bottom and the axis stay straight.
inline mesh::MeshData<2> random_meridian(double inner, int n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-0.25 / n, 0.25 / n);
  const auto displaced = [&](const Point<2>& x) -> Point<2>
  {
    const double r = (1 - inner) * move(random);
    const double z = move(random);
    return {x[0] > inner && x[0] < 1 ? x[0] + r : x[0], x[1] > 0 && x[1] < 1 ? x[1] + z : x[1]};
  };
  return renumbered(mapped(box<2>({inner, 0}, {1, 1}, {n, n}), displaced), seed);
}

}  // namespace tribound::test
