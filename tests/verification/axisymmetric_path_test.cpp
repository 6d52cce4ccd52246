/// @file axisymmetric_path_test.cpp
/// Load paths of bodies of revolution whose interfaces remember, against closed formulas, and the bound of
/// their steps against the dual norm.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/bonded_path.h"
#include "support/meridian_problem.h"
#include "tribound/io/record/load_step_record.h"
#include "verification/path_bound.h"

namespace tribound::test
{

namespace
{

/// A path with the problem and the method that it refers to.
struct MeridianPath
{
  MeridianPath(mesh::MeshData<2> data, const ProblemData<2>& of, adapt::Method options,
               const adapt::PathOptions& path_options = {})
      : MeridianPath(mesh::Mesh<2>(std::move(data)), of, std::move(options), path_options)
  {
  }
  MeridianPath(mesh::Mesh<2> mesh, const ProblemData<2>& of, adapt::Method options,
               const adapt::PathOptions& path_options)
      : method(std::move(options)),
        problem(of.on(mesh).axisymmetric()),
        path(problem, method, path_options, std::move(mesh))
  {
  }
  MeridianPath(const MeridianPath&) = delete;
  MeridianPath& operator=(const MeridianPath&) = delete;

  adapt::Method method;
  problem::Problem<2> problem;
  adapt::LoadPath<2> path;
};

/// A cylinder glued on another one and pulled off along the axis: a spring of stiffness E / 2 per area in
/// series with the bond, which softens from ft to 0 at delta_c.
TEST(AxisymmetricPath, GluedCylindersArePulledApart)
{
  constexpr double ft = 0.02;
  constexpr double fracture_energy = 0.003;
  constexpr double delta_c = 2 * fracture_energy / ft;
  constexpr double stiffness = 0.5;  // of two cylinders of height 1 and E = 1
  ProblemData<2> data{
      .boundaries = {fixed<2>("top", free, formula("t")), fixed<2>("bottom_below", free, 0.0)}};
  data.pairs = {pair<2>("bottom", "top_below",
                        problem::JointLaw({.tension = {ft, fracture_energy}, .coefficient = 0.3}))};
  for (const int degree : {1, 2})
  {
    MeridianPath c(matching_blocks<2>(), data, {.degree = degree, .newton = {.tolerance = 1e-12}});
    std::optional<io::LoadStepRecord> record;
    const auto check = [&](const adapt::LoadStep<2>& step)
    {
      const double opening = std::clamp((step.t * stiffness - ft) / (stiffness - ft / delta_c), 0.0, delta_c);
      const double stress = opening < delta_c ? ft * (1 - opening / delta_c) : 0;
      for (const problem::InterfaceResponse<2>& response : step.responses)
      {
        EXPECT_NEAR(response.traction[1], -std::min(stress, step.t * stiffness), 1e-10) << step.t;
        EXPECT_NEAR(response.state.damage, opening / delta_c, 1e-9) << step.t;
      }
      EXPECT_LE(step.level.estimate.total, 1e-9);
      const auto before = record;
      record = io::load_step_record<2>(step, before ? &*before : nullptr, {});
    };
    for (const double t : {0.02, 0.1, 0.2, 0.4}) ASSERT_EQ(c.path.advance(t, check), "");
    const double area = 4 * std::numbers::pi;  // of radius 2
    EXPECT_NEAR(record->all.measure, area, 1e-9);
    EXPECT_NEAR(record->dissipated, area * fracture_energy, 1e-9);
  }
}

/// A ring is shrunk on another one and pulled off it along the axis, by tractions and displacements that
/// keep the shear at tau = k / r: u_z = k / mu ln(r / a), and from t = 1 on it slips at k = mu_F p b.
TEST(AxisymmetricPath, RingIsPulledOff)
{
  constexpr double a = 1;
  constexpr double b = 1.5;
  constexpr double c = 2;
  constexpr double interference = 0.01;
  constexpr double coefficient = 0.4;
  const auto softness = [](double from, double to)
  { return (to * to + from * from) / (to * to - from * from); };
  const double pressure = interference / b / (softness(a, b) + softness(b, c));  // E = 1, nu = 0
  const double k = coefficient * pressure * b;
  const double shear_modulus = 0.5;
  const double slipped = k / shear_modulus * std::log(c / a);  // the pull at t = 1
  const auto shear = [&](double sign) { return formula(fmt::format("min(t, 1) * ({:.17g}) / x", sign * k)); };
  ProblemData<2> data{
      .boundaries = {fixed<2>("left", free, 0.0),
                     fixed<2>("right_outer", free, formula(fmt::format("{:.17g} * t", slipped))),
                     loaded<2>("top", shear(1), 0), loaded<2>("top_outer", shear(1), 0),
                     loaded<2>("bottom", shear(-1), 0), loaded<2>("bottom_outer", shear(-1), 0)},
      .material = lame(1, 0)};
  data.pairs = {pair<2>("right", "left_outer", problem::JointLaw({.coefficient = coefficient}))};
  data.pairs[0].contact.gap = -interference;
  mesh::MeshData<2> rings =
      side_by_side(box<2>({a, 0}, {b, 1}, {4, 4}), box<2>({b, 0}, {c, 1}, {4, 4}), "_outer");
  rings.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
  MeridianPath m(std::move(rings), data, {.degree = 3, .newton = {.tolerance = 1e-12}});
  double dissipated = 0;
  const auto check = [&](const adapt::LoadStep<2>& step)
  {
    const double expected_slip = std::max(0.0, step.t - 1) * slipped;
    for (const problem::InterfaceResponse<2>& response : step.responses)
    {
      EXPECT_NEAR(response.traction[0], -pressure, 1e-4 * pressure) << step.t;
      EXPECT_NEAR(response.traction[1], std::min(step.t, 1.0) * k / b, 1e-4 * k) << step.t;
      EXPECT_NEAR(response.state.slip.norm(), expected_slip, 1e-4 * slipped) << step.t;
    }
    EXPECT_LE(step.level.estimate.total, 1e-3 * pressure);
    dissipated += integrals<2>(step).dissipated;
  };
  for (const double t : {0.5, 0.9, 1.5, 2.0}) ASSERT_EQ(m.path.advance(t, check), "");
  EXPECT_NEAR(dissipated, k * slipped, 1e-3 * k * slipped);  // of one radian, b (k / b) times the slip
}

enum class Body
{
  disc,  ///< on the axis, on an obstacle
  ring,
  rings  ///< on each other
};

/// It is lifted from its rim, pushed back and sheared.
MeridianPath lifted(Body body, problem::ContactLaw law, int degree, unsigned seed)
{
  constexpr double inner = 0.3;
  const std::string from = body == Body::disc ? "x" : fmt::format("(x - {})", inner);
  ProblemData<2> data{.boundaries = {fixed<2>("top", formula("0.015*t*" + from), formula("0.045*t*" + from)),
                                     loaded<2>("right", formula("0.01*t"), 0)}};
  if (body != Body::disc) data.boundaries.push_back(clamped<2>("left"));
  if (body != Body::rings)
    data.boundaries.push_back(obstacle<2>("bottom", std::move(law)));
  else
  {
    data.boundaries.push_back(clamped<2>("bottom_below"));
    data.regions = {{.name = "box_below", .material = lame(3, 0.2)}};
    data.pairs = {pair<2>("bottom", "top_below", std::move(law))};
  }
  const auto moved = [](const Point<2>& x) -> Point<2> {
    return {x[0] + inner, x[1]};
  };
  mesh::MeshData<2> mesh = body == Body::disc   ? random_meridian(0, 4, seed)
                           : body == Body::ring ? random_meridian(inner, 4, seed)
                                                : mapped(matching_blocks<2>(), moved);
  adapt::Method method{.degree = degree};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  return {std::move(mesh), data, method, {.tolerance = 1e-3}};
}

TEST(AxisymmetricPath, BoundIsAboveTheDualNorm)
{
  for (const int degree : {1, 2, 3})
  {
    SeenRange seen;
    const std::vector<problem::ContactLaw> laws = bonded_laws();
    for (std::size_t i = 0; i < laws.size(); ++i)
      for (const Body body : {Body::disc, Body::ring, Body::rings})
      {
        if (static_cast<std::size_t>(body) != (i + static_cast<std::size_t>(degree)) % 3) continue;
        SCOPED_TRACE(
            fmt::format("degree {}, {}, body {}", degree, problem::words(laws[i]), static_cast<int>(body)));
        MeridianPath c = lifted(body, laws[i], degree, static_cast<unsigned>(i));
        std::vector<double> before;
        for (const double t : path_of_t)
          ASSERT_EQ(c.path.advance(t,
                                   [&](const adapt::LoadStep<2>& step)
                                   {
                                     expect_above_dual_norm<2>(step, before, seen);
                                     before = step.level.u;
                                   }),
                    "");
      }
    fmt::print("p = {}: {} iterates {:.3f} to {:.3f}\n", degree, seen.count, seen.least, seen.most);
  }
}

/// On meshes to which the history was transferred in the middle of the path.
TEST(AxisymmetricPath, BoundIsAboveTheDualNormAfterTransfer)
{
  SeenRange seen;
  for (const problem::ContactLaw& law : bonded_laws())
    for (const Body body : {Body::disc, Body::rings})
    {
      SCOPED_TRACE(fmt::format("{}, body {}", problem::words(law), static_cast<int>(body)));
      MeridianPath c = lifted(body, law, 2, 7);
      expect_above_dual_norm_after_transfer<2>(c.path, seen);
    }
  fmt::print("carried: {} iterates {:.3f} to {:.3f}\n", seen.count, seen.least, seen.most);
}

}  // namespace

}  // namespace tribound::test
