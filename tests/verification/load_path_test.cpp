/// @file load_path_test.cpp
/// Load paths with history-dependent interfaces, against closed formulas and the numbers of an independent
/// program, tests/verification/data/cohesive.json.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/bonded_path.h"

namespace tribound::test
{
namespace
{

using nlohmann::json;
using problem::BoundaryCondition;
using problem::Field;
using problem::Unloading;

json reference()
{
  std::ifstream in(COHESIVE_REFERENCE);
  return json::parse(in);
}

/// A field with the values of a list at t = 1, 2, ...
Field table(const std::vector<double>& values)
{
  std::string text = "0";
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format(" + (t == {}) * ({:.17g})", i + 1, values[i]);
  return formula(text);
}

struct Path
{
  std::array<int, 2> cells;
  double E = 1000;
  double nu = 0.2;
  std::vector<BoundaryCondition<2>> boundaries;
  adapt::Method method{};

  Path(std::array<int, 2> c, int degree) : cells(c)
  {
    method.degree = degree;
    method.gamma0 = 10;
    method.newton.tolerance = 1e-12;
    method.stopping.criterion = adapt::Stopping::tolerance;
    method.contact_rule = certify::ContactRule::reference;
  }

  void follow(const std::vector<double>& t, const std::function<void(const adapt::LoadStep<2>&)>& check) const
  {
    mesh::Mesh<2> mesh(block<2>(cells));
    const problem::Problem<2> problem(mesh, {{.material = problem::lame(E, nu, problem::PlaneModel::strain)}},
                                      boundaries);
    adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
    for (const double target : t) ASSERT_EQ(path.advance(target, check), "");
  }
};

problem::Tension bond(double ft, double Gc, const std::string& unloading)
{
  return {ft, Gc, unloading == "origin" ? Unloading::origin : Unloading::vertical};
}

problem::ContactLaw law_of(const json& law)
{
  const problem::Tension tension = bond(law["ft"], law["Gc"], law["unloading"]);
  if (law["law"] == "mixed") return problem::MixedLaw({tension, law["beta"], law["mu"]});
  const double slip =
      law["slip_c"].is_string() ? std::numeric_limits<double>::infinity() : law["slip_c"].get<double>();
  return problem::JointLaw({tension, law["c"], slip, law["mu"], false}, law["s"].get<double>());
}

/// The exact traction at every point, and D.
void expect_uniform(const adapt::LoadStep<2>& step, double normal, double tangential, double damage)
{
  for (const problem::InterfaceResponse<2>& response : step.responses)
  {
    EXPECT_NEAR(response.traction[1], -normal, 2e-10);  // n = (0, -1)
    EXPECT_NEAR(response.traction[0], tangential, 2e-10);
    EXPECT_NEAR(response.state.damage, damage, 2e-10);
  }
  EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
  EXPECT_LE(step.level.estimate.total, 1e-9);
}

/// A bar in series with a bond, which is opened, closed, pressed, opened again and broken.
TEST(LoadPath, BarAgainstTheSeriesOfSprings)
{
  const json cases = reference()["bar"];
  for (const auto& [unloading, steps] : cases.items())
    for (const int degree : {1, 2})
    {
      SCOPED_TRACE(unloading);
      Path path({4, 2}, degree);
      path.boundaries = {problem::with_displacement<2>("left", {Field(0.0), std::nullopt}),
                         problem::with_displacement<2>("right", {Field(0.0), std::nullopt}),
                         problem::with_displacement<2>("top", {Field(0.0), formula("t")}),
                         problem::with_contact<2>("bottom", problem::JointLaw({bond(2, 0.02, unloading)}))};
      std::vector<double> t;
      for (const json& step : steps) t.push_back(step["U"]);
      std::size_t i = 0;
      double dissipated = 0;
      path.follow(t,
                  [&](const adapt::LoadStep<2>& step)
                  {
                    SCOPED_TRACE(step.number);
                    const json& expected = steps[i++];
                    EXPECT_EQ(step.cuts, 0);
                    EXPECT_LE(step.level.steps.size(), 6);
                    expect_uniform(step, expected["Tn_exact"], 0, expected["D_exact"]);
                    const double in_step = integrals<2>(step).dissipated;
                    EXPECT_NEAR(in_step, expected["dissipated_step"].get<double>(), 1e-12);
                    dissipated += in_step;
                  });
      EXPECT_EQ(i, steps.size());
      EXPECT_NEAR(dissipated, 2 * 0.02, 1e-12);
    }
}

/// A block pulled and sheared, proportionally or not, and pressed with friction.
TEST(LoadPath, BlockAgainstRootFinding)
{
  const json cases = reference()["block"];
  for (const auto& [name, steps] : cases.items())
  {
    SCOPED_TRACE(name);
    problem::ContactLaw law = problem::JointLaw(
        {.cohesion = name == "joint_coulomb" ? 0.0 : 1.0,
         .slip_length = name == "joint_cohesion_soft" ? 4e-3 : std::numeric_limits<double>::infinity(),
         .coefficient = 0.6});
    if (name.starts_with("mixed"))
      law =
          problem::MixedLaw({bond(2, 0.02, "origin"), std::stod(name.substr(7)), std::stod(name.substr(13))});
    const double lambda = problem::lame(1000, 0.2, problem::PlaneModel::strain).lambda;
    const double modulus = lambda + 2 * problem::lame(1000, 0.2, problem::PlaneModel::strain).mu;
    std::vector<double> t;
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> normal;
    std::vector<double> shear;
    for (const json& step : steps)
    {
      t.push_back(static_cast<double>(t.size() + 1));
      x.push_back(step[0]);
      y.push_back(step[1]);
      normal.push_back(lambda / modulus * step[2].get<double>());
      shear.push_back(-step[3].get<double>());
    }
    std::vector<double> minus_normal = normal;
    std::vector<double> minus_shear = shear;
    for (double& v : minus_normal) v = -v;
    for (double& v : minus_shear) v = -v;
    Path path({3, 2}, 1 + static_cast<int>(name.size() % 2));
    path.boundaries = {problem::with_traction<2>("left", {table(minus_normal), table(minus_shear)}),
                       problem::with_traction<2>("right", {table(normal), table(shear)}),
                       problem::with_displacement<2>("top", {table(x), table(y)}),
                       problem::with_contact<2>("bottom", law)};
    std::size_t i = 0;
    path.follow(t,
                [&](const adapt::LoadStep<2>& step)
                {
                  SCOPED_TRACE(step.number);
                  const json& expected = steps[i++];
                  expect_uniform(step, expected[2], expected[3], expected[4]);
                });
    EXPECT_EQ(i, steps.size());
  }
}

void expect_numbers(const adapt::LoadStep<2>& step, const json& expected)
{
  const auto& form = step.at->discrete.form;
  const auto near = [&](double value, const char* key, double relative, double absolute)
  {
    const double e = expected[key];
    EXPECT_NEAR(value, e, relative * std::abs(e) + absolute) << key;
  };
  const contact::ContactResultants<2> contact = contact::contact_resultants<2>(form, step.level.traction);
  near(step.level.norms.energy, "energy", 1e-8, 0);
  near(step.level.norms.sigma, "sigma_norm", 1e-8, 0);
  near(contact.normal, "contact_normal", 1e-8, 1e-12);
  near(contact.tangential, "contact_tangential", 1e-8, 1e-12);
  const InterfaceIntegrals sums = integrals<2>(step);
  near(sums.damage, "damage_integral", 1e-8, 1e-10);
  if (expected.contains("dissipated_step")) near(sums.dissipated, "dissipated_step", 1e-8, 1e-11);
  if (expected.contains("effective_normal"))
  {
    std::vector<Point<2>> effective = form.water_pressure();
    for (std::size_t i = 0; i < effective.size(); ++i) effective[i] += step.level.traction[i];
    near(contact::contact_resultants<2>(form, effective).normal, "effective_normal", 1e-8, 1e-12);
  }
  const certify::BoundComponents& eta = step.level.estimate.global;
  near(eta.str, "eta_str", 1e-6, 0);
  near(eta.cnt, "eta_cnt", 1e-6, 1e-11);
  near(eta.frc, "eta_frc", 1e-6, 1e-11);
  near(step.level.estimate.total, "eta_tot", 1e-6, 0);
}

/// Peeling of a bond, with every law and with water in the joint, and cyclic friction: energies, forces,
/// damage, components.
TEST(LoadPath, NumbersOfAnIndependentProgram)
{
  const json all = reference();
  for (const char* kind : {"peel", "cyclic"})
    for (const auto& [name, c] : all[kind].items())
    {
      SCOPED_TRACE(name);
      const bool peel = std::string(kind) == "peel";
      Path path({c["cells"][0], c["cells"][1]}, c["degree"]);
      path.E = 1;
      path.nu = 0.3;
      path.method.stress = certify::PatchStress::afw;
      path.boundaries.push_back(problem::with_contact<2>("bottom", law_of(c["law"])));
      if (name.starts_with("water"))
        path.boundaries.back().contact->water.emplace(formula("0.01*abs(t)*x/2"));
      if (peel)
        path.boundaries.insert(
            path.boundaries.end(),
            {problem::with_displacement<2>("left", {Field(0.0), Field(0.0)}),
             problem::with_displacement<2>("top", {formula("t*x/2*0.03"), formula("t*x/2*0.09")}),
             problem::with_traction<2>("right", {formula("0.01*t"), Field(0.0)})});
      else
        path.boundaries.insert(path.boundaries.end(),
                               {problem::with_traction<2>("top", {Field(0.0), formula("-0.1-0.1*x")}),
                                problem::with_traction<2>("right", {formula("0.03*t"), Field(0.0)})});
      std::vector<double> t;
      for (const json& step : c["steps"]) t.push_back(step["ell"]);
      std::size_t i = 0;
      path.follow(t,
                  [&](const adapt::LoadStep<2>& step)
                  {
                    SCOPED_TRACE(step.number);
                    EXPECT_EQ(step.cuts, 0);
                    EXPECT_LE(step.level.steps.size(),
                              40);  // full steps, and halved ones if these cycle
                    EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
                    expect_numbers(step, c["steps"][i++]);
                  });
      EXPECT_EQ(i, c["steps"].size());
    }
}

/// Incompatible laws, data and meshes are refused by name.
TEST(LoadPath, RefusesWhatDoesNotHold)
{
  const auto message = [](const problem::ContactLaw& law, double gamma0, Field gap)
  {
    Path path({4, 2}, 2);
    path.E = 1;
    path.method.gamma0 = gamma0;
    path.boundaries = {problem::with_displacement<2>("top", {Field(0.0), formula("t")}),
                       problem::with_contact<2>("bottom", law, std::move(gap))};
    try
    {
      path.follow({0.1}, [](const adapt::LoadStep<2>&) {});
    }
    catch (const InputError& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect =
      [&](const problem::ContactLaw& law, const std::string& part, double gamma0 = 10, const Field& gap = 0.0)
  { EXPECT_NE(message(law, gamma0, gap).find(part), std::string::npos) << message(law, gamma0, gap); };
  const problem::Tension soft{1, 1, Unloading::origin};
  EXPECT_EQ(message(problem::JointLaw({.tension = soft}), 10, 0.0), "");
  expect(problem::JointLaw({.tension = {10, 1, Unloading::origin}}),
         "the interface \"bottom\" at (0.25, 0) softens with the slope 50, and gamma =");
  expect(problem::JointLaw({.tension = soft}), "has a gap of 0.01 under a bond", 10, 0.01);
  EXPECT_EQ(message(problem::JointLaw({.tension = soft}), 10, 1e-10), "");  // rounding of meshes
  EXPECT_EQ(message(problem::JointLaw({.tension = soft}), 10, -0.01), "");  // pressed together
  expect(problem::JointLaw({.tension = {1, 0, Unloading::origin}}), "needs a fracture energy");
  expect(problem::JointLaw({.cohesion = 1, .stick = true}), "needs a tensile strength");
  expect(problem::JointLaw({.tension = soft, .slip_length = 1}), "a slip length needs a cohesion");
  expect(problem::JointLaw({.cohesion = 1, .slip_length = 1}, formula("0.1*exp(5*x)")), "no polynomial");
  expect(problem::MixedLaw({.tension = soft, .shear_ratio = 0.2}), "a gamma0 of 40 or more");
  expect(problem::MixedLaw({.tension = {1, 1, Unloading::vertical}, .coefficient = 0.3}),
         "unloading to the origin only");
  expect(problem::EndoLaw({5, 4, 0.8, 0.3, 3, 0.003}), "must hold of the strengths");
}

/// A block on its floor, pushed beyond what friction can hold: Newton's method is not to blame.
TEST(LoadPath, AStepBeyondFrictionSaysSo)
{
  Path path({4, 2}, 1);
  mesh::Mesh<2> mesh(block<2>(path.cells));
  const problem::Problem<2> problem(
      mesh, {{.material = problem::lame(path.E, path.nu, problem::PlaneModel::strain)}},
      {loaded<2>("top", 0, -1), loaded<2>("right", formula("-0.3*t"), 0),
       obstacle<2>("bottom", Coulomb(0.2))});
  adapt::LoadPath<2> along(problem, path.method, {}, std::move(mesh));
  ASSERT_EQ(along.advance(1), "");
  const std::string why = along.advance(2);
  EXPECT_NE(why.find("; at t = 2 contact cannot hold the body"), std::string::npos) << why;
  EXPECT_NE(why.find("friction is too weak"), std::string::npos) << why;
}

}  // namespace
}  // namespace tribound::test
