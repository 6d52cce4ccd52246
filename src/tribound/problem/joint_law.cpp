#include <algorithm>
#include <cmath>

#include "tribound/problem/interface_law.h"

namespace tribound::problem
{

double Tension::dissipated(double before, double after) const
{
  const double whole = strength * critical_opening();
  if (strength <= 0) return 0;
  if (unloading == Unloading::origin) return whole * (after - before) / 2;
  return whole * ((after - after * after / 2) - (before - before * before / 2));
}

std::string Tension::fault() const
{
  if (!(strength >= 0 && fracture_energy >= 0)) return "strength and fracture energy must be 0 or more";
  if (strength > 0 && fracture_energy <= 0) return "a tensile strength needs a fracture energy";
  return strength <= 0 && fracture_energy > 0 ? "a fracture energy needs a tensile strength" : "";
}

std::string fault(const Joint& law)
{
  if (std::string of_bond = law.tension.fault(); !of_bond.empty()) return of_bond;
  if (!(law.cohesion >= 0 && law.coefficient >= 0)) return "cohesion and coefficient must be 0 or more";
  if (!(law.slip_length > 0)) return "the slip length must be positive";
  if (std::isfinite(law.slip_length) && law.cohesion <= 0) return "a slip length needs a cohesion";
  if (law.stick && law.tension.strength <= 0) return "what sticks until it breaks needs a tensile strength";
  return law.stick && law.cohesion > 0 ? "stick excludes a cohesion" : "";
}

double Joint::softening_slope() const
{
  return std::max(tension.slope(), cohesion / slip_length);
}

namespace
{

/// A value and its derivative by P.
template <int dim>
struct Value
{
  double value = 0;
  Point<dim> gradient = Point<dim>::Zero();
};

/// P at a point of a joint, split into its parts, and its damage.
template <int dim>
class JointStep
{
 public:
  JointStep(const Joint& law, const LawPoint<dim>& point, const Point<dim>& P)
      : law_(law),
        point_(point),
        n_(point.normal),
        p_n_(P.dot(n_)),
        p_t_(P - p_n_ * n_ + point.gamma * point.state.slip),
        a_(p_t_.norm()),
        e_(a_ > 0 ? Point<dim>(p_t_ / a_) : Point<dim>::Zero()),
        friction_(point.strength - law.coefficient * std::min(p_n_, 0.0))
  {
    find_damage();
  }

  [[nodiscard]] InterfaceResponse<dim> respond() const
  {
    const double gamma = point_.gamma;
    const Value<dim> normal = normal_traction();
    const bool sticks = law_.stick && damage_.value < 1;
    const double limit =
        sticks ? std::numeric_limits<double>::infinity() : friction_ + cohesion_left(damage_.value);
    const Tensor<dim> tangential = Tensor<dim>::Identity() - n_ * n_.transpose();
    const bool slips = !sticks && (a_ > limit || limit <= 0);

    InterfaceResponse<dim> result;
    result.traction = normal.value * n_ + (slips ? Point<dim>(limit * e_) : p_t_);
    result.derivative = n_ * normal.gradient.transpose();
    if (!slips)
      result.derivative += tangential;
    else if (a_ > 0)
      result.derivative +=
          e_ * limit_gradient().transpose() + (limit / a_) * (tangential - e_ * e_.transpose());
    const double x = slips ? std::max(a_ - limit, 0.0) / gamma : 0;
    result.state = {damage_.value, point_.state.slipped + x, point_.state.slip - x * e_};
    result.damage_gradient = damage_.gradient;
    result.opening = (p_n_ - normal.value) / gamma;
    result.slip_limit = limit;
    result.rubbed = friction_ * x;
    result.dissipated = result.rubbed + dissipated_by_opening(normal.value) + dissipated_by_cohesion(x);
    result.status = slips ? ContactStatus::slip : ContactStatus::stick;
    if (result.opening > 0) result.status = ContactStatus::open;
    if (law_.tension.unloading == Unloading::origin) result.stored = normal.value * result.opening / 2;
    return result;
  }

