#pragma once

/// @file balance.h
/// The loads on the body and the forces that hold it, from the equilibrated stress: these balance up to
/// rounding for every Newton iterate, those of sigma(u_h) do not.

#include <optional>
#include <string>
#include <vector>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

enum class BalanceKind
{
  load,      ///< integral of f over a region, or of g_N over a boundary
  reaction,  ///< integral of sigma_h n over a boundary, in the components that are fixed there
  contact,   ///< integral of sigma_h n, the traction t^k, over a boundary in contact, slave or master
  sum        ///< of all rows
};

/// "load", "reaction", "contact", "sum".
[[nodiscard]] std::string to_string(BalanceKind kind);

/// A force on the body (per unit of depth in 2D).
struct BalanceRow
{
  BalanceKind kind = BalanceKind::load;
  std::string name;    ///< of the region or the boundary; empty for the sum
  std::string source;  ///< such as "body force", "traction", "pressure"
  std::vector<double> force;
  /// integral of (x - about) x t; one number in 2D. Absent if unknown: for p = 1 sigma_h is symmetric only up
  /// to the error, so its reactions balance the moments only up to the error.
  std::optional<std::vector<double>> moment;
};

struct Balance
{
  std::vector<double> about;  ///< the point of the moments
  std::vector<BalanceRow> rows;
};

/// Why moments are missing; empty if all are known.
[[nodiscard]] std::string moment_note(const Balance& balance);

/// The centroid of the body.
template <int dim>
[[nodiscard]] Point<dim> centroid(const mesh::Mesh<dim>& mesh);

/// Loads, reactions, contact forces and their sum, which vanishes up to rounding and the accuracy of the
/// linear solver. Rows come in the order of BalanceKind, then of regions and boundaries; a region or boundary
/// without force has no row.
template <int dim>
[[nodiscard]] Balance balance(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                              const Point<dim>& about);

}  // namespace tribound::certify
