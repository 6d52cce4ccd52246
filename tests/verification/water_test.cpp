/// @file water_test.cpp
/// Water in the joint under a dam: statics, numbers of an independent program, and the bound above the dual
/// norm.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "support/bonded_path.h"
#include "support/dam.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/nitsche/crack_mouth.h"
#include "tribound/io/record/hydraulic_figures.h"
#include "tribound/mesh/import/read.h"

namespace tribound::test
{
namespace
{

using nlohmann::json;
using Step = adapt::LoadStep<2>;

json reference()
{
  std::ifstream in(std::string(VERIFICATION_DATA) + "/cohesive.json");
  return json::parse(in)["dam"];
}

mesh::Mesh<2> dam_mesh()
{
  return std::get<mesh::Mesh<2>>(
      mesh::read_mesh(mesh::MeshFile{std::string(VERIFICATION_DATA) + "/dam_12.msh"}));
}

void follow(const ProblemData<2>& data, const std::vector<double>& levels,
            const std::function<void(const Step&)>& check, int degree = 2)
{
  mesh::Mesh<2> mesh = dam_mesh();
  const problem::Problem<2> problem = data.on(mesh);
  const adapt::Method method = dam_method(degree);
  adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
  for (const double level : levels) ASSERT_EQ(path.advance(level, check), "");
}

io::HydraulicFigures figures_of(const Step& step)
{
  const auto boundaries = step.at->problem.boundaries();
  for (std::size_t tag = 0; tag < boundaries.size(); ++tag)
    if (boundaries[tag].contact) return io::hydraulic_figures<2>(step, static_cast<int>(tag)).value();
  throw std::logic_error("no contact");
}

/// Gauges at the heel give the opening that displacement adds, and the sliding.
template <int dim>
void expect_gauges_at_heel(const adapt::LoadStep<dim>& step, const std::string& base,
                           const io::HydraulicFigures& figures)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const auto gauged = [&](adapt::Jump jump)
  {
    const std::array gauges = {adapt::Gauge{.boundary = base, .jump = jump, .factor = 2}};
    return form.space().dot(adapt::functional<dim>(form, gauges), step.level.u) / 2;
  };
  const int tag = adapt::gauged_boundary<dim>(form.problem(), {.boundary = base});
  const auto opening = [&](std::size_t i)
  {
    const std::size_t n = form.n_segment_points();
    return form.contact_states(step.level.u, i / n)[i % n].gap - form.contact_points()[i].gap;
  };
  EXPECT_NEAR(gauged(adapt::Jump::mouth_opening),
              contact::mean_at(contact::crack_mouth(form, tag), form, opening), 1e-12);
  EXPECT_NEAR(gauged(adapt::Jump::mouth_sliding), figures.csd.value(), 1e-12);
  if (figures.cmod.value() > 0)  // up to the discretisation
  {
    EXPECT_NEAR(gauged(adapt::Jump::mouth_opening) / figures.cmod.value(), 1, 0.01);
  }
}

TEST(Water, DamOfAnIndependentProgram)
{
  const json steps = reference()["joint"];
  std::vector<double> levels;
  for (const json& step : steps) levels.push_back(step["ell"]);
  std::size_t i = 0;
  follow(dam(uplift()), levels,
         [&](const Step& step)
         {
           SCOPED_TRACE(step.t);
           const json& expected = steps[i++];
           const auto near = [&](double value, const char* key, double tolerance)
           {
             const double e = expected[key];
             EXPECT_NEAR(value, e, tolerance * std::max(1.0, std::abs(e))) << key;
           };
           EXPECT_EQ(step.cuts, 0);
           EXPECT_EQ(step.passes, 1);
           EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
           const io::HydraulicFigures figures = figures_of(step);
           near(figures.effective_normal, "eff_N", 1e-10);
           near(figures.uplift, "U", 1e-12);
           near(figures.resultant_x.value(), "x_res_eff", 1e-9);
           near(figures.resultant_x_total.value(), "x_res", 1e-9);
           near(figures.cmod.value(), "cmod", 1e-9);
           expect_gauges_at_heel<2>(step, "base", figures);
           near(figures.crack_tip.value(), "tip", 1e-8);
           near(step.level.norms.energy, "energy", 1e-9);
           near(integrals<2>(step).damage, "Dint", 1e-8);
         });
  EXPECT_EQ(i, steps.size());
}

/// At 80 m, by statics: the total resultant lies in the kernel (middle third), the effective one does not.
TEST(Water, FactorsOfSafety)
{
  follow(dam(uplift()), {0, 80},
         [](const Step& step)
         {
           const io::HydraulicFigures figures = figures_of(step);
           if (step.t == 0)
           {
             EXPECT_NEAR(figures.resultant_x.value(), 20.12820512820513, 1e-9);
             EXPECT_TRUE(figures.in_kernel.value());
             EXPECT_FALSE(figures.sliding_safety);
             EXPECT_FALSE(figures.overturning);
             return;
           }
           const double shear = weight_of_water * 80 * 80 / 2;
           const double normal = 61.2144 - weight_of_water * 80 * 60 / 2;
           EXPECT_NEAR(figures.sliding_safety.value(), tan_30 * normal / shear, 1e-10);
           EXPECT_NEAR(figures.sliding_safety.value(), 0.69282, 5e-6);
           EXPECT_NEAR(figures.sff_intact.value(), 2.03074, 5e-6);
           EXPECT_LT(figures.sff_now.value(), figures.sff_intact.value());
           EXPECT_GT(figures.sff_now.value(), figures.sliding_safety.value());
           EXPECT_NEAR(figures.overturning.value(), 1.37206, 5e-6);
           EXPECT_NEAR(figures.resultant_x_total.value(), 33.80341880341, 1e-8);
           EXPECT_NEAR(figures.resultant_x.value(), 42.430555555, 1e-7);
           EXPECT_FALSE(figures.in_kernel.value());
         });
}

/// A drain without efficiency changes nothing; an efficient one reduces the uplift.
TEST(Water, DrainsTakeUplift)
{
  double linear = 0;
  follow(dam(uplift()), {0, 40}, [&](const Step& step) { linear = figures_of(step).uplift; });
  problem::Seepage drained = uplift();
  drained.drain = {.at = 8, .efficiency = 0};
  follow(dam(drained), {0, 40},
         [&](const Step& step) { EXPECT_NEAR(figures_of(step).uplift, step.t == 0 ? 0 : linear, 1e-12); });
  drained.drain->efficiency = 0.6;
  const double head = weight_of_water * 40;
  const double at_drain = 0.4 * head * 52 / 60;
  follow(dam(drained), {0, 40},
         [&](const Step& step)
         {
           if (step.t == 0) return;
           EXPECT_NEAR(figures_of(step).uplift, (head + at_drain) / 2 * 8 + at_drain / 2 * 52, 1e-12);
           EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
         });
}

/// The crack carries full pressure up to its tip, which the step itself moves; the uplift is exact wherever
/// the tip is. The independent program took the kink of the pressure as the points see it.
TEST(Water, CracksCarryPressure)
{
  const json expected = reference()["crack_at_80"];
  double before = 0;
  follow(dam(uplift(true)), {0, 40, 70, 80, 40},
         [&](const Step& step)
         {
           const io::HydraulicFigures figures = figures_of(step);
           const double tip = figures.crack_tip.value();
           EXPECT_GE(tip, before);
           EXPECT_EQ(step.passes > 1, tip > before) << step.t;
           before = tip;
           const double head = weight_of_water * step.t;
           EXPECT_NEAR(figures.uplift, head * (tip + (60 - tip) / 2), 1e-11);
           EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
           if (step.t < 80) return;
           EXPECT_NEAR(tip, expected["tip"], 1e-8);
           EXPECT_NEAR(integrals<2>(step).damage, expected["Dint"], 2e-2);
           EXPECT_NEAR(step.level.norms.energy, expected["energy"], 1e-4);
         });
  EXPECT_GT(before, 4);
}

/// With friction alone, the dam slides at the level given by statics.
TEST(Water, TheDamSlidesAtTheLevelOfStatics)
{
  const problem::ContactLaw law = problem::JointLaw({.coefficient = tan_30});
  const double limit = 69.31280745296064;
  follow(dam(uplift(), law), {0, 40, 60, limit - 1e-3}, [](const Step&) {});
  mesh::Mesh<2> mesh = dam_mesh();
  const problem::Problem<2> problem = dam(uplift(), law).on(mesh);
  const adapt::Method method = dam_method();
  adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
  for (const double level : {0.0, 40.0, 60.0}) ASSERT_EQ(path.advance(level), "");
  EXPECT_NE(path.advance(limit + 1e-2), "");
  EXPECT_LE(path.last()->t, limit + 1e-8);
}

/// Water that presses a block off an obstacle does work, which the block stores.
TEST(Water, WorkOfThePressure)
{
  ProblemData<2> data{
      .boundaries = {clamped<2>("top"), obstacle<2>("bottom", problem::JointLaw({.coefficient = 0.3}))}};
  data.boundaries.back().contact->water.emplace(formula("0.1*t*(1+x)"));
  mesh::Mesh<2> mesh(block<2>({4, 2}));
  const problem::Problem<2> problem = data.on(mesh);
  const adapt::Method method = dam_method();
  adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
  double work = 0;
  const auto check = [&](const Step& step)
  {
    work += step.work;
    for (std::size_t i = 0; i < step.responses.size(); ++i)
    {
      const contact::ContactPoint<2>& point = step.at->discrete.form.contact_points()[i];
      EXPECT_EQ(step.responses[i].status, problem::ContactStatus::open);
      EXPECT_LE((step.responses[i].traction + point.water * point.normal).norm(), 1e-14);
    }
  };
  for (const double t : {0.5, 1.0}) EXPECT_EQ(path.advance(t, check), "");
  EXPECT_GT(work, 1e-3);
  EXPECT_NEAR(work, path.last()->level.norms.energy / 2, 1e-12);
}

/// A block of 2 x 1 x 1 on a floor, with water of depth t < 1 in front of its left side and below it. Forces,
/// resultants and overturning are those of statics, whatever the mesh; the drain cuts facets.
TEST(Water, BlockUnderUpliftIn3D)
{
  constexpr double water = 0.1;
  constexpr double depth = 0.7;
  problem::Seepage seepage{.head = formula("t"), .weight = water, .line = {{0, 0.5, 0}, {2, 0.5, 0}}};
  seepage.drain = {.at = 0.37, .efficiency = 0.5};
  ProblemData<3> data{.boundaries = {pressed<3>("left", formula("0.1*max(0, t-z)")),
                                     obstacle<3>("back", problem::JointLaw({.coefficient = 0.9}))},
                      .body_force = {problem::Field(0.0), problem::Field(0.0), problem::Field(-0.2)}};
  data.boundaries.back().contact->water.emplace(seepage);
  data.boundaries.back().contact->base = seepage.line;
  mesh::Mesh<3> mesh(block<3>({4, 2}, {3, 2, 2}));
  const problem::Problem<3> problem = data.on(mesh);
  const adapt::Method method = dam_method(1);
  adapt::LoadPath<3> path(problem, method, {}, std::move(mesh));
  const auto boundaries = problem.boundaries();
  int tag = 0;
  while (!boundaries[tag].contact) ++tag;
  const auto check = [&](const adapt::LoadStep<3>& step)
  {
    if (step.t == 0) return;
    EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
    const io::HydraulicFigures figures = io::hydraulic_figures<3>(step, tag).value();
    const double heel = water * depth;
    const double at_drain = 0.5 * heel * (2 - 0.37) / 2;
    const double first = (heel + at_drain) / 2 * 0.37;
    const double second = at_drain / 2 * (2 - 0.37);
    expect_gauges_at_heel<3>(step, "back", figures);
    EXPECT_NEAR(figures.uplift, first + second, 1e-12);
    EXPECT_NEAR(figures.effective_normal, -0.4 + first + second, 1e-10);
    const double thrust = water * depth * depth / 2;
    EXPECT_NEAR(figures.sliding_safety.value(), 0.9 * (0.4 - first - second) / thrust, 1e-8);
    // About the toe: a trapezoid in front of the drain, a triangle behind it.
    const double uplift = heel * 0.37 * (2 - 0.37 / 2) - (heel - at_drain) / 2 * 0.37 * (2 - 0.37 * 2 / 3) +
                          second * (2 - 0.37) * 2 / 3;
    EXPECT_NEAR(figures.overturning.value(), 0.4 / (thrust * depth / 3 + uplift), 1e-9);
    EXPECT_NEAR(figures.resultant_x.value(), 2 - (0.4 - thrust * depth / 3 - uplift) / (0.4 - first - second),
                1e-8);
  };
  for (const double t : {0.0, depth}) ASSERT_EQ(path.advance(t, check), "");
}

/// The bounds of the first iterates of a step and of its solution are above the dual norms of their
/// residuals.
void expect_above_dual_norm(const Step& step, std::span<const double> before, double& least)
{
  const contact::NitscheForm<2>& form = step.at->discrete.form;
  const int degree = form.space().degree();
  certify::DualNorm<2> dual_norm(form, {.refinements = 2, .degree = degree + 2});
  const certify::Estimator<2> estimator(form, certify::ContactRule::resolved);
  const auto check = [&](std::span<const double> u, std::span<const Point<2>> traction)
  {
    const certify::Stress<2> stress = certify::equilibrate<2>(form, u, traction);
    EXPECT_LE(certify::check_identities<2>(form, traction, stress).largest(), 1e-9);
    const double bound = estimator(u, stress).total_sharp;
    const double below = dual_norm(u);
    EXPECT_GE(bound, below);
    least = std::min(least, bound / below);
  };
  const solve::NewtonOptions options{.max_steps = 2, .damping = false};
  (void)solve::solve<2>(form, before, options, {},
                        [&](const solve::NewtonIterate<2>& iterate)
                        {
                          check(iterate.u(), iterate.traction);
                          return false;
                        });
  check(step.level.u, step.level.traction);
}

/// The tip of a crack, a drain and the water surface lie inside facets.
TEST(Water, BoundIsAboveTheDualNorm)
{
  problem::Seepage seepage = uplift(true);
  seepage.drain = {.at = 12.3, .efficiency = 0.5};
  for (const problem::ContactLaw& law :
       {dam_joint(), problem::ContactLaw(problem::JointLaw({.coefficient = 0.9})),
        problem::ContactLaw(
            problem::MixedLaw({.tension = {0.3, 1e-4}, .shear_ratio = 1.5, .coefficient = tan_30}))})
  {
    SCOPED_TRACE(problem::words(law));
    double least = HUGE_VAL;
    std::vector<double> before;
    follow(dam(seepage, law), {0, 37, 67},
           [&](const Step& step)
           {
             SCOPED_TRACE(step.t);
             expect_above_dual_norm(step, before, least);
             before = step.level.u;
           });
    fmt::print("{}: {:.3f}\n", problem::words(law), least);
  }
}

/// What a rule misses of a non-polynomial pressure is in the bound. It would not be for softening laws; these
/// refuse such a pressure at the step where it arises.
TEST(Water, PressuresThatAreNoPolynomials)
{
  const auto data = [](problem::ContactLaw law)
  {
    ProblemData<2> result = dam(uplift(), std::move(law));
    result.boundaries.back().contact->water.emplace(formula("0.002*t*exp(-abs(x-13.7)/5)"));
    return result;
  };
  double least = HUGE_VAL;
  std::vector<double> before;
  follow(data(problem::JointLaw({.coefficient = 0.9})), {0, 60},
         [&](const Step& step)
         {
           expect_above_dual_norm(step, before, least);
           before = step.level.u;
         });
  mesh::Mesh<2> mesh = dam_mesh();
  const problem::Problem<2> problem = data(dam_joint()).on(mesh);
  const adapt::Method method = dam_method();
  adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
  EXPECT_EQ(path.advance(0), "");
  const std::string message = message_of([&] { return path.advance(10); });
  EXPECT_NE(message.find("softens, and its gap, threshold or water pressure is no polynomial of degree 4"),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace tribound::test