 private:
  /// D = max(D_old, D_n, D_t) by opening and by slip; both tractions belong to the same D.
  void find_damage()
  {
    damage_.value = point_.state.damage;
    const Tension& tension = law_.tension;
    if (tension.strength > 0)
    {
      const double slope = (point_.gamma - tension.slope()) * tension.critical_opening();
      const double by_opening = std::clamp((p_n_ - tension.strength) / slope, 0.0, 1.0);
      opened_ = std::max(damage_.value, by_opening);
      if (by_opening > damage_.value)
        damage_ = {by_opening, by_opening < 1 ? Point<dim>(n_ / slope) : Point<dim>::Zero()};
    }
    else
      opened_ = damage_.value;
    if (law_.cohesion <= 0 || !std::isfinite(law_.slip_length)) return;
    const double slope = point_.gamma - law_.cohesion / law_.slip_length;
    const double x = (a_ - friction_ - law_.cohesion * (1 - point_.state.slipped / law_.slip_length)) / slope;
    if (x <= 0) return;
    const double by_slip = std::min((point_.state.slipped + x) / law_.slip_length, 1.0);
    if (by_slip <= damage_.value) return;
    damage_ = {by_slip, Point<dim>::Zero()};
    if (by_slip < 1) damage_.gradient = (e_ + coefficient_in_contact() * n_) / (slope * law_.slip_length);
  }

  [[nodiscard]] double coefficient_in_contact() const { return p_n_ <= 0 ? law_.coefficient : 0; }
  [[nodiscard]] double cohesion_left(double damage) const { return law_.cohesion * (1 - damage); }
  [[nodiscard]] Point<dim> limit_gradient() const
  {
    return -coefficient_in_contact() * n_ - law_.cohesion * damage_.gradient;
  }

  /// T^n with its derivative.
  [[nodiscard]] Value<dim> normal_traction() const
  {
    const Tension& tension = law_.tension;
    if (p_n_ <= 0) return {p_n_, n_};
    if (tension.strength <= 0) return {};
    const double ft = tension.strength;
    const double D = damage_.value;
    const double held = ft * (1 - D);
    const double width = point_.gamma * tension.critical_opening();
    if (tension.unloading == Unloading::origin)
    {
      const double M = width * D + held;
      return {held * p_n_ / M,
              held / M * n_ - p_n_ * (ft * M + held * (width - ft)) / (M * M) * damage_.gradient};
    }
    const double above = p_n_ - width * D;
    Value<dim> result{std::clamp(above, 0.0, held)};
    if (above >= 0 && D < 1) result.gradient = n_ - width * damage_.gradient;
    return result;
  }

  /// Dissipated by the bond in tension: while it opens, and where slip breaks it when it is open.
  [[nodiscard]] double dissipated_by_opening(double normal_traction) const
  {
    const Tension& tension = law_.tension;
    const double D = damage_.value;
    double energy = tension.dissipated(point_.state.damage, opened_);
    if (tension.strength <= 0 || p_n_ <= 0 || D <= opened_) return energy;
    if (tension.unloading == Unloading::vertical)
      return energy + normal_traction * tension.critical_opening() * (D - opened_);
    if (opened_ > 0)
    {
      const double opening = p_n_ / (point_.gamma + tension.secant(opened_));
      energy += opening * opening * (tension.secant(opened_) - tension.secant(D)) / 2;
    }
    return energy;
  }

  /// Dissipated by the cohesion c (1 - D) over a slip of length x, with D growing.
  [[nodiscard]] double dissipated_by_cohesion(double x) const
  {
    const double c = law_.cohesion;
    if (c <= 0) return 0;
    const double left = 1 - opened_;
    if (!std::isfinite(law_.slip_length)) return c * left * x;
    const double q = point_.state.slipped;
    const double first = std::clamp(law_.slip_length * opened_, q, q + x);
    const double last = std::clamp(law_.slip_length, first, std::max(first, q + x));
    return c * (left * (first - q) + (last - first) - (last * last - first * first) / (2 * law_.slip_length));
  }

  const Joint& law_;
  const LawPoint<dim>& point_;
  Point<dim> n_;
  double p_n_;         ///< P^n
  Point<dim> p_t_;     ///< P^t with the remembered slip
  double a_;           ///< |P^t|
  Point<dim> e_;       ///< its direction
  double friction_;    ///< R = s - mu min(P^n, 0)
  double opened_ = 0;  ///< max(D_old, D_n)
  Value<dim> damage_;
};

}  // namespace

template <int dim>
InterfaceResponse<dim> respond(const Joint& law, const LawPoint<dim>& point, const Point<dim>& P)
{
  return JointStep<dim>(law, point, P).respond();
}

template InterfaceResponse<2> respond(const Joint&, const LawPoint<2>&, const Point<2>&);
template InterfaceResponse<3> respond(const Joint&, const LawPoint<3>&, const Point<3>&);

}  // namespace tribound::problem
