#pragma once

/// @file box_sides.h
/// Boxes with a condition on each side, and choices of conditions in which every combination on neighbouring
/// sides occurs. For tests.

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"

namespace tribound::test
{

/// What holds on a side; a roller fixes one Cartesian component.
enum class Side
{
  contact,
  neumann,
  dirichlet,
  roller_x,
  roller_y,
  roller_z
};

/// In the order of the box's names: left right bottom top (back front).
template <int dim>
using Sides = std::array<Side, 2 * static_cast<std::size_t>(dim)>;

[[nodiscard]] inline bool fixes(Side side, int component)
{
  return side == Side::dirichlet || static_cast<int>(side) == static_cast<int>(Side::roller_x) + component;
}

/// Such as "left C right N bottom D top x".
template <int dim>
[[nodiscard]] std::string describe(const Sides<dim>& sides)
{
  std::string text;
  for (std::size_t s = 0; s < sides.size(); ++s)
    text += fmt::format("{} {} ", side_names<dim>[s], "CNDxyz"[static_cast<int>(sides[s])]);
  return text;
}

/// What holds on all sides. The prescribed displacement is one field on all of them; what is free carries a
/// traction that is no polynomial.
template <int dim>
[[nodiscard]] std::vector<problem::BoundaryCondition<dim>> side_conditions(const Sides<dim>& sides,
                                                                           const problem::Contact& contact)
{
  const std::array displacement{"0.01*sin(x + 2*y)", "-0.01*cos(2*x)*y", "0.01*x*y"};
  const std::array traction{"0.03*cos(2*x + y)", "-0.05*exp(0.5*x)", "0.02*sin(x + y)"};
  std::vector<problem::BoundaryCondition<dim>> conditions;
  for (std::size_t s = 0; s < sides.size(); ++s)
  {
    problem::BoundaryCondition<dim>& condition = conditions.emplace_back();
    condition.name = side_names<dim>[s];
    if (sides[s] == Side::contact)
      condition.contact = contact;
    else
      for (int a = 0; a < dim; ++a)
        if (fixes(sides[s], a))
          condition.displacement[a] = formula(displacement[a]);
        else
          condition.traction[a] = formula(traction[a]);
  }
  return conditions;
}

/// Whether the fixed components leave no rigid motion of the box (0,2) x (0,1) (x (0,1)) turned by `frame`.
template <int dim>
[[nodiscard]] bool holds(const Sides<dim>& sides, const Tensor<dim>& frame)
{
  constexpr int n = dim + dim * (dim - 1) / 2;
  Eigen::Matrix<double, n, n> gram = Eigen::Matrix<double, n, n>::Zero();
  for (int s = 0; s < 2 * dim; ++s)
    for (int corner = 0; corner < 1 << dim; ++corner)
    {
      if ((corner >> (s / 2) & 1) != s % 2) continue;
      Point<dim> x;
      for (int a = 0; a < dim; ++a) x[a] = (corner >> a & 1) * (a == 0 ? 2 : 1);
      x = (frame * x).eval();
      for (int a = 0; a < dim; ++a)
      {
        if (!fixes(sides[s], a)) continue;
        Eigen::Matrix<double, n, 1> row = Eigen::Matrix<double, n, 1>::Zero();
        row[a] = 1;
        for (int i = 0, k = dim; i < dim; ++i)
          for (int j = 0; j < i; ++j, ++k) row[k] = a == i ? x[j] : (a == j ? -x[i] : 0);
        gram += row * row.transpose();
      }
    }
  return Eigen::FullPivLU<Eigen::Matrix<double, n, n>>(gram).isInvertible();
}

/// A combination: the conditions on two sides that meet and where they meet.
using Meeting = std::array<int, 4>;

/// 2D: two sides in anticlockwise order, at a corner with one cell or with two (lower left, upper right).
[[nodiscard]] inline std::set<Meeting> meetings(const Sides<2>& s)
{
  const auto [left, right, bottom, top] = s;
  const auto meet = [](Side a, Side b, int cells) -> Meeting {
    return {static_cast<int>(a), static_cast<int>(b), cells, 0};
  };
  return {meet(left, bottom, 2), meet(bottom, right, 1), meet(right, top, 2), meet(top, left, 1)};
}

/// 3D: the twelve edges, told apart by the axes of the two normals.
[[nodiscard]] inline std::set<Meeting> meetings(const Sides<3>& s)
{
  std::set<Meeting> result;
  for (int a = 0; a < 6; ++a)
    for (int b = a + 1; b < 6; ++b)
      if (a / 2 != b / 2) result.insert({static_cast<int>(s[a]), static_cast<int>(s[b]), a / 2, b / 2});
  return result;
}

/// Few choices of sides, none leaving a rigid motion, that contain every combination: greedily the choice
/// that adds most.
template <int dim>
[[nodiscard]] std::vector<Sides<dim>> covering_sides(const Tensor<dim>& frame = Tensor<dim>::Identity())
{
  constexpr int n_kinds = 3 + dim;
  std::vector<std::pair<Sides<dim>, std::set<Meeting>>> candidates;
  Sides<dim> sides;
  int n = 1;
  for (int s = 0; s < 2 * dim; ++s) n *= n_kinds;
  std::set<Meeting> open;
  for (int code = 0; code < n; ++code)
  {
    for (int s = 0, digits = code; s < 2 * dim; ++s, digits /= n_kinds)
      sides[s] = static_cast<Side>(digits % n_kinds);
    if (!holds<dim>(sides, frame)) continue;
    candidates.emplace_back(sides, meetings(sides));
    open.insert(candidates.back().second.begin(), candidates.back().second.end());
  }
  std::vector<Sides<dim>> chosen;
  while (!open.empty())
  {
    std::size_t best = 0;
    std::size_t most = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i)
    {
      std::size_t gain = 0;
      for (const Meeting& meeting : candidates[i].second) gain += open.count(meeting);
      if (gain > most)
      {
        most = gain;
        best = i;
      }
    }
    for (const Meeting& meeting : candidates[best].second) open.erase(meeting);
    chosen.push_back(candidates[best].first);
  }
  return chosen;
}

}  // namespace tribound::test
