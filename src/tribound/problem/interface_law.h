#pragma once

/// @file interface_law.h
/// Interfaces with memory at one point: bonds that soften and break, and friction on the slip since the last
/// committed step (method section 12).
///
/// With the jump delta = (g - u^n) n - u^t (obstacles; -[u]^t and g - [u]^n between bodies) a law is a graph
/// sigma n = t(delta; state). Its resolvent delta*(P), the solution of t(delta*) + gamma delta* = P, makes
/// T = t(delta*) = P - gamma delta* an explicit function of P and of the state [L08]. It is unique while
/// gamma is larger than softening_slope(). The state of a point is that of the last committed step, and never
/// changes within a step; committing the state of delta* leaves T as it is at the same P.

#include <limits>
#include <string>

#include "tribound/base/types.h"

namespace tribound::problem
{

/// What a point of an interface remembers.
template <int dim>
struct InterfaceState
{
  double damage = 0;                     ///< D in [0, 1]: 0 bonded, 1 broken; of Endo alpha
  double slipped = 0;                    ///< q >= 0, length that has slipped; of Endo the plastic opening p^n
  Point<dim> slip = Point<dim>::Zero();  ///< w, tangential: plastic slip of the body; of Endo -p^t
};

enum class ContactStatus
{
  open = 0,
  stick = 1,
  slip = 2,
  tied = 3
};

/// What a law knows of a point, evaluated once.
template <int dim>
struct LawPoint
{
  Point<dim> normal;    ///< the outward unit normal n
  double strength = 0;  ///< of FrictionCone at the point, stress
  double gamma = 0;     ///< of method section 2; needed by laws with a bond and where something slipped
  InterfaceState<dim> state{};  ///< at the last committed step
  double water = 0;             ///< p_w, stress: the law holds for the effective traction T + p_w n
};

/// The response to P = sigma n - gamma (u^n - g) n - gamma_t u^t, gamma_t = tangential_weight() gamma.
template <int dim>
struct InterfaceResponse
{
  Point<dim> traction;         ///< T
  Tensor<dim> derivative;      ///< a generalised derivative DT
  InterfaceState<dim> state;   ///< to commit
  Point<dim> damage_gradient;  ///< of D by P
  double opening = 0;          ///< delta*^n
  double slip_limit = 0;       ///< what |T^t| may reach; infinite where nothing slips
  double dissipated = 0;       ///< by this step, energy per area
  double rubbed = 0;           ///< the part of it due to friction
  double stored = 0;           ///< in the interface, energy per area
  ContactStatus status = ContactStatus::stick;
};

/// What happens when a bond is unloaded.
enum class Unloading
{
  origin,   ///< along the secant to the origin
  vertical  ///< at constant opening, until it closes without traction [TC03]
};

/// Softening in tension: rigid up to the strength ft, then t = ft (1 - delta / delta_c) until the bond is
/// broken at delta_c = 2 Gc / ft.
struct Tension
{
  double strength = 0;         ///< ft, stress
  double fracture_energy = 0;  ///< Gc, energy per area; > 0 with ft > 0
  Unloading unloading = Unloading::origin;

  [[nodiscard]] double critical_opening() const { return 2 * fracture_energy / strength; }
  /// h = ft / delta_c, 0 without bond.
  [[nodiscard]] double slope() const { return strength > 0 ? strength / critical_opening() : 0; }
  /// Secant stiffness k = ft (1 - D) / (D delta_c), D > 0.
  [[nodiscard]] double secant(double damage) const
  {
    return strength * (1 - damage) / (damage * critical_opening());
  }
  /// What is wrong with its constants; empty: nothing.
  [[nodiscard]] std::string fault() const;
  /// Dissipated per area while the damage grows from `before` to `after` without closing: Gc from 0 to 1.
  [[nodiscard]] double dissipated(double before, double after) const;
};

/// "joint": Mohr-Coulomb friction, |T^t| <= s - mu T^n + c (1 - D), with a cohesion c that is lost over a
/// slip of slip_c, and tension softening; compression is rigid. Without bond this is unilateral contact with
/// friction on the slip since the last step.
struct Joint
{
  Tension tension{};
  double cohesion = 0;                                           ///< c, stress
  double slip_length = std::numeric_limits<double>::infinity();  ///< slip_c; infinite: c is never lost
  double coefficient = 0;                                        ///< mu
  bool stick = false;                                            ///< no slip while D < 1

  /// Whether a fresh point holds more than friction does.
  [[nodiscard]] bool is_bonded() const { return tension.strength > 0 || cohesion > 0 || stick; }
  /// D of a fresh point: 0 where there is a bond.
  [[nodiscard]] double fresh_damage() const { return is_bonded() ? 0 : 1; }
  [[nodiscard]] double tangential_weight() const { return 1; }
  /// What gamma has to exceed for one solution: max(ft / delta_c, c / slip_c).
  [[nodiscard]] double softening_slope() const;
};

/// "mixed": one damage for both modes by delta_eff^2 = (delta^n)_+^2 + beta^2 |delta^t|^2, the shear strength
/// being beta ft, and friction beside the bond where it is closed [CO96].
struct Mixed
{
  Tension tension{};
  double shear_ratio = 1;  ///< beta
  double coefficient = 0;  ///< mu; with Unloading::origin only

  [[nodiscard]] double fresh_damage() const { return 0; }
  /// beta^2: (P^n, P^t / beta) is then parallel to (delta^n, beta delta^t), which makes T explicit.
  [[nodiscard]] double tangential_weight() const { return shear_ratio * shear_ratio; }
  [[nodiscard]] double softening_slope() const { return tension.slope(); }
};

/// "endo": elastic-plastic joint with damage [R70125, JOINT_MECA_ENDO]. With S(a) = (1-a)^3 / a^{1/2} its
/// energy is 1/2 K_n (delta^n - p^n)^2 + 1/2 K_t |delta^t - p^t|^2 + 1/2 S(alpha) (B_n p_n^2 + B_t |p_t|^2)
/// + D_1 alpha; plastic flow is along the normals of |X^t| + mu X^n <= 0, X = sigma - S B p.
struct Endo
{
  double normal_stiffness;      ///< K_n > 0, stress per length, as K_t, B_n and B_t
  double tangential_stiffness;  ///< K_t > 0
  double coefficient;           ///< mu > 0
  double normal_hardening;      ///< B_n > 0
  double tangential_hardening;  ///< B_t > 0
  double energy;                ///< D_1 > 0, energy per area

  [[nodiscard]] double fresh_damage() const { return 0; }
  [[nodiscard]] double tangential_weight() const { return 1; }
  [[nodiscard]] double softening_slope() const;
  /// Strengths of the fresh joint in tension and in shear; they must satisfy mu tension <= cohesion <=
  /// 2^{1/2} mu tension.
  [[nodiscard]] double tensile_strength() const;
  [[nodiscard]] double cohesion() const;
};

/// What is wrong with the constants of a law; empty: nothing.
[[nodiscard]] std::string fault(const Joint& law);
[[nodiscard]] std::string fault(const Mixed& law);
[[nodiscard]] std::string fault(const Endo& law);

template <int dim>
[[nodiscard]] InterfaceResponse<dim> respond(const Joint& law, const LawPoint<dim>& point,
                                             const Point<dim>& P);
template <int dim>
[[nodiscard]] InterfaceResponse<dim> respond(const Mixed& law, const LawPoint<dim>& point,
                                             const Point<dim>& P);
template <int dim>
[[nodiscard]] InterfaceResponse<dim> respond(const Endo& law, const LawPoint<dim>& point,
                                             const Point<dim>& P);

}  // namespace tribound::problem
