/// @file interface_law_test.cpp
/// History-dependent interface laws at one point: results of an independent program, derivatives against
/// differences in every branch, and properties of every law along random paths.

#include "tribound/problem/interface_law.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace tribound
{
namespace
{

using Json = nlohmann::json;
using problem::InterfaceResponse;
using problem::LawPoint;
using problem::Unloading;
using Law = std::variant<problem::Joint, problem::Mixed, problem::Endo>;

template <int dim>
InterfaceResponse<dim> respond(const Law& law, const LawPoint<dim>& point, const Point<dim>& P)
{
  return std::visit([&](const auto& l) { return problem::respond<dim>(l, point, P); }, law);
}

problem::Tension tension(const Json& p)
{
  return {
      p.value("ft", 0.0), p.value("Gc", 0.0),
      p.value("unloading", std::string("origin")) == "vertical" ? Unloading::vertical : Unloading::origin};
}

Law law_of(const Json& c)
{
  const Json& p = c["parameters"];
  if (c["law"] == "joint")
    return problem::Joint{tension(p), p.value("c", 0.0),
                          p.value("slip_c", std::numeric_limits<double>::infinity()), p.value("mu", 0.0),
                          p.value("stick", false)};
  if (c["law"] == "mixed") return problem::Mixed{tension(p), p.value("beta", 1.0), p.value("mu", 0.0)};
  return problem::Endo{p["Kn"], p["Kt"], p["mu"], p["Bn"], p["Bt"], p["D1"]};
}

/// A frame (n, t_1, ...) not aligned with the axes.
template <int dim>
Tensor<dim> frame()
{
  return Tensor<dim>(Tensor<dim>::Random()).householderQr().householderQ();
}

template <int dim>
Point<dim> tangential(const Tensor<dim>& frame, const Json& components)
{
  Point<dim> v = Point<dim>::Zero();
  for (int a = 1; a < dim; ++a) v += components[a - 1].get<double>() * frame.col(a);
  return v;
}

template <int dim>
void expect_reference(const Law& law, const Json& c, const Json& step)
{
  const Tensor<dim> axes = frame<dim>();
  const Json& before = step["before"];
  const LawPoint<dim> point{axes.col(0),
                            c["parameters"].value("s", 0.0),
                            c["gamma"],
                            {before["D"], before.value("q", 0.0), tangential<dim>(axes, before["w"])}};
  const Point<dim> P = step["Pn"].get<double>() * axes.col(0) + tangential<dim>(axes, step["Pt"]);
  const InterfaceResponse<dim> response = respond<dim>(law, point, P);

  const Point<dim> T = axes.transpose() * response.traction;
  const Tensor<dim> DT = axes.transpose() * response.derivative * axes;
  const Point<dim> w = axes.transpose() * response.state.slip;
  const Json& after = step["after"];
  const double rounding = 4e-15 * std::max(1.0, P.norm());
  const double differences = c["law"] == "endo" ? 1e-9 : rounding;
  EXPECT_NEAR(T[0], step["Tn"].get<double>(), rounding);
  EXPECT_NEAR(DT(0, 0), step["DT"][0][0].get<double>(), differences);
  for (int a = 1; a < dim; ++a)
  {
    EXPECT_NEAR(T[a], step["Tt"][a - 1].get<double>(), rounding);
    EXPECT_NEAR(w[a], after["w"][a - 1].get<double>(), rounding);
    for (int b = 0; b < dim; ++b) EXPECT_NEAR(DT(a, b), step["DT"][a][b].get<double>(), differences);
  }
  EXPECT_NEAR(w[0], 0, rounding);
  EXPECT_NEAR(response.state.damage, after["D"].get<double>(), rounding);
  if (after.contains("q"))
  {
    EXPECT_NEAR(response.state.slipped, after["q"].get<double>(), rounding);
  }
  EXPECT_NEAR(response.dissipated, step["dissipated"].get<double>(), rounding);
  EXPECT_NEAR(response.opening, step["dn"].get<double>(), rounding);
}

TEST(InterfaceLaws, AreThoseOfAnIndependentProgram)
{
  std::ifstream in(LAW_POINTS);
  const Json reference = Json::parse(in);
  int n = 0;
  for (const Json& c : reference["cases"])
  {
    const Law law = law_of(c);
    for (const Json& path : c["points"])
      for (const Json& step : path)
      {
        SCOPED_TRACE(c["law"].get<std::string>() + " " + c["parameters"].dump() + " " + step.dump());
        c["d"] == 2 ? expect_reference<2>(law, c, step) : expect_reference<3>(law, c, step);
        ++n;
      }
  }
  EXPECT_EQ(n, 26 * 5 * 6);
}

/// Laws with every feature, alone and combined.
std::vector<Law> all_laws()
{
  const double never = std::numeric_limits<double>::infinity();
  std::vector<Law> laws;
  for (const Unloading unloading : {Unloading::origin, Unloading::vertical})
  {
    const problem::Tension bond{1.0, 0.8, unloading};
    laws.emplace_back(problem::Joint{bond, 0, never, 0.6, false});
    laws.emplace_back(problem::Joint{bond, 1.2, 1.1, 0.5, false});
    laws.emplace_back(problem::Joint{bond, 0.7, never, 0, false});
    laws.emplace_back(problem::Joint{bond, 0, never, 0.4, true});
    laws.emplace_back(problem::Mixed{bond, 1.3, 0});
  }
  laws.emplace_back(problem::Joint{});
  laws.emplace_back(problem::Joint{{}, 0, never, 0.5, false});
  laws.emplace_back(problem::Joint{{}, 0.9, 0.8, 0.3, false});
  laws.emplace_back(problem::Mixed{{1.0, 0.8, Unloading::origin}, 0.6, 0.5});
  laws.emplace_back(problem::Endo{5, 4, 0.8, 0.3, 0.12, 0.003});
  return laws;
}

template <int dim>
Point<dim> random_vector(std::mt19937& dice, double size)
{
  std::normal_distribution<double> number(0, size);
  Point<dim> v;
  for (int a = 0; a < dim; ++a) v[a] = number(dice);
  return v;
}

/// Committed steps under random loads of all sizes; `check(law, point, P, response)` at each.
template <int dim>
void on_random_paths(const std::function<void(const Law&, const LawPoint<dim>&, const Point<dim>&,
                                              const InterfaceResponse<dim>&)>& check)
{
  std::mt19937 dice(4);
  for (const Law& law : all_laws())
    for (int path = 0; path < 60; ++path)
    {
      const Tensor<dim> axes = frame<dim>();
      LawPoint<dim> point{axes.col(0), path % 2 == 0 ? 0 : 0.3, 6};
      point.state.damage = std::visit(
          [](const auto& l)
          {
            if constexpr (requires { l.fresh_damage(); }) return l.fresh_damage();
          },
          law);
      for (int step = 0; step < 8; ++step)
      {
        SCOPED_TRACE("law " + std::to_string(law.index()) + ", path " + std::to_string(path));
        const Point<dim> P = random_vector<dim>(dice, step < 4 ? 1.5 : 5);
        const InterfaceResponse<dim> response = respond<dim>(law, point, P);
        check(law, point, P, response);
        point.state = response.state;
      }
    }
}

/// Checks derivatives where differences to both sides agree (away from kinks), in all branches on the paths.
template <int dim>
void expect_derivatives()
{
  int n_smooth = 0;
  int n = 0;
  on_random_paths<dim>(
      [&](const Law& law, const LawPoint<dim>& point, const Point<dim>& P,
          const InterfaceResponse<dim>& response)
      {
        const double h = 1e-6;
        for (int b = 0; b < dim; ++b)
        {
          const Point<dim> e = h * Point<dim>::Unit(b);
          const InterfaceResponse<dim> right = respond<dim>(law, point, P + e);
          const InterfaceResponse<dim> left = respond<dim>(law, point, P - e);
          const Point<dim> forward = (right.traction - response.traction) / h;
          const Point<dim> backward = (response.traction - left.traction) / h;
          ++n;
          if ((forward - backward).norm() > 1e-4) continue;  // a kink in between
          ++n_smooth;
          EXPECT_LE(((forward + backward) / 2 - response.derivative.col(b)).norm(), 1e-7);
          EXPECT_NEAR((right.state.damage - left.state.damage) / (2 * h), response.damage_gradient[b], 1e-7);
        }
      });
  EXPECT_GT(n_smooth, 0.99 * n);
}

TEST(InterfaceLaws, DerivativesAreThoseOfTheTraction)
{
  expect_derivatives<2>();
  expect_derivatives<3>();
}

/// The committed state must give the same traction at the same P; otherwise a body under constant load would
/// creep. The law holds whatever the program keeps: opening and slip obey it.
template <int dim>
void expect_promises()
{
  on_random_paths<dim>(
      [&](const Law& law, const LawPoint<dim>& point, const Point<dim>& P,
          const InterfaceResponse<dim>& response)
      {
        LawPoint<dim> committed = point;
        committed.state = response.state;
        const InterfaceResponse<dim> again = respond<dim>(law, committed, P);
        EXPECT_LE((again.traction - response.traction).norm(), 2e-14);
        EXPECT_NEAR(again.state.damage, response.state.damage, 1e-14);
        EXPECT_LE((again.state.slip - response.state.slip).norm(), 2e-14);
        EXPECT_NEAR(again.dissipated, 0, 2e-14);

        EXPECT_GE(response.state.damage, point.state.damage);
        EXPECT_LE(response.state.damage, 1);
        EXPECT_GE(response.dissipated, -1e-14);
        EXPECT_GE(response.rubbed, -1e-14);
        EXPECT_GE(response.stored, 0);
        EXPECT_NEAR(response.state.slip.dot(point.normal), 0, 1e-14);
        const double t_n = response.traction.dot(point.normal);
        if (!std::holds_alternative<problem::Endo>(law))
        {
          EXPECT_GE(response.opening, -1e-15);
          EXPECT_LE(std::max(t_n, 0.0) * (1 - response.state.damage), 1 + 1e-14);
          if (t_n < -1e-14)
          {
            EXPECT_NEAR(response.opening, 0, 1e-15);
          }
        }
      });
}

TEST(InterfaceLaws, KeepTheirPromisesOnRandomPaths)
{
  expect_promises<2>();
  expect_promises<3>();
}

/// Pulling a bond apart takes Gc, whatever the size of the steps.
TEST(InterfaceLaws, BreakingTakesTheFractureEnergy)
{
  for (const Unloading unloading : {Unloading::origin, Unloading::vertical})
  {
    const problem::Tension bond{1.0, 0.8, unloading};
    for (const Law& law :
         {Law(problem::Joint{bond, 0, 1e300, 0.6, false}), Law(problem::Mixed{bond, 0.7, 0})})
      for (const int n_steps : {1, 7, 50})
      {
        LawPoint<2> point{{0, 1}, 0, 6};
        double dissipated = 0;
        for (int i = 1; i <= n_steps; ++i)
        {
          const InterfaceResponse<2> response = respond<2>(law, point, {0, 11.0 * i / n_steps});
          dissipated += response.dissipated;
          point.state = response.state;
        }
        EXPECT_EQ(point.state.damage, 1);
        EXPECT_NEAR(dissipated, 0.8, 1e-14);
      }
  }
}

/// In shear gamma_t = beta^2 gamma may be below the softening slope. The law holds if only gamma exceeds the
/// slope: t_eff = ft (1 - delta_eff / delta_c) with |T^t| = beta t_eff, delta_eff = beta |delta^t|.
TEST(InterfaceLaws, MixedNeedsGammaAboveItsSlope)
{
  const problem::Mixed law{{1.0, 0.8, Unloading::origin}, 0.5, 0};
  const double gamma = 1.5;
  ASSERT_GT(gamma, law.softening_slope());
  ASSERT_LT(gamma * law.tangential_weight(), law.softening_slope());
  const LawPoint<2> point{{0, 1}, 0, gamma};
  const double critical = law.tension.critical_opening();
  for (const double r : {1.2, 1.7, 2.3})
  {
    const InterfaceResponse<2> response = problem::respond<2>(law, point, {r * law.shear_ratio, 0});
    const double jump = (r * law.shear_ratio - response.traction[0]) / (gamma * law.tangential_weight());
    const double effective = law.shear_ratio * jump;
    EXPECT_GT(effective, 0.1);
    EXPECT_NEAR(response.traction[0], law.shear_ratio * (1 - effective / critical), 1e-14);
    EXPECT_NEAR(response.state.damage, effective / critical, 1e-14);
  }
}

/// Under constant pressure, slip alone takes c slip_c / 2 plus the work of friction, whatever its steps.
TEST(InterfaceLaws, SlidingTakesTheCohesion)
{
  const problem::Joint law{{}, 1.2, 1.1, 0.5, false};
  for (const int n_steps : {1, 9})
  {
    LawPoint<2> point{{0, 1}, 0, 6};
    double dissipated = 0;
    double rubbed = 0;
    for (int i = 1; i <= n_steps; ++i)
    {
      const InterfaceResponse<2> response = problem::respond<2>(law, point, {15.0 * i / n_steps, -0.8});
      dissipated += response.dissipated;
      rubbed += response.rubbed;
      point.state = response.state;
    }
    EXPECT_EQ(point.state.damage, 1);
    EXPECT_NEAR(rubbed, 0.4 * point.state.slipped, 1e-14);
    EXPECT_NEAR(dissipated - rubbed, 1.2 * 1.1 / 2, 1e-14);
  }
}

/// Strengths of the law of the thesis for its constants, and the energy of its damage.
TEST(InterfaceLaws, EndoSoftensFromItsStrengths)
{
  const problem::Endo law{5, 4, 0.8, 0.3, 0.12, 0.003};
  LawPoint<2> point{{0, 1}, 0, 50};
  double largest = 0;
  double dissipated = 0;
  for (int i = 1; i <= 4000; ++i)
  {
    const InterfaceResponse<2> response = problem::respond<2>(law, point, {0, 0.01 * i});
    largest = std::max(largest, response.traction[1]);
    dissipated += response.dissipated;
    point.state = response.state;
  }
  EXPECT_NEAR(largest, law.tensile_strength(), 1e-4 * largest);
  EXPECT_NEAR(dissipated, law.energy * point.state.damage, 1e-15);
  EXPECT_GT(point.state.damage, 0.5);
}

}  // namespace
}  // namespace tribound
