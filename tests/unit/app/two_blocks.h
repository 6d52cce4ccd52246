#pragma once

/// @file two_blocks.h
/// A block above a wider one, at a distance; their meshes do not match.

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/penalty.h"

namespace tribound::test
{

template <int dim>
struct TwoBlocks
{
  static constexpr double distance = 0.1;
  static constexpr double pressed = 0.2;  ///< displacement of the top, downwards

  TwoBlocks(int degree, int n)
      : mesh(blocks(n)),
        problem(mesh,
                {{.name = "box", .material = lame(1, 0.3)}, {.name = "box_below", .material = lame(2, 0.2)}},
                {fixed<dim>("top", 0.0, -pressed), clamped<dim>("bottom_below")},
                {problem::ContactPair<dim>{
                    {"bottom"}, {"top_below"}, problem::Contact(Frictionless(), std::nullopt)}}),
        space(mesh, degree),
        form(problem, space, contact::default_gamma0(degree))
  {
  }

  /// The upper block is that of test::block(); the lower one is wider by 1/2 on all sides.
  static mesh::MeshData<dim> blocks(int n)
  {
    Point<dim> corner = Point<dim>::Ones();
    corner[0] = 2;
    Point<dim> low = Point<dim>::Constant(-0.5);
    low[1] = -1 - distance;
    Point<dim> high = corner + Point<dim>::Constant(0.5);
    high[1] = -distance;
    std::array<int, dim> upper;
    std::array<int, dim> lower;
    upper.fill(n);
    lower.fill(n + 1);
    return side_by_side(box<dim>(Point<dim>::Zero(), corner, upper), box<dim>(low, high, lower), "_below");
  }

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  contact::NitscheForm<dim> form;
};

}  // namespace tribound::test
