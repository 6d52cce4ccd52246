#pragma once

/// @file verified_quantities.h
/// The intervals of the quantities beside what a richer solution says of them. Plain data in, text out.

#include <optional>
#include <string>
#include <vector>

#include "tribound/certify/energy/interval_comparison.h"
#include "tribound/io/file/json_forward.h"

namespace tribound::app
{

/// A [[quantity]] of an iterate.
struct VerifiedQuantity
{
  certify::QuantityInterval interval{};               ///< with the value of the iterate
  std::optional<certify::QuantityInterval> richer{};  ///< of the richer solution, with its value
  /// Whether the interval is one of the number: it and that of the richer solution have a point in common.
  certify::IntervalComparison comparison{};

  /// Where in the interval the value of the richer solution lies, 0: at the lower end, 1: at the upper;
  /// nothing without both and where the ends differ by rounding.
  [[nodiscard]] std::optional<double> position() const;
};

/// The quantities of an iterate with this bound; `richer`: the bound of the richer solution, if there is one.
[[nodiscard]] std::vector<VerifiedQuantity> verified_quantities(
    const certify::EnergyBound& bound, const std::optional<certify::EnergyBound>& richer);

/// Whether the interval holds the number: nothing where that is not for certain, or for any of several.
[[nodiscard]] std::optional<bool> hold(const std::vector<VerifiedQuantity>& quantities);

/// What is wrong where an interval does not hold its number, as the end of a sentence; empty: nothing.
[[nodiscard]] std::string violation(const std::vector<VerifiedQuantity>& quantities);

/// A line for each.
[[nodiscard]] std::string quantities_text(const std::vector<VerifiedQuantity>& quantities);

/// The fields of docs/output.md; what is not known is null.
[[nodiscard]] io::Json quantities_json(const std::vector<VerifiedQuantity>& quantities);

}  // namespace tribound::app
