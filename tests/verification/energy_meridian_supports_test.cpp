/// @file energy_meridian_supports_test.cpp
/// The energy bound of bodies of revolution on springs and sliders and with rigid parts, and intervals of
/// their quantities: against exact solutions, and in random cases against much richer ones.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/meridian_problem.h"
#include "tribound/certify/energy/free_motions.h"
#include "tribound/fem/evaluation.h"
#include "verification/meridian_energy.h"
#include "verification/quantities.h"

namespace tribound::test
{

namespace
{

problem::BoundaryCondition<2> springs(const std::string& name, problem::Field normal,
                                      problem::Field tangential, std::array<problem::Field, 2> rest = {})
{
  problem::BoundaryCondition<2> condition;
  condition.name = name;
  condition.spring = problem::Spring<2>{std::move(normal), std::move(tangential), std::move(rest)};
  return condition;
}

/// On the full circle.
problem::BoundaryCondition<2> rigid(const std::string& name, double force)
{
  problem::BoundaryCondition<2> condition;
  condition.name = name;
  condition.rigid.emplace();
  condition.rigid->force[1] = force;
  return condition;
}

/// A solution that depends on r alone: u_r, u_z and their derivatives.
struct RadialSolution
{
  std::function<Point<2>(double)> u;
  std::function<Point<2>(double)> slope;
};

/// ||u - u_h||_en of one radian, by quadrature.
double distance(const MeridianProblem& c, std::span<const double> u_h, const RadialSolution& exact)
{
  const fem::Quadrature<2> rule = fem::quadrature<2>(16);
  const fem::Tabulation<2> table = c.space.basis().tabulate(rule.points);
  double sum = 0;
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
  {
    const mesh::CellMap<2> map = mesh::cell_map(c.mesh, cell);
    const problem::Material& material = c.problem.material(c.mesh.region(cell));
    for (const auto& [q, x, dx] : fem::cell_points(map, rule))
    {
      Tensor<2> gradient =
          fem::gradient_at<2>(c.space.cell_nodes(cell), u_h, table.gradients_at(q), map.inverse_transpose);
      gradient.col(0) -= exact.slope(x[0]);
      const Tensor<2> strain = 0.5 * (gradient + gradient.transpose());
      const double hoop =
          (fem::value_at<2>(c.space.cell_nodes(cell), u_h, table.values_at(q))[0] - exact.u(x[0])[0]) / x[0];
      sum += dx * x[0] *
             (material.lambda * std::pow(strain.trace() + hoop, 2) +
              2 * material.mu * (strain.squaredNorm() + hoop * hoop));
    }
  }
  return std::sqrt(sum);
}

/// A solution with its numbers on the full circle.
struct ExactCase
{
  std::string name;
  ProblemData<2> data;
  RadialSolution solution;
  std::vector<problem::Quantity<2>> quantities;
  std::vector<double> values;
};

/// A tube of height 1 under the pressure 1 in the bore, on springs around it, below a slider: u_r = A r + B
/// / r.
ExactCase tube(double inner, double outer, double k)
{
  const problem::Material material = lame(1, 0.3);
  const auto& [lambda, mu] = std::pair(material.lambda, material.mu);
  Tensor<2> conditions;  // sigma_rr(a) = -1, sigma_rr(b) + k u(b) = 0
  conditions << 2 * (lambda + mu), -2 * mu / (inner * inner), 2 * (lambda + mu) + k * outer,
      -2 * mu / (outer * outer) + k / outer;
  const Point<2> found = conditions.inverse() * Point<2>(-1, 0);
  const double a = found[0];
  const double b = found[1];
  const auto u = [=](double r) { return Point<2>(a * r + b / r, 0); };
  const double circle = 2 * std::numbers::pi;
  return {.name = "tube",
          .data = {.boundaries = {loaded<2>("left", 1.0, 0.0), springs("right", k, 0.0),
                                  fixed<2>("bottom", free, 0.0), obstacle<2>("top", problem::Slider())},
                   .material = material},
          .solution = {u, [=](double r) { return Point<2>(a - b / (r * r), 0); }},
          .quantities =
              {{.name = "springs", .kind = QuantityKind::spring_force, .boundary = "right", .direction = e_r},
               mean_displacement<2>("left", e_r),
               contact_force<2>("top", e_z),
               {.name = "work", .kind = QuantityKind::load_work}},
          .values = {-circle * outer * k * u(outer)[0], u(inner)[0],
                     circle * lambda * a * (outer * outer - inner * inner), circle * inner * u(inner)[0]}};
}

/// A bush of height 1 on a rigid pin that the force 1 pushes, on springs around it: u_z falls like the
/// logarithm of r.
ExactCase bush(double inner, double outer, double k)
{
  const problem::Material material = lame(1, 0.3);
  const double mu = material.mu;
  const double c = 1 / (2 * std::numbers::pi);
  const auto u = [=](double r) { return Point<2>(0, c * (std::log(outer / r) / mu + 1 / (outer * k))); };
  return {.name = "bush",
          .data = {.boundaries = {rigid("left", 1.0), springs("right", 0.5, k), fixed<2>("bottom", 0.0, free),
                                  fixed<2>("top", 0.0, free)},
                   .material = material},
          .solution = {u, [=](double r) { return Point<2>(0, -c / (mu * r)); }},
          .quantities =
              {{.name = "springs", .kind = QuantityKind::spring_force, .boundary = "right", .direction = e_z},
               mean_displacement<2>("left", e_z),
               {.name = "energy"}},
          .values = {-1, u(inner)[1], c * std::log(outer / inner) / mu}};
}

TEST(EnergyMeridianSupports, BoundsExactSolutions)
{
  for (const double inner : {0.5, 10.0})
    for (const ExactCase& exact : {tube(inner, inner + 1, 0.7), bush(inner, inner + 1, 0.7)})
      for (int p = 1; p <= 4; ++p)
      {
        const MeridianProblem c(renumbered(box<2>({inner, 0}, {inner + 1, 1}, {3, 3}), 7), exact.data,
                                {.degree = p, .newton = {.tolerance = 1e-13}});
        const std::vector<double> u = c.solve().u;
        const certify::EnergyBound bound =
            certify::EnergyEstimator<2>(c.form, c.method.solver, exact.quantities)(u);
        const std::string name = fmt::format("{} of radius {}, p = {}", exact.name, inner, p);
        ASSERT_EQ(bound.reason, "") << name;
        const double error = distance(c, u, exact.solution);
        fmt::print("{}: {:.3f}, error {:.2e}\n", name, bound.bound / error, error);
        EXPECT_GE(bound.bound, error) << name;
        EXPECT_LE(bound.bound, 2 * error) << name;
        for (std::size_t i = 0; i < exact.values.size(); ++i)
        {
          expect_contains(bound.quantities[i], exact.values[i], ", " + name,
                          1e-12 * std::abs(exact.values[i]));
          EXPECT_LE(bound.quantities[i].bar(), 1.5 * std::pow(0.4, p) * std::abs(exact.values[i]))
              << name << i;
        }
        EXPECT_EQ(bound.quantities[0].exact, exact.name == "bush");
      }
}

/// A disc that a rigid plate presses on springs, and one between springs and a slider: affine displacements.
TEST(EnergyMeridianSupports, AffineDisplacementsAreExact)
{
  for (const double inner : {0.0, 0.5})
    for (int p = 1; p <= 4; ++p)
      for (const bool slides : {false, true})
      {
        const double area = std::numbers::pi * (1 - inner * inner);
        ProblemData<2> data{.boundaries = {springs("bottom", 2.0, 0.0, {0.0, -0.1})}, .material = lame(1, 0)};
        data.boundaries.push_back(slides ? obstacle<2>("top", problem::Slider(), -0.3)
                                         : rigid("top", -0.2 * area));
        const MeridianProblem c(random_meridian(inner, 3, 5), data,
                                {.degree = p, .newton = {.tolerance = 1e-13}});
        const certify::EnergyBound bound = certify::EnergyEstimator<2>(
            c.form, c.method.solver, {mean_displacement<2>("top", e_z)})(c.solve().u);
        const double stress = slides ? -0.2 / 1.5 : -0.2;
        EXPECT_EQ(bound.reason, "");
        EXPECT_LE(bound.bound, 1e-9) << p;
        expect_contains(bound.quantities[0], -0.1 + 1.5 * stress, "", 1e-12);
      }
}

/// What bounds and intervals of a random body are about.
struct RandomSupports : RandomMeridian
{
  bool is_held = false;  ///< by more than contact
  std::vector<problem::Quantity<2>> quantities{{.name = "energy"}};

