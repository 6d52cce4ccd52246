#pragma once

/// @file contact_law.h
/// The laws of contact at one point, method section 2: what the traction T is as a function of
/// P = sigma n - gamma (u - g n), so that P^n = P.n and P^t = P - P^n n.
///
/// A law is a struct that satisfies `Law`, with its two functions respond() and tangent() in contact_law.cpp,
/// and a place in the variant ContactLaw. Everything else (form, bound, statics, case file, words) goes
/// through the functions at the end of this file.

#include <array>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::problem
{

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
};

/// The answer to P.
template <int dim>
struct Response
{
  Point<dim> traction;   ///< T
  double limit;          ///< S_h: what |T^t| may reach, stress; infinite where tied
  ContactStatus status;  ///< of the law itself, without regularisation
};

/// What friction can hold at most: |T^t| <= strength + coefficient |T^n|. In S_h this is so with equality
/// where the contact is closed; S_h is then affine in P^n and the strength.
struct FrictionCone
{
  const Field* strength = nullptr;  ///< s(x) >= 0, stress; null for 0
  double coefficient = 0;           ///< mu_F >= 0
  bool is_tied = false;             ///< it holds anything, tension too

  /// Whether there is anything to hold.
  [[nodiscard]] bool resists_sliding() const
  {
    return is_tied || coefficient > 0 || (strength != nullptr && !strength->is_zero());
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
  [[nodiscard]] std::string words() const;
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
  [[nodiscard]] std::string words() const;
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
  [[nodiscard]] std::string words() const;
};

/// [u] = 0, between bodies alone: T(P) = P.
struct Tied
{
  static constexpr std::string_view name = "tied";
  static constexpr std::array<LawKey, 0> keys = {};
  static constexpr bool is_minimum = true;

  explicit Tied(std::span<const Field> = {}) {}
  [[nodiscard]] FrictionCone cone() const { return {.is_tied = true}; }
  [[nodiscard]] std::string words() const;
};

/// What every law has: its name and keys in the case file, how it is made from their values, what it holds at
/// most, its description, and whether the solution is the minimum of a strictly convex energy.
template <class L>
concept Law = std::constructible_from<L, std::span<const Field>> && requires(const L& law)
{
  {
    L::name
    } -> std::convertible_to<std::string_view>;
  {std::span<const LawKey>(L::keys)};
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

using ContactLaw = std::variant<Frictionless, Tresca, Coulomb, Tied>;

/// T(P) with limit and status; T_delta with the regularised projections of method section 7 for delta > 0.
template <int dim>
[[nodiscard]] Response<dim> respond(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P,
                                    double delta = 0);

/// A generalised derivative DT(P).
template <int dim>
[[nodiscard]] Tensor<dim> tangent(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P,
                                  double delta = 0);

[[nodiscard]] FrictionCone cone(const ContactLaw& law);

/// Such as "Tresca friction, threshold 0.03".
[[nodiscard]] std::string words(const ContactLaw& law);

/// "none", "tresca", ...
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

/// All laws, in the order of the variant; and those of contact with an obstacle.
[[nodiscard]] std::span<const LawKind> law_kinds();
[[nodiscard]] std::span<const LawKind> obstacle_law_kinds();

}  // namespace tribound::problem
