#pragma once

/// @file contact_law.h
/// The laws of contact at one point, method section 2: the traction T as a function of
/// P = sigma n - gamma (u - g n), so that P^n = P.n and P^t = P - P^n n.
///
/// A law is a struct that satisfies `Law`, with its functions in contact_law.cpp or, where it has a bond, in
/// interface_law.h, and a place in the variant ContactLaw. Everything else (form, bound, statics, case file,
/// words) goes through the functions at the end of this file.

#include <array>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"
#include "tribound/problem/interface_law.h"
#include "tribound/problem/units.h"

namespace tribound::problem
{

/// The response to P.
template <int dim>
struct Response
{
  Point<dim> traction;   ///< T
  double limit;          ///< S_h: what |T^t| may reach, stress; infinite where tied
  ContactStatus status;  ///< of the law itself, without regularisation
};

/// The most that friction can hold: |T^t| <= strength + coefficient |T^n|. In S_h equality holds where the
/// contact is closed; S_h is then affine in P^n and the strength.
struct FrictionCone
{
  const Field* strength = nullptr;  ///< s(x) >= 0, stress; null for 0
  double coefficient = 0;           ///< mu_F >= 0
  bool is_tied = false;             ///< it holds anything, tension too
  bool is_bilateral = false;        ///< [u]^n = g: it holds tension along n, too
  bool is_bonded = false;           ///< at first it holds more than this, until it breaks
  bool holds_tension = false;       ///< the bond does

  /// Whether the two sides are joined as long as nothing breaks.
  [[nodiscard]] bool glues() const { return is_tied || holds_tension; }
  /// Whether there is anything to hold.
  [[nodiscard]] bool resists_sliding() const
  {
    return is_tied || is_bonded || coefficient > 0 || (strength != nullptr && !strength->is_zero());
  }
  /// strength + coefficient |T^n| for T^n = p_n <= 0.
  [[nodiscard]] double closed_limit(double strength_here, double p_n) const
  {
    return strength_here - coefficient * p_n;
  }
};

/// A key of the case file that belongs to a law.
struct LawKey
{
  std::string_view key;
  bool is_number;            ///< one number >= 0; else a field >= 0
  std::string_view meaning;  ///< for messages
};

/// |sigma^t| = 0.
struct Frictionless
{
  static constexpr std::string_view name = "none";
  static constexpr std::array<LawKey, 0> keys = {};
  static constexpr bool is_minimum = true;

  explicit Frictionless(std::span<const Field> = {}) {}
  [[nodiscard]] FrictionCone cone() const { return {}; }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

/// |sigma^t| <= s(x).
struct Tresca
{
  Field threshold;  ///< s >= 0, stress

  static constexpr std::string_view name = "tresca";
  static constexpr std::array keys = {
      LawKey{"threshold", false, "the largest tangential stress, a number or formula: threshold = 0.03"}};
  static constexpr bool is_minimum = true;

  explicit Tresca(Field s) : threshold(std::move(s)) {}
  explicit Tresca(std::span<const Field> values) : threshold(values[0]) {}
  [[nodiscard]] FrictionCone cone() const { return {.strength = &threshold}; }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

/// |sigma^t| <= mu_F |sigma^n|.
struct Coulomb
{
  double coefficient;  ///< mu_F >= 0

  static constexpr std::string_view name = "coulomb";
  static constexpr std::array keys = {
      LawKey{"coefficient", true, "the friction coefficient: coefficient = 0.3"}};
  static constexpr bool is_minimum = false;

  explicit Coulomb(double mu) : coefficient(mu) {}
  explicit Coulomb(std::span<const Field> values);
  [[nodiscard]] FrictionCone cone() const { return {.coefficient = coefficient}; }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

/// [u]^n = g, in tension, too, and |sigma^t| = 0: T(P) = P^n n.
struct Slider
{
  static constexpr std::string_view name = "slider";
  static constexpr std::array<LawKey, 0> keys = {};
  static constexpr bool is_minimum = true;

  explicit Slider(std::span<const Field> = {}) {}
  [[nodiscard]] FrictionCone cone() const { return {.is_bilateral = true}; }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

/// [u] = 0, only between bodies: T(P) = P.
struct Tied
{
  static constexpr std::string_view name = "tied";
  static constexpr std::array<LawKey, 0> keys = {};
  static constexpr bool is_minimum = true;

  explicit Tied(std::span<const Field> = {}) {}
  [[nodiscard]] FrictionCone cone() const { return {.is_tied = true, .is_bilateral = true}; }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

/// Joint with a friction threshold that may vary.
struct JointLaw : Joint
{
  Field threshold;  ///< s >= 0, stress

  static constexpr std::string_view name = "joint";
  static constexpr bool is_minimum = false;

  explicit JointLaw(const Joint& joint, Field s = 0.0) : Joint(joint), threshold(std::move(s)) {}
  [[nodiscard]] FrictionCone cone() const
  {
    return {.strength = &threshold,
            .coefficient = coefficient,
            .is_bonded = is_bonded(),
            .holds_tension = tension.strength > 0};
  }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

struct MixedLaw : Mixed
{
  static constexpr std::string_view name = "mixed";
  static constexpr bool is_minimum = false;

