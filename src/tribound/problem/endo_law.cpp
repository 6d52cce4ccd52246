#include <algorithm>
#include <cmath>

#include "tribound/problem/interface_law.h"

namespace tribound::problem
{

namespace
{

/// S(alpha) = (1 - alpha)^3 / alpha^{1/2} with its first two derivatives.
struct Stiffening
{
  double value, slope, curvature;
};

Stiffening stiffening(double alpha)
{
  const double left = 1 - alpha;
  const double root = std::sqrt(alpha);
  return {left * left * left / root, -left * left * (3 / root + left / (2 * alpha * root)),
          left * (6 / root + 3 * left / (alpha * root) + 3 * left * left / (4 * alpha * alpha * root))};
}

/// Where S / (-S')^{1/2} is largest: alpha at the onset of softening.
double strongest_alpha()
{
  constexpr double m1 = 3;
  constexpr double m2 = 0.5;
  return (-m2 + std::sqrt(m1 * m2 / (m1 - m2 + 1))) / (m1 - m2);
}

/// max S / (-S')^{1/2}.
double strongest()
{
  const Stiffening S = stiffening(strongest_alpha());
  return S.value / std::sqrt(-S.slope);
}

/// Plastic jump after the step for a given alpha, and its derivatives.
template <int dim>
struct Flow
{
  double opening;       ///< p^n
  Point<dim> slip;      ///< p^t
  double opening_rate;  ///< d p^n / d alpha
  Point<dim> slip_rate;
  Tensor<dim> by_force;  ///< d (p^n n + p^t) / dP
};

template <int dim>
class EndoStep
{
 public:
  EndoStep(const Endo& law, const LawPoint<dim>& point, const Point<dim>& P)
      : law_(law),
        point_(point),
        n_(point.normal),
        k_n_(in_series(law.normal_stiffness)),
        k_t_(in_series(law.tangential_stiffness)),
        jump_n_(P.dot(n_) / point.gamma),
        jump_t_(P / point.gamma - jump_n_ * n_)
  {
  }

  [[nodiscard]] InterfaceResponse<dim> respond() const
  {
    const double before = std::max(point_.state.damage, strongest_alpha() * 1e-5);
    const double alpha = find_damage(before);
    const bool grows = alpha > before;
    const Flow<dim> p = flow(alpha);
    InterfaceResponse<dim> result;
    const double t_n = k_n_ * (jump_n_ - p.opening);
    const Point<dim> t_t = k_t_ * (jump_t_ - p.slip);
    result.traction = t_n * n_ + t_t;
    const Tensor<dim> along = n_ * n_.transpose();
    const Tensor<dim> stiffness = k_n_ * along + k_t_ * (Tensor<dim>::Identity() - along);
    result.derivative = stiffness * (Tensor<dim>::Identity() / point_.gamma - p.by_force);
    result.damage_gradient.setZero();
    if (grows)
    {
      result.damage_gradient = -driving_gradient(alpha, p) / driving_slope(alpha, p);
      result.derivative -=
          stiffness * (p.opening_rate * n_ + p.slip_rate) * result.damage_gradient.transpose();
    }
    result.state = {grows ? alpha : point_.state.damage, p.opening, -p.slip};
    result.opening = (P_normal() - t_n) / point_.gamma;
    result.status = p.slip == -point_.state.slip ? ContactStatus::stick : ContactStatus::slip;
    if (result.opening > 0 && p.opening > 0) result.status = ContactStatus::open;
    result.slip_limit = std::numeric_limits<double>::infinity();
    result.dissipated = law_.energy * (result.state.damage - point_.state.damage);
    result.stored = t_n * t_n / (2 * law_.normal_stiffness) +
                    t_t.squaredNorm() / (2 * law_.tangential_stiffness) +
                    stiffening(alpha).value * hardening(p) / 2;
    return result;
  }

 private:
  [[nodiscard]] double in_series(double stiffness) const
  {
    return stiffness * point_.gamma / (stiffness + point_.gamma);
  }
  [[nodiscard]] double P_normal() const { return jump_n_ * point_.gamma; }
  /// B_n p_n^2 + B_t |p_t|^2.
  [[nodiscard]] double hardening(const Flow<dim>& p) const
  {
    return law_.normal_hardening * p.opening * p.opening + law_.tangential_hardening * p.slip.squaredNorm();
  }
  /// G(alpha) = 1/2 S'(alpha) (B_n p_n^2 + B_t |p_t|^2) + D_1: damage grows while it is negative.
  [[nodiscard]] double driving(double alpha, const Flow<dim>& p) const
  {
    return stiffening(alpha).slope * hardening(p) / 2 + law_.energy;
  }
  [[nodiscard]] double driving_slope(double alpha, const Flow<dim>& p) const
  {
    const Stiffening S = stiffening(alpha);
    return S.curvature * hardening(p) / 2 + S.slope * (law_.normal_hardening * p.opening * p.opening_rate +
                                                       law_.tangential_hardening * p.slip.dot(p.slip_rate));
  }
  [[nodiscard]] Point<dim> driving_gradient(double alpha, const Flow<dim>& p) const
  {
    const Point<dim> force = law_.normal_hardening * p.opening * n_ + law_.tangential_hardening * p.slip;
    return stiffening(alpha).slope * p.by_force.transpose() * force;
  }

