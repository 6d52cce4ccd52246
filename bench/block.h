#pragma once

/// @file block.h
/// The problem of benchmarks of the certificate: a block on an obstacle, or two blocks on each other.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/mesh/box.h"

namespace tribound::bench
{

/// Squares or cubes across the height of the box, such that it has 100k triangles or tetrahedra; fewer
/// tetrahedra at higher degrees.
template <int dim>
int cells_across(int degree)
{
  if constexpr (dim == 2) return 158;                 // 99 856 triangles
  constexpr std::array tetrahedra = {20, 16, 11, 7};  // 96 000, 49 152, 15 972, 4 116
  return tetrahedra[degree - 1];
}

/// The distance between two bodies, so that a point determines its body; the gap is given as 0.
inline constexpr double apart = 0.01;

/// The block (0, 2) x (0, 1) [x (0, 1)] with n squares or cubes across. Or, with about as many cells in
/// total, two blocks of its size, one below the other, the lower one with one square or cube fewer across.
template <int dim>
mesh::Boxes blocks(int n, int bodies)
{
  if (bodies == 2) n = static_cast<int>(std::lround(n / std::pow(2.0, 1.0 / dim)));
  mesh::BoxMesh block{{0, 0}, {2, 1}, {2 * n, n}, {}};
  if constexpr (dim == 3) block = {{0, 0, 0}, {2, 1, 1}, {2 * n, n, n}, {}};
  mesh::Boxes result = {{"upper", block}};
  if (bodies == 1) return result;
  block.lower[1] = -1 - apart;
  block.upper[1] = -apart;
  block.cells = {2 * (n - 1), n - 1};
  if constexpr (dim == 3) block.cells.push_back(n - 1);
  result.push_back({"lower", block});
  return result;
}

/// Moves the vertices inside the boxes by up to a fifth of the mesh size: no two cells keep the same shape.
template <int dim>
void distort(mesh::MeshData<dim>& data, const mesh::Boxes& boxes)
{
  std::mt19937 generator(1);
  const double most = 0.2 / boxes[0].box.cells[1];
  std::uniform_real_distribution<double> shift(-most, most);
  for (Point<dim>& x : data.vertices)
  {
    const bool inside =
        std::ranges::any_of(boxes,
                            [&](const mesh::NamedBox& named)
                            {
                              const Eigen::Map<const Point<dim>> lower(named.box.lower.data());
                              const Eigen::Map<const Point<dim>> upper(named.box.upper.data());
                              return ((x - lower).array() > 1e-9).all() && ((upper - x).array() > 1e-9).all();
                            });
    for (int c = 0; c < dim; ++c)
      if (inside) x[c] += shift(generator);
  }
}

template <int dim>
mesh::Mesh<dim> block_mesh(int n, bool distorted, int bodies)
{
  const mesh::Boxes boxes = blocks<dim>(n, bodies);
  mesh::MeshData<dim> data = mesh::box_meshes<dim>(boxes);
  if (distorted) distort<dim>(data, boxes);
  return mesh::Mesh<dim>(std::move(data));
}

/// Clamped on the left, pressed with friction on a floor or on a second block that is clamped below.
template <int dim>
problem::Problem<dim> block_problem(const mesh::Mesh<dim>& mesh, int bodies)
{
  std::array<std::optional<problem::Field>, dim> zero;
  zero.fill(0.0);
  std::vector<problem::BoundaryCondition<dim>> conditions = {
      problem::with_displacement<dim>("upper.left", zero),
      problem::with_traction<dim>("upper.top", {0.0, -0.1})};
  std::vector<problem::ContactPair<dim>> pairs;
  const problem::Contact contact(problem::Tresca(0.03));
  if (bodies == 1)
    conditions.push_back(problem::with_contact<dim>("upper.bottom", contact.law));
  else
  {
    conditions.push_back(problem::with_displacement<dim>("lower.bottom", zero));
    pairs.push_back({.slave = {"upper.bottom"}, .master = {"lower.top"}, .contact = contact});
  }
  return problem::Problem<dim>(mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}}, conditions,
                               std::move(pairs));
}

/// A smooth displacement of the upper block and an unrelated traction: the cost of equilibrate() does not
/// depend on them, and the patch problems are solvable for any. The lower block does not move, so that
/// contact is like that with the floor.
template <int dim>
struct Block
{
  Block(int degree, bool distorted, int bodies) : Block(degree, distorted, bodies, cells_across<dim>(degree))
  {
  }
  Block(int degree, bool distorted, int bodies, int across)
      : mesh(block_mesh<dim>(across, distorted, bodies)),
        problem(block_problem(mesh, bodies)),
        space(mesh, degree),
        form(problem, space, contact::default_gamma0(degree))
  {
    for (const Point<dim>& x : space.node_points())
      for (int c = 0; c < dim; ++c)
        u.push_back(x[1] < -apart / 2 ? 0
                                      : x[0] * (0.02 * std::sin(3 * x[0] + x[dim - 1] + c) - 0.03 * x[1]));
    t = form.traction(u);
    for (Point<dim>& traction : t) traction *= 1.1;
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  contact::NitscheForm<dim> form;
  std::vector<double> u;
  std::vector<Point<dim>> t;
};

}  // namespace tribound::bench