  problem::Field stiffness(bool varies)
  {
    if (!varies) return problem::Field(between(0.05, 2));
    return formula(random() % 2 == 0 ? fmt::format("{:.6f} + {:.6f}*x*y", between(0.1, 1), between(0, 1))
                                     : fmt::format("{:.6f}*(y - 0.4)^2", between(0.5, 4)));
  }

  void ask(QuantityKind kind, const std::string& boundary, const Point<2>& e)
  {
    quantities.push_back(
        {.name = fmt::format("{} of {} along {}", static_cast<int>(kind), boundary, e[0] == 0 ? "z" : "r"),
         .kind = kind,
         .boundary = boundary,
         .direction = e});
  }

  void add_spring(problem::BoundaryCondition<2>& side, bool varies)
  {
    side.spring = problem::Spring<2>{stiffness(varies),
                                     stiffness(varies),
                                     {linear(0.02), formula(fmt::format("{:.6f}*y", between(-0.05, 0.05)))}};
    ask(QuantityKind::spring_force, side.name, e_r);
    if (is_held) ask(QuantityKind::spring_force, side.name, e_z);  // a dual motion of one alone has no stress
    is_held = true;
  }

  /// On an obstacle or springs; under a load, a slider or a rigid plate; with or without springs around it.
  ProblemData<2> data(double inner)
  {
    const problem::ContactLaw law =
        random() % 2 == 0 ? problem::ContactLaw(Frictionless()) : Tresca(formula("0.01 + 0.02*x"));
    ProblemData<2> result = RandomMeridian::data(inner, law);
    for (problem::BoundaryCondition<2>& side : result.boundaries)
    {
      const bool is_round = side.name == "right" || side.name == "left";
      if (is_round && random() % 2 == 0) add_spring(side, random() % 2 == 0);
      if (side.name == "bottom" && random() % 3 == 0)
      {
        side = loaded<2>("bottom", linear(0.02), linear(0.02));
        add_spring(side, false);
      }
    }
    problem::BoundaryCondition<2>& top = result.boundaries[1];
    switch (random() % 3)
    {
      case 0:
        top = obstacle<2>("top", problem::Slider(), formula("-0.04 + 0.01*x"));
        ask(QuantityKind::contact_force, "top", e_z);
        ask(QuantityKind::contact_force, "top", e_r);
        break;
      case 1:
        top = rigid("top", -0.6);
        ask(QuantityKind::mean_displacement, "top", e_z);
        break;
      default:
        top = loaded<2>("top", linear(0.03), -0.2);
    }
    ask(QuantityKind::mean_displacement, "right", e_r);
    quantities.push_back({.name = "work", .kind = QuantityKind::load_work});
    if (result.boundaries[0].contact) ask(QuantityKind::contact_force, "bottom", e_z);
    return result;
  }
};

/// The upper side of the meridian becomes that of a cone.
mesh::MeshData<2> sloped(mesh::MeshData<2> data)
{
  return mapped(std::move(data),
                [](const Point<2>& x) -> Point<2> {
                  return {x[0], x[1] * (1 - 0.4 * x[0])};
                });
}

TEST(EnergyMeridianSupports, NoBoundOrIntervalFails)
{
  std::vector<double> converged;
  for (unsigned seed = 0; seed < n_cases(8); ++seed)
  {
    RandomSupports random{{std::mt19937(seed)}};
    const double inner = seed % 2 == 0 ? 0 : 0.3;
    const int p = 1 + static_cast<int>(seed / 2) % 3;
    const ProblemData<2> data = random.data(inner);
    mesh::MeshData<2> mesh = random_meridian(inner, 2, seed);
    if (seed % 3 == 0) mesh = sloped(std::move(mesh));
    MeridianProblem c(std::move(mesh), data, {.degree = p, .newton = {.tolerance = 1e-11}});
    const RicherReference<2> reference(c.form, c.method,
                                       {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
    std::string line = fmt::format("seed {}: p = {}, inner = {}", seed, p, inner);
    const int all_steps = c.method.newton.max_steps;
    for (const int steps : {1, all_steps})
    {
      c.method.newton.max_steps = steps;
      const std::vector<double> u = c.solve().u;
      const double found = expect_bound(reference, u, bound_of(c, u), line);
      line += fmt::format("  k = {:<2} {:.4f}", steps, found);
      if (steps == all_steps) converged.push_back(found);
    }
    fmt::print("{}\n", line);
    if (random.is_held) expect_intervals(c, random.quantities, c.solve().u, line);
  }
  std::ranges::sort(converged);
  fmt::print("effectivity {:.3f}, {:.3f}, {:.3f}\n", converged.front(), converged[converged.size() / 2],
             converged.back());
  EXPECT_LE(converged[converged.size() / 2], 1.7);
}

/// A ring on a disc, joined so that they slide along each other.
TEST(EnergyMeridianSupports, SlidersJoinBodies)
{
  for (const double inner : {0.0, 0.2})
    for (const int p : {1, 2})
    {
      mesh::MeshData<2> mesh =
          side_by_side(box<2>({inner, 0}, {0.6, 1}, {2, 2}), box<2>({0.6, 0}, {1, 1}, {2, 2}), "_outer");
      mesh.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
      ProblemData<2> data{.boundaries = {loaded<2>("top", formula("0.01*x"), -0.02),
                                         loaded<2>("right_outer", formula("0.03*y"), 0.0),
                                         springs("bottom", 0.4, 0.1), fixed<2>("bottom_outer", free, 0.0)}};
      data.pairs = {pair<2>("right", "left_outer", problem::Slider())};
      data.pairs[0].contact.gap = problem::Field(0.01);
      const MeridianProblem c(renumbered(std::move(mesh), 3), data,
                              {.degree = p, .newton = {.tolerance = 1e-11}});
      const std::vector<double> u = c.solve().u;
      const RicherReference<2> reference(c.form, c.method,
                                         {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
      const std::string name = fmt::format("joined, inner = {}, p = {}", inner, p);
      const double found = expect_bound(reference, u, bound_of(c, u), name);
      fmt::print("{}: {:.3f}\n", name, found);
      EXPECT_LE(found, 2.5) << name;
      expect_intervals(
          c,
          {contact_force<2>("right", e_r),
           mean_displacement<2>("right_outer", e_r),
           {.name = "springs", .kind = QuantityKind::spring_force, .boundary = "bottom", .direction = e_r}},
          u, name);
    }
}

/// The obstacle under a body that a rigid plate presses carries its force.
TEST(EnergyMeridianSupports, StaticsKnowsTheForceOnTheFullCircle)
{
  const ProblemData<2> data{.boundaries = {obstacle<2>("bottom"), rigid("top", -0.3)}};
  const MeridianProblem c(random_meridian(0.2, 2, 1), data, {.degree = 2});
  const certify::EnergyBound bound =
      certify::EnergyEstimator<2>(c.form, c.method.solver, {contact_force<2>("bottom", e_z)})(c.solve().u);
  EXPECT_EQ(bound.reason, "");
  EXPECT_TRUE(bound.quantities[0].exact);
  EXPECT_NEAR(bound.quantities[0].lower, 0.3, 1e-12);
  EXPECT_NEAR(bound.quantities[0].value, 0.3, 1e-10);
}

/// Springs across a wall that is a cylinder but for rounding leave the body free along the axis.
TEST(EnergyMeridianSupports, RoundingHoldsNothing)
{
  mesh::MeshData<2> data = box<2>({0.2, 0}, {1, 1}, {2, 2});
  for (Point<2>& x : data.vertices)
    if (x[0] == 1) x[0] += 1e-15 * x[1];
  const mesh::Mesh<2> mesh(std::move(data));
  const ProblemData<2> of{.boundaries = {springs("right", 1.0, 0.0)}};
  const certify::FreeMotions<2> motions(of.on(mesh).axisymmetric(), mesh);
  EXPECT_EQ(motions.size(), 1U);
  EXPECT_FALSE(motions.is_unclear());
}

/// What springs that vary lose at the axis is bounded by their own energy; where they have none, there is no
/// bound.
TEST(EnergyMeridianSupports, StiffnessMayVaryAtTheAxis)
{
  for (const char* const stiffness : {"0.2 + x", "0.3 + 4*(x - 0.5)^2", "2*x"})
    for (const bool is_guided : {false, true})
      for (const int p : {1, 2})
      {
        ProblemData<2> data{
            .boundaries = {springs("bottom", formula(stiffness), 0.0, {0.0, formula("0.1*x")}),
                           loaded<2>("top", 0.0, formula("-0.1*x"))}};
        if (is_guided) data.boundaries[0].displacement[0] = 0.0;
        const MeridianProblem c(random_meridian(0, 2, 1), data, {.degree = p});
        const std::vector<double> u = c.solve().u;
        const certify::EnergyBound bound = bound_of(c, u);
        const std::string name = fmt::format("{}, p = {}", stiffness, p);
        if (std::string(stiffness) == "2*x")
        {
          EXPECT_EQ(bound.reason,
                    "a spring whose stiffness varies on a cell that touches the axis may be 0 there");
          continue;
        }
        EXPECT_GT(bound.oscillation, 0) << name;
        const double found =
            expect_bound({c.form, c.method, {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)}},
                         u, bound, name);
        EXPECT_LE(found, p == 1 ? 5 : 2) << name;
        fmt::print("{}: {:.3f}, of loads {:.1e} of {:.1e}\n", name, found, bound.oscillation, bound.bound);
      }
}

}  // namespace

}  // namespace tribound::test
