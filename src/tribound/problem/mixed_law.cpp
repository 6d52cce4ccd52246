#include <algorithm>
#include <cmath>

#include "tribound/problem/interface_law.h"

namespace tribound::problem
{

std::string fault(const Mixed& law)
{
  if (std::string of_bond = law.tension.fault(); !of_bond.empty()) return of_bond;
  if (law.tension.strength <= 0) return "a tensile strength is needed";
  if (!(law.shear_ratio > 0)) return "the shear ratio must be positive";
  if (!(law.coefficient >= 0)) return "the coefficient must be 0 or more";
  return law.coefficient > 0 && law.tension.unloading == Unloading::vertical
             ? "friction goes with unloading to the origin only"
             : "";
}

namespace
{

/// The resolvent of softening in one dimension: t(delta) + gamma delta = r, r >= 0.
struct Softened
{
  double traction = 0;      ///< t
  double slope = 0;         ///< dt/dr
  double damage = 0;        ///< after
  double damage_slope = 0;  ///< its derivative by r
};

Softened soften(const Tension& tension, double gamma, double r, double damage)
{
  const double ft = tension.strength;
  const double h = tension.slope();
  const double critical = tension.critical_opening();
  const double largest = damage * critical;  // opening so far
  const double held = ft * (1 - damage);
  if (damage >= 1 || r >= gamma * critical) return {.damage = 1};
  if (r > gamma * largest + held)
    return {(gamma * ft - h * r) / (gamma - h), -h / (gamma - h), (r - ft) / ((gamma - h) * critical),
            1 / ((gamma - h) * critical)};
  if (tension.unloading == Unloading::origin)
  {
    if (damage <= 0) return {r, 1, 0, 0};
    const double k = tension.secant(damage);
    return {k * r / (gamma + k), k / (gamma + k), damage, 0};
  }
  if (r < gamma * largest) return {.damage = damage};
  return {r - gamma * largest, 1, damage, 0};
}

/// The part of P^t that friction takes, with its derivative by P; `holds`: it takes all.
template <int dim>
struct FrictionPart
{
  bool holds = false;
  Point<dim> traction = Point<dim>::Zero();
  Tensor<dim> derivative = Tensor<dim>::Zero();
};

template <int dim>
FrictionPart<dim> friction(const Mixed& law, const LawPoint<dim>& point, double p_n, const Point<dim>& p_t)
{
  if (law.coefficient <= 0 || p_n > 0) return {};
  const double limit = -law.coefficient * p_n;
  const double beta_2 = law.tangential_weight();
  const double secant = point.state.damage > 0 ? law.tension.secant(point.state.damage) : 0;
  const Point<dim> held = -(beta_2 * secant + beta_2 * point.gamma) * point.state.slip;
  const Point<dim> f = p_t - held;
  const double size = f.norm();
  if (size <= limit) return {.holds = true};
  const Point<dim> e = f / size;
  const Tensor<dim> tangential = Tensor<dim>::Identity() - point.normal * point.normal.transpose();
  return {false, limit * e,
          (limit / size) * (tangential - e * e.transpose()) - law.coefficient * e * point.normal.transpose()};
}

}  // namespace

template <int dim>
InterfaceResponse<dim> respond(const Mixed& law, const LawPoint<dim>& point, const Point<dim>& P)
{
  const Point<dim>& n = point.normal;
  const double gamma_t = law.tangential_weight() * point.gamma;
  const double p_n = P.dot(n);
  const Point<dim> p_t = P - p_n * n;
  const Tensor<dim> along = n * n.transpose();
  const FrictionPart<dim> rubbing = friction<dim>(law, point, p_n, p_t);
  InterfaceResponse<dim> result;
  result.damage_gradient.setZero();
  if (rubbing.holds)
  {
    result.traction = p_n * n + p_t + gamma_t * point.state.slip;
    result.derivative = Tensor<dim>::Identity();
    result.state = point.state;
    result.slip_limit = std::numeric_limits<double>::infinity();
  }
  else
  {
    const Point<dim> p_c = p_t - rubbing.traction;  // the part that the bond takes
    const Tensor<dim> d_p_c = Tensor<dim>::Identity() - along - rubbing.derivative;
    const double pulling = std::max(p_n, 0.0);
    const double r = std::sqrt(pulling * pulling + p_c.squaredNorm() / law.tangential_weight());
    const Softened bond = soften(law.tension, point.gamma, r, point.state.damage);
    const double rho = r > 0 ? bond.traction / r : bond.slope;
    const double d_rho = r > 0 ? (bond.slope - rho) / r : 0;
    Point<dim> d_r = Point<dim>::Zero();
    if (r > 0) d_r = (pulling * n + d_p_c.transpose() * p_c / law.tangential_weight()) / r;
    const double open_part = p_n > 0 ? rho : 1;
    result.traction = open_part * p_n * n + rho * p_c + rubbing.traction;
    result.derivative =
        open_part * along + rho * d_p_c + d_rho * (pulling * n + p_c) * d_r.transpose() + rubbing.derivative;
    result.state = {bond.damage, 0, -(1 - rho) / gamma_t * p_c};
    result.damage_gradient = bond.damage_slope * d_r;
    result.slip_limit = rubbing.traction.norm() + rho * p_c.norm();
    result.opening = (1 - open_part) * p_n / point.gamma;
    result.rubbed = rubbing.traction.dot(point.state.slip - result.state.slip);
  }
  result.dissipated = law.tension.dissipated(point.state.damage, result.state.damage) + result.rubbed;
  const double D = result.state.damage;
  if (result.opening > 0)
    result.status = ContactStatus::open;
  else if (result.state.slip != point.state.slip)
    result.status = ContactStatus::slip;
  if (law.tension.unloading == Unloading::origin && D > 0)
  {
    const double open = result.opening;
    const double squared = open * open + law.tangential_weight() * result.state.slip.squaredNorm();
    result.stored = law.tension.secant(D) * squared / 2;
  }
  return result;
}

template InterfaceResponse<2> respond(const Mixed&, const LawPoint<2>&, const Point<2>&);
template InterfaceResponse<3> respond(const Mixed&, const LawPoint<3>&, const Point<3>&);

}  // namespace tribound::problem
