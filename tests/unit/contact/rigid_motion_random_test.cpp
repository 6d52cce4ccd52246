/// @file rigid_motion_random_test.cpp
/// Random loads that contact tractions balance are never refused.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "unit/contact/rigid_motion_testing.h"

namespace tribound::test
{

namespace
{

/// A box with a condition on each side, or two boxes in contact with each other; turned, so that no side is
/// parallel to an axis.
template <int dim>
struct RandomCase
{
  bool two;
  std::mt19937 random;
  double pick(double from, double to) { return std::uniform_real_distribution<>(from, to)(random); }

  problem::BoundaryCondition<dim> side(const std::string& name)
  {
    switch (random() % 5)
    {
      case 0:
        return obstacle<dim>(name);
      case 1:
        return obstacle<dim>(name, Tresca(pick(0, 1)));
      case 2:
        return obstacle<dim>(name,
                             Tresca(formula(fmt::format("x > {} ? 0.2 : {}*x^2", pick(0, 2), pick(0, 1)))));
      case 3:
        return obstacle<dim>(name, Coulomb(pick(0, 1)));
      default:
        return loaded<dim>(name, 0, 0);
    }
  }

  ProblemData<dim> problem()
  {
    ProblemData<dim> data;
    for (const std::string name : side_names<dim>)
    {
      if (!two || name != "top") data.boundaries.push_back(side(name));
      if (two && name != "bottom") data.boundaries.push_back(side(name + "_up"));
    }
    if (!two) return data;
    const std::array<problem::ContactLaw, 4> laws = {Frictionless(), Tresca(pick(0, 1)), Coulomb(pick(0, 1)),
                                                     Tied()};
    data.pairs = {pair<dim>("top", "bottom_up", laws[random() % laws.size()])};
    return data;
  }

  mesh::MeshData<dim> mesh()
  {
    Tensor<dim> turn = Tensor<dim>::Identity();
    const double angle = pick(0, 6.28);
    turn.topLeftCorner(2, 2) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    mesh::MeshData<dim> bodies = []
    {
      if constexpr (dim == 2)
        return block();
      else
        return brick();
    }();
    if (two)
    {
      const Point<dim> step = 1.1 * Point<dim>::Unit(1) + pick(-1, 1) * Point<dim>::Unit(0);
      bodies = side_by_side(bodies,
                            mapped<dim>(block<dim>({3, 1}, {1, 1, 2}),
                                        [&](const Point<dim>& x) -> Point<dim> { return x + step; }),
                            "_up");
    }
    return mapped<dim>(bodies, [&](const Point<dim>& x) -> Point<dim> { return turn * x; });
  }

  /// A traction that contact can exert, often a largest one.
  Point<dim> traction(const problem::ContactLaw& law, const contact::ContactPoint<dim>& point)
  {
    const Point<dim>& n = point.normal;
    if (problem::cone(law).is_tied) return Point<dim>::Random();
    const double pressure = random() % 2 == 0 ? 0 : std::pow(pick(0, 1), 4);
    double limit = 0;
    if (const auto* tresca = std::get_if<problem::Tresca>(&law)) limit = tresca->threshold(point.x);
    if (const auto* coulomb = std::get_if<problem::Coulomb>(&law)) limit = coulomb->coefficient * pressure;
    const Point<dim> any = Point<dim>::Random();
    const Point<dim> direction = (any - any.dot(n) * n).normalized();
    return -pressure * n + (random() % 2 == 0 ? limit : pick(0, limit)) * direction;
  }
};

bool refused(const std::string& verdict)
{
  return verdict.find("contact cannot hold") != std::string::npos;
}

/// Loads that are in equilibrium with tractions which the contact laws allow are never refused.
template <int dim>
void never_refused(int n_cases, bool two)
{
  int tried = 0;
  for (int i = 0; i < n_cases; ++i)
  {
    RandomCase<dim> any{two, std::mt19937(i)};
    const ProblemData<dim> data = any.problem();
    const DiscreteProblem<dim> c(any.mesh(), data);
    // In a third of the cases all friction pulls in one direction as hard as it can.
    const Point<dim> pull = Point<dim>::Random();
    std::vector<Point<dim>> t;
    for (const contact::ContactPoint<dim>& point : c.form.contact_points())
    {
      const std::size_t segment = t.size() / c.form.n_segment_points();
      t.push_back(any.traction(c.form.segments()[segment].contact->law, point));
      const Point<dim>& n = point.normal;
      const Point<dim> along = pull - pull.dot(n) * n;
      const Point<dim> friction = t.back() - t.back().dot(n) * n;
      if (i % 3 == 0) t.back() += friction.norm() * along.normalized() - friction;
    }
    std::vector<double> load(c.space.n_dofs(), 0.0);
    c.form.add_contact_load(t, load);
    for (double& entry : load) entry = -entry;
    const std::string said = verdict<dim>(c, load);
    tried += said == "held";
    EXPECT_FALSE(refused(said)) << "case " << i << ": " << said;
  }
  EXPECT_GT(tried, n_cases / 2) << "most cases leave a motion free";
  fmt::print("{}D, {}: {} cases with a solution, all held\n", dim, two ? "two bodies" : "one body", tried);
}

TEST(RigidMotion, RefusesNothingThatHasASolution)
{
  for (const bool two : {false, true})
  {
    never_refused<2>(500, two);
    never_refused<3>(100, two);
  }
}

}  // namespace

}  // namespace tribound::test