  [[nodiscard]] Flow<dim> flow(double alpha) const
  {
    const Stiffening S = stiffening(alpha);
    const double p_n = point_.state.slipped;
    const Point<dim> p_t = -point_.state.slip;
    const double b_n = law_.normal_hardening;
    const double b_t = law_.tangential_hardening;
    const double mu = law_.coefficient;
    const double x_n = k_n_ * (jump_n_ - p_n) - S.value * b_n * p_n;
    const Point<dim> x_t = k_t_ * (jump_t_ - p_t) - S.value * b_t * p_t;
    const double h_n = k_n_ + S.value * b_n;
    const double h_t = k_t_ + S.value * b_t;
    const double rate_n = -S.slope * b_n;
    const double rate_t = -S.slope * b_t;  // of H, by alpha, up to the sign; X changes by rate p
    const Tensor<dim> along = n_ * n_.transpose();
    const Tensor<dim> tangential = Tensor<dim>::Identity() - along;
    const double size = x_t.norm();
    if (x_n / h_n >= mu * size / h_t)
    {
      const double step_n = x_n / h_n;
      const Point<dim> step_t = x_t / h_t;
      return {p_n + step_n, p_t + step_t, rate_n * (p_n + step_n) / h_n, rate_t * (p_t + step_t) / h_t,
              (k_n_ / h_n * along + k_t_ / h_t * tangential) / point_.gamma};
    }
    const double h = mu * mu * h_n + h_t;
    const double length = (size + mu * x_n) / h;
    if (length <= 0) return {p_n, p_t, 0, Point<dim>::Zero(), Tensor<dim>::Zero()};
    const Point<dim> e = x_t / size;
    const Tensor<dim> turning = (tangential - e * e.transpose()) * (length / size);
    const double length_rate =
        (rate_t * e.dot(p_t) + mu * rate_n * p_n + (mu * mu * rate_n + rate_t) * length) / h;
    const Point<dim> by_force = (k_t_ * e + mu * k_n_ * n_) / (h * point_.gamma);
    return {p_n + mu * length, p_t + length * e, mu * length_rate, length_rate * e + rate_t * (turning * p_t),
            (mu * n_ + e) * by_force.transpose() + k_t_ / point_.gamma * turning};
  }

  /// The root of G above `lowest`, or `lowest` where damage does not grow. G > 0 at 1. Newton's method
  /// between brackets.
  [[nodiscard]] double find_damage(double lowest) const
  {
    const auto G = [this](double alpha) { return driving(alpha, flow(alpha)); };
    if (lowest >= 1 || G(lowest) >= 0) return lowest;
    double low = lowest;
    double high = 1;
    double alpha = (low + high) / 2;
    for (int i = 0; i < 200; ++i)
    {
      const Flow<dim> p = flow(alpha);
      const double value = driving(alpha, p);
      (value < 0 ? low : high) = alpha;
      const double newton = alpha - value / driving_slope(alpha, p);
      const double next = newton > low && newton < high ? newton : (low + high) / 2;
      if (std::abs(next - alpha) <= 1e-16 * alpha) break;
      alpha = next;
    }
    return alpha;
  }

  const Endo& law_;
  const LawPoint<dim>& point_;
  Point<dim> n_;
  double k_n_;  ///< K_n and gamma in series
  double k_t_;
  double jump_n_;      ///< P^n / gamma
  Point<dim> jump_t_;  ///< P^t / gamma
};

}  // namespace

std::string fault(const Endo& law)
{
  for (const double constant : {law.normal_stiffness, law.tangential_stiffness, law.coefficient,
                                law.normal_hardening, law.tangential_hardening, law.energy})
    if (!(constant > 0 && std::isfinite(constant))) return "all constants must be positive";
  const double least = law.coefficient * law.tensile_strength();
  const double cohesion = law.cohesion();
  return cohesion < least * (1 - 1e-12) || cohesion > std::sqrt(2.0) * least * (1 + 1e-12)
             ? "mu tension <= cohesion <= 2^(1/2) mu tension must hold of the strengths"
             : "";
}

double Endo::softening_slope() const
{
  // G has one root while the stiffnesses in series exceed this multiple of the hardening moduli.
  constexpr double stiffest = 0.763244531975;
  const auto slope = [](double stiffness, double hardening)
  {
    const double b = stiffest * hardening;
    return stiffness > b ? stiffness * b / (stiffness - b) : std::numeric_limits<double>::infinity();
  };
  return std::max(
      slope(normal_stiffness, normal_hardening),
      slope(tangential_stiffness, coefficient * coefficient * normal_hardening + tangential_hardening));
}

double Endo::tensile_strength() const
{
  return std::sqrt(2 * energy * normal_hardening) * strongest();
}

double Endo::cohesion() const
{
  return std::sqrt(2 * energy * (coefficient * coefficient * normal_hardening + tangential_hardening)) *
         strongest();
}

template <int dim>
InterfaceResponse<dim> respond(const Endo& law, const LawPoint<dim>& point, const Point<dim>& P)
{
  return EndoStep<dim>(law, point, P).respond();
}

template InterfaceResponse<2> respond(const Endo&, const LawPoint<2>&, const Point<2>&);
template InterfaceResponse<3> respond(const Endo&, const LawPoint<3>&, const Point<3>&);

}  // namespace tribound::problem