  explicit MixedLaw(const Mixed& mixed) : Mixed(mixed) {}
  [[nodiscard]] FrictionCone cone() const
  {
    return {.coefficient = coefficient, .is_bonded = true, .holds_tension = true};
  }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

struct EndoLaw : Endo
{
  static constexpr std::string_view name = "endo";
  static constexpr bool is_minimum = false;

  explicit EndoLaw(const Endo& endo) : Endo(endo) {}
  [[nodiscard]] FrictionCone cone() const
  {
    return {.coefficient = coefficient, .is_bonded = true, .holds_tension = true};
  }
  [[nodiscard]] std::string words(const Units& units = {}) const;
};

/// What every law has: its name, what it holds at most, its description, and whether the solution is the
/// minimum of a strictly convex energy.
template <class L>
concept Law = requires(const L& law)
{
  {
    L::name
    } -> std::convertible_to<std::string_view>;
  {
    L::is_minimum
    } -> std::convertible_to<bool>;
  {
    law.cone()
    } -> std::same_as<FrictionCone>;
  {
    law.words()
    } -> std::same_as<std::string>;
};

/// A law without bond: it has keys in the case file, and is made from their values.
template <class L>
concept FrictionLaw = Law<L> && std::constructible_from<L, std::span<const Field>> && requires
{
  {std::span<const LawKey>(L::keys)};
};

using ContactLaw = std::variant<Frictionless, Tresca, Coulomb, Slider, Tied, JointLaw, MixedLaw, EndoLaw>;

/// name() of all, in this order.
inline constexpr std::array law_names = {Frictionless::name, Tresca::name,   Coulomb::name,  Slider::name,
                                         Tied::name,         JointLaw::name, MixedLaw::name, EndoLaw::name};
static_assert(law_names.size() == std::variant_size_v<ContactLaw>);

/// The following functions include the water in a joint: with T_e, the effective traction of the law without
/// water,
///     T(P) = T_e(P + p_w n) - p_w n,   DT(P) = DT_e(P + p_w n).
/// Limits, states, stored and dissipated energies are those of the effective traction.

/// T(P) with limit and status; T_delta with the regularised projections of method section 7 for delta > 0.
template <int dim>
[[nodiscard]] Response<dim> respond(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P,
                                    double delta = 0);

/// T(P) at many points, faster than one by one.
template <int dim>
void tractions(const ContactLaw& law, std::span<const LawPoint<dim>> points, std::span<const Point<dim>> P,
               std::span<Point<dim>> T);

/// A generalised derivative DT(P).
template <int dim>
[[nodiscard]] Tensor<dim> tangent(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P,
                                  double delta = 0);

/// What a step that ends with P commits: for Joint, Mixed and Endo their own response; for friction without
/// bond that of a Joint with the same cone, the slip; for Tied nothing. Needs `point.gamma`.
template <int dim>
[[nodiscard]] InterfaceResponse<dim> advance(const ContactLaw& law, const LawPoint<dim>& point,
                                             const Point<dim>& P);

/// The state of an unbroken interface before the first step.
template <int dim>
[[nodiscard]] InterfaceState<dim> fresh_state(const ContactLaw& law);

/// The admissible state of a law that is nearest to one interpolated between points: 0 <= D <= 1, q >= 0, and
/// for a joint whose cohesion is lost by slip q <= D slip_c while D < 1.
template <int dim>
[[nodiscard]] InterfaceState<dim> admissible(const ContactLaw& law, InterfaceState<dim> state);

/// What is wrong with the constants of a law with a bond; empty: nothing.
[[nodiscard]] std::string fault(const ContactLaw& law);

/// What gamma has to exceed: Joint::softening_slope() and others; 0 without bond.
[[nodiscard]] double softening_slope(const ContactLaw& law);

/// gamma_t / gamma: 1 for all but Mixed.
[[nodiscard]] double tangential_weight(const ContactLaw& law);

[[nodiscard]] FrictionCone cone(const ContactLaw& law);

/// Whether it is one of the laws of interface_law.h.
[[nodiscard]] bool has_memory(const ContactLaw& law);

/// Such as "Tresca friction, threshold 0.03".
[[nodiscard]] std::string words(const ContactLaw& law, const Units& units = {});

/// "none", "tresca", ..., "endo".
[[nodiscard]] std::string_view name(const ContactLaw& law);

/// Whether the exact solution is the minimum of a strictly convex energy.
[[nodiscard]] bool is_minimum(const ContactLaw& law);

/// A law as the case file names it.
struct LawKind
{
  std::string_view name;
  std::span<const LawKey> keys;
  ContactLaw (*make)(std::span<const Field> values);  ///< a value for each key
};

/// All laws without bond, in the order of the variant; and those of unilateral contact with an obstacle.
[[nodiscard]] std::span<const LawKind> law_kinds();
[[nodiscard]] std::span<const LawKind> obstacle_law_kinds();

}  // namespace tribound::problem
