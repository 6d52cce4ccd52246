#pragma once

/// @file random_pair.h
/// Two bodies that touch: random meshes, shapes, materials, laws and gaps.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "support/meshes.h"
#include "support/problem_data.h"

namespace tribound::test
{

/// A pair of random blocks, the upper one on the lower one.
template <int dim>
class RandomPair
{
 public:
  explicit RandomPair(unsigned seed) : random_(seed) {}

  /// What makes the two bodies one system; changes the state of the generator.
  [[nodiscard]] std::pair<mesh::MeshData<dim>, ProblemData<dim>> make()
  {
    const bool is_flat = pick(3) == 0;
    const bool is_turned = !is_flat && pick(2) == 0;
    const double gap = pick(3) == 0 ? within(-0.02, 0.02) : 0;  // of the meshes
    mesh::MeshData<dim> data = side_by_side(upper(gap), lower(), "_below");
    if (!is_flat)
    {
      const double bend = is_turned ? 0 : within(-0.15, 0.15);
      data = mapped<dim>(std::move(data),
                         [&](Point<dim> x) -> Point<dim>
                         {
                           x[1] += bend * std::sin(1.3 * x[0]);
                           return is_turned ? Point<dim>(rotation<dim>() * x) : x;
                         });
    }
    data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
    if (pick(2) == 0) std::swap(data.interfaces[0].sides[0], data.interfaces[0].sides[1]);
    const auto& [slave, master] = data.interfaces[0].sides;
    ProblemData<dim> problem{
        .boundaries = {clamped<dim>("bottom_below"), loaded<dim>("top", 0.02, -0.1)},
        .material = lame(1, 0.3),
        .regions = {{.name = "box_below", .material = lame(std::pow(10.0, within(-4, 4)), within(0, 0.4))}},
        .pairs = {pair<dim>(slave[0], master[0], law())}};
    problem.boundaries.push_back(pick(3) == 0 && !is_turned ? fixed<dim>("left", 0.0, free)
                                                            : clamped<dim>("left"));
    if (pick(2) == 0) problem.boundaries.push_back(loaded<dim>("right", 0.06, formula("0.05*x")));
    problem::Contact& contact = problem.pairs[0].contact;
    if (cone(contact.law).is_tied)
      contact.gap = problem::Field(0.0);
    else if (const int kind = pick(4); kind == 0)
      contact.gap = problem::Field(within(-0.02, 0.02));
    else if (kind == 1)
      contact.gap = formula("0.03*(x - 0.9)^2 - 0.002");
    else
      contact.gap.reset();
    return {std::move(data), std::move(problem)};
  }

  [[nodiscard]] int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  [[nodiscard]] double within(double from, double to)
  {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

 private:
  [[nodiscard]] std::array<int, dim> cells()
  {
    if constexpr (dim == 2)
    {
      const int n = std::array{2, 3, 5, 9, 16}[pick(5)];
      return {n, std::max(1, n / 2)};
    }
    else
      return {1 + pick(3), 1, 1 + pick(2)};
  }
  [[nodiscard]] mesh::MeshData<dim> upper(double gap)
  {
    Point<dim> from = Point<dim>::Zero();
    Point<dim> to = Point<dim>::Ones();
    from[1] = gap;
    to[0] = 2;
    return box<dim>(from, to, cells());
  }
  /// Sometimes aside, so that neither side covers the other.
  [[nodiscard]] mesh::MeshData<dim> lower()
  {
    Point<dim> from = Point<dim>::Zero();
    Point<dim> to = Point<dim>::Ones();
    from[1] = -1;
    to[1] = 0;
    to[0] = 2;
    for (const int i : {0, dim - 1})
      if (i != 1 && pick(2) == 0)
      {
        from[i] += within(-0.6, 0.6);
        to[i] += within(-0.3, 0.7);
      }
    return box<dim>(from, to, cells());
  }
  [[nodiscard]] problem::ContactLaw law()
  {
    switch (pick(4))
    {
      case 0:
        return Frictionless();
      case 1:
        return Tresca(within(0.005, 0.05));
      case 2:
        return Coulomb(within(0.1, 0.6));
      default:
        return Tied();
    }
  }

  std::mt19937 random_;
};

}  // namespace tribound::test
