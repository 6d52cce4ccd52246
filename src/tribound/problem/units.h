#pragma once

/// @file units.h
/// The names that a case gives its units. They are labels: no number depends on them.

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tribound::problem
{

/// The kind of quantity that a unit belongs to. L is a length, S a stress, d the dimension. Forces, moments
/// and energies are per unit of depth in 2D.
enum class UnitOf
{
  length,
  boundary,         ///< L^(d - 1): a part of the boundary
  body,             ///< L^d: a part of the body
  stress,           ///< force / L^2
  body_force,       ///< force / L^3, also S / L
  fracture_energy,  ///< force / L, energy per area
  force,
  moment,
  energy,
  stress_norm,  ///< S L^(d / 2): norms of stresses in L2, the bound
  energy_norm   ///< energy^(1/2)
};

/// Their names in files, in the order of docs/output.md.
inline constexpr std::array<std::pair<const char*, UnitOf>, 11> unit_names = {
    {{"length", UnitOf::length},
     {"boundary", UnitOf::boundary},
     {"body", UnitOf::body},
     {"stress", UnitOf::stress},
     {"body_force", UnitOf::body_force},
     {"fracture_energy", UnitOf::fracture_energy},
     {"force", UnitOf::force},
     {"moment", UnitOf::moment},
     {"energy", UnitOf::energy},
     {"stress_norm", UnitOf::stress_norm},
     {"energy_norm", UnitOf::energy_norm}}};

class Units
{
 public:
  /// For a case that names none: all labels are empty.
  Units() = default;
  /// Names from length_names() and force_names().
  Units(std::string_view length, std::string_view force);

  [[nodiscard]] bool are_named() const { return !length_.empty(); }
  /// Such as "N/mm^3", in 2D "N mm/mm" for moments. Stresses have their own names where there are such: MPa
  /// for N/mm^2, psi for lbf/in^2. Labels of lengths, stresses, body forces and fracture energies are the
  /// same in any dimension.
  [[nodiscard]] std::string label(UnitOf what, int dimension = 3) const;
  /// " MPa", as it follows a number; empty where no units are named.
  [[nodiscard]] std::string behind(UnitOf what, int dimension = 3) const;

  /// Metres in a unit of length, pascals in a unit of stress; 1 where none are named.
  [[nodiscard]] double metres() const;
  [[nodiscard]] double pascals() const;

 private:
  [[nodiscard]] double newtons() const;
  [[nodiscard]] std::string stress() const;

  std::string length_;
  std::string force_;
};

/// What [units] of a case may name, the smallest first.
[[nodiscard]] std::vector<std::string> length_names();
[[nodiscard]] std::vector<std::string> force_names();

}  // namespace tribound::problem
