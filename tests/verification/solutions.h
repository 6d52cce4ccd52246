#pragma once

/// @file solutions.h
/// Manufactured solutions with active contact. rates_test.cpp checks the formulas against each other by
/// finite differences.

#include <fmt/format.h>

#include "verification/manufactured.h"

namespace tribound::test
{

/// Sticks everywhere: u = 0 at the bottom, |sigma^t| < s = 1.
inline Manufactured<2> smooth_stick()
{
  const problem::Material m = problem::lame(1.0, 0.3, problem::PlaneModel::strain);
  const double a = m.lambda + 2 * m.mu;
  const double b = m.lambda + m.mu;
  return {.name = "stick, Tresca",
          .material = m,
          .upper = {2, 1},
          .u = {"0.1*y*sin(pi*x/2)", "-0.3*y*(1 + x^2/8) + 0.05*y^2"},
          .gradient = {"0.05*pi*y*cos(pi*x/2)", "0.1*sin(pi*x/2)", "-0.075*x*y", "-0.3*(1 + x^2/8) + 0.1*y"},
          .body = {fmt::format("{:.17g}*0.025*pi^2*y*sin(pi*x/2) + {:.17g}*0.075*x", a, b),
                   fmt::format("-0.1*{:.17g} + {:.17g}*0.075*y - {:.17g}*0.05*pi*cos(pi*x/2)", a, m.mu, b)},
          .law = Tresca(1)};
}

/// Slips everywhere, with a varying threshold; incompressible in the limit of large lambda.
inline Manufactured<2> full_slip(double lambda, double mu)
{
  const double c = 1 / (1 + lambda);
  const std::string plus = fmt::format("{:.17g}*exp(x*y)", (1 + c) / 6);
  const std::string minus = fmt::format("{:.17g}*exp(x*y)", (c - 1) / 6);
  const std::string gradient_of_div = fmt::format("-{:.17g}*(2 + x*y)*exp(x*y)", (lambda + mu) * c / 3);
  return {.name = fmt::format("slip, Tresca, lambda/mu = {:g}", lambda / mu),
          .material = {lambda, mu, problem::PlaneModel::strain},
          .upper = {1, 1},
          .u = {"x*" + plus, "y*" + minus},
          .gradient = {"(1 + x*y)*" + plus, "x^2*" + plus, "y^2*" + minus, "(1 + x*y)*" + minus},
          .body = {fmt::format("y*({}) - {:.17g}*(2*y + x*y^2 + x^3)*{}", gradient_of_div, mu, plus),
                   fmt::format("x*({}) - {:.17g}*(2*x + x^2*y + y^3)*{}", gradient_of_div, mu, minus)},
          .law = Tresca(formula(fmt::format("{:.17g}*x^2", mu * (lambda + 2) / (6 * (lambda + 1)))))};
}

/// Slips everywhere under Coulomb's law: u = (w + y q, -y b + 0.05 y^2 cos x) with w = 0.1 + 0.05 sin x,
/// b = 0.2 + 0.1 x^2 and q = (mu_F/mu) ((lambda + 2 mu) b - lambda w'), so that sigma_xy = -mu_F sigma_yy at
/// y = 0.
inline Manufactured<2> coulomb_slip()
{
  const problem::Material m = problem::lame(1.0, 0.3, problem::PlaneModel::strain);
  constexpr double mu_F = 0.3;
  const double a = m.lambda + 2 * m.mu;
  const double k = mu_F / m.mu;
  const std::string q = fmt::format("({:.17g}*(0.2 + 0.1*x^2) - {:.17g}*cos(x))", k * a, 0.05 * k * m.lambda);
  const std::string dq = fmt::format("({:.17g}*x + {:.17g}*sin(x))", 0.2 * k * a, 0.05 * k * m.lambda);
  const std::string ddq = fmt::format("({:.17g} + {:.17g}*cos(x))", 0.2 * k * a, 0.05 * k * m.lambda);
  const std::string u1_xx = "(y*" + ddq + " - 0.05*sin(x))";
  const std::string u2_xx = "(-0.2*y - 0.05*y^2*cos(x))";
  const std::string u2_xy = "(-0.2*x - 0.1*y*sin(x))";
  return {.name = "slip, Coulomb",
          .material = m,
          .upper = {1, 1},
          .u = {"0.1 + 0.05*sin(x) + y*" + q, "-y*(0.2 + 0.1*x^2) + 0.05*y^2*cos(x)"},
          .gradient = {"0.05*cos(x) + y*" + dq, q, "-0.2*x*y - 0.05*y^2*sin(x)",
                       "-(0.2 + 0.1*x^2) + 0.1*y*cos(x)"},
          .body = {fmt::format("-{:.17g}*{} - {:.17g}*{}", a, u1_xx, m.lambda + m.mu, u2_xy),
                   fmt::format("-{:.17g}*0.1*cos(x) - {:.17g}*{} - {:.17g}*{}", a, m.mu, u2_xx,
                               m.lambda + m.mu, dq)},
          .law = Coulomb(mu_F)};
}

/// Slips everywhere, in a direction that varies from point to point: u = (w_1 e^y, -y b, w_3 e^y) with
/// w = (0.1 + 0.04 sin(x + z), 0.06 + 0.03 cos(x - z)), b = 0.3 + 0.1 x z + 0.1 sin z; so sigma^t = -mu w and
/// s = mu |w|.
inline Manufactured<3> turning_slip()
{
  const problem::Material m = problem::lame(1.0, 0.3, problem::PlaneModel::strain);
  const double a = m.lambda + m.mu;
  const std::string w1 = "(0.1 + 0.04*sin(x + z))";
  const std::string w3 = "(0.06 + 0.03*cos(x - z))";
  const std::string b = "(0.3 + 0.1*x*z + 0.1*sin(z))";
  const std::string div_w = "(0.04*cos(x + z) + 0.03*sin(x - z))";  // d w_1 / dx + d w_3 / dz
  const std::string div_x = "((-0.04*sin(x + z) + 0.03*cos(x - z))*exp(y) - 0.1*z)";
  const std::string div_y = div_w + "*exp(y)";
  const std::string div_z = "((-0.04*sin(x + z) - 0.03*cos(x - z))*exp(y) - 0.1*x - 0.1*cos(z))";
  const auto force = [&](const std::string& gradient_of_div, const std::string& laplacian)
  { return fmt::format("-{:.17g}*{} - {:.17g}*({})", a, gradient_of_div, m.mu, laplacian); };
  return {.name = "slip in 3D, Tresca",
          .material = m,
          .upper = {1, 1, 1},
          .u = {w1 + "*exp(y)", "-y*" + b, w3 + "*exp(y)"},
          .gradient = {"0.04*cos(x + z)*exp(y)", w1 + "*exp(y)", "0.04*cos(x + z)*exp(y)",  //
                       "-0.1*y*z", "-" + b, "-0.1*y*(x + cos(z))",                          //
                       "-0.03*sin(x - z)*exp(y)", w3 + "*exp(y)", "0.03*sin(x - z)*exp(y)"},
          .body = {force(div_x, "(0.1 - 0.04*sin(x + z))*exp(y)"), force(div_y, "0.1*y*sin(z)"),
                   force(div_z, "(0.06 - 0.03*cos(x - z))*exp(y)")},
          .law = Tresca(formula(fmt::format("{:.17g}*sqrt({}^2 + {}^2)", m.mu, w1, w3)))};
}

}  // namespace tribound::test
