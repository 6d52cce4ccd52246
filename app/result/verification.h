#pragma once

/// @file verification.h
/// The report of `tribound verify`: the bound next to the quantity it bounds. Plain data in, text out.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/energy/interval_comparison.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/facts.h"
#include "tribound/solve/newton.h"

namespace tribound::app
{

/// A [[quantity]] of an iterate.
struct VerifiedQuantity
{
  certify::QuantityInterval interval{};               ///< with the value of the iterate
  std::optional<certify::QuantityInterval> richer{};  ///< of the richer solution, with its value
  /// Whether the interval intersects that of the richer solution, as it must: both contain the exact value.
  certify::IntervalComparison comparison{};

  /// The position in the interval of the richer solution's value, 0: at the lower end, 1: at the upper.
  /// Nothing unless both exist, or if the ends differ only by rounding.
  [[nodiscard]] std::optional<double> position() const;
};

/// The quantities of an iterate with this bound; `richer`: the bound of the richer solution, if there is one.
[[nodiscard]] std::vector<VerifiedQuantity> verified_quantities(
    const certify::EnergyBound& bound, const std::optional<certify::EnergyBound>& richer);

/// Whether the intervals contain their values; nothing where this is certain for none of them.
[[nodiscard]] std::optional<bool> hold(const std::vector<VerifiedQuantity>& quantities);

/// What is wrong where an interval does not contain its value, as the end of a sentence; empty: nothing.
[[nodiscard]] std::string violation(const std::vector<VerifiedQuantity>& quantities);

/// A line for each.
[[nodiscard]] std::string quantities_text(const std::vector<VerifiedQuantity>& quantities,
                                          const io::CaseFacts& facts);

/// The fields of docs/output.md; unknown values are null.
[[nodiscard]] io::Json quantities_json(const std::vector<VerifiedQuantity>& quantities);

/// One Newton iterate: its bound and the dual norm of its residual from below, stress units times
/// length^(dim/2).
struct VerifiedIterate
{
  solve::NewtonStep step;
  double bound = 0;        ///< the certificate's bound (total_sharp)
  double bound_plain = 0;  ///< with plain sums, as in the paper
  double dual_norm = 0;
  contact::StressNorms norms;  ///< of u^k
  double identities = 0;       ///< the largest defect, relative to the stress, or to the largest of a path
  int load_step = 0;           ///< from 1, or 0: there are none
  double t = 0;                ///< of the load step
  double path_sigma = 0;       ///< the largest ||sigma|| of the path so far: the reference for rounding
  std::optional<certify::EnergyBound> energy{};  ///< with the intervals of the quantities, if there are any

  [[nodiscard]] std::optional<double> effectivity() const
  {
    contact::StressNorms size = norms;
    size.sigma = std::max(size.sigma, path_sigma);
    return tribound::certify::effectivity(bound, dual_norm, size);
  }
  /// Whether an identity is violated beyond rounding, so that `bound` may not be one.
  [[nodiscard]] std::string refusal() const;
};

/// A space in which a more accurate solution was computed.
struct RicherSpaceFacts
{
  int degree = 0;
  long cells = 0;
  long dofs = 0;  ///< fixed ones included
};

struct Verification
{
  io::CaseFacts facts;
  io::MeshFacts mesh;
  int refinements = 0;
  RicherSpaceFacts dual_space;
  std::vector<VerifiedIterate> iterates;  ///< k = 1, 2, ..., load step by load step; the last is the solution
  bool converged = false;
  int richer_degree = 0;
  /// The solution compared with, if there is one and there are no load steps.
  std::optional<certify::RicherSolution> richer;
  std::optional<certify::EnergyBound> energy;         ///< of the same solution, where requested
  std::optional<certify::EnergyBound> richer_energy;  ///< of the richer one, for the intervals of quantities
  std::vector<std::pair<std::string, double>> times;  ///< s per stage

  /// Bound of the error in the energy norm / error against the richer solution, where both refer to the same
  /// solution and exceed rounding.
  [[nodiscard]] std::optional<double> energy_effectivity() const;
  /// The quantities of an iterate.
  [[nodiscard]] std::vector<VerifiedQuantity> quantities(const VerifiedIterate& iterate) const;
};

/// What is wrong, in this order: an effectivity is below 1 although the identities hold (naming the iterate);
/// the richer solution is farther away in the energy norm than the bound allows; the interval of a quantity
/// does not intersect that of the richer solution; identities do not hold for the last iterate of a load
/// step, which `tribound run` would not certify. Empty when the guarantee holds.
[[nodiscard]] std::string violation(const Verification& verification);

/// The table of the iterates, the errors and where the file is.
[[nodiscard]] std::string verification_text(const Verification& verification, const std::string& directory);

/// The same as JSON with the fields of docs/output.md; unknown numbers are null.
[[nodiscard]] std::string verification_json(const Verification& verification);

}  // namespace tribound::app
