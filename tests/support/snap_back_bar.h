#pragma once

/// @file snap_back_bar.h
/// A bar that snaps back when the bond at its foot breaks: a load path with a peak.

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "support/problem_data.h"
#include "support/two_blocks.h"
#include "tribound/adapt/method.h"

namespace tribound::test
{

namespace snap_back
{
constexpr double ft = 2;
constexpr double Gc = 6e-4;
constexpr double critical = 2 * Gc / ft;
}  // namespace snap_back

/// A bar of length 1 on a bond, pulled at its top by t: the bond softens three times as fast as the bar is
/// stiff.
template <int dim>
struct Bar
{
  explicit Bar(int degree,
               problem::ContactLaw law = problem::JointLaw({.tension = {snap_back::ft, snap_back::Gc}}))
      : mesh(block<dim>({2, 6}, {1, 2, 1})), problem(data(std::move(law)).on(mesh::Mesh<dim>(mesh)))
  {
    method.degree = degree;
    method.newton.tolerance = 1e-12;
    method.stopping.criterion = adapt::Stopping::last_bounded;
  }

  static ProblemData<dim> data(problem::ContactLaw law)
  {
    std::array<std::optional<problem::Field>, dim> top;
    top[1] = formula("t");
    ProblemData<dim> data;
    data.boundaries = {problem::with_displacement<dim>("top", top),
                       problem::with_contact<dim>("bottom", std::move(law))};
    data.regions = {{.name = "box", .material = material()}};
    for (const char* side :
         dim == 2 ? std::vector{"left", "right"} : std::vector{"left", "right", "front", "back"})
    {
      std::array<std::optional<problem::Field>, dim> held;
      held[side[0] == 'f' || side[0] == 'b' ? 2 : 0] = problem::Field(0.0);
      data.boundaries.push_back(problem::with_displacement<dim>(side, held));
    }
    return data;
  }
  static problem::Material material() { return problem::lame(1000, 0.2, problem::PlaneModel::strain); }

  mesh::MeshData<dim> mesh;
  problem::Problem<dim> problem;
  adapt::Method method{};
};

}  // namespace tribound::test
