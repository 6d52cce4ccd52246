#pragma once

/// @file balance.h
/// The loads on the body and the forces that hold it, from the discrete problem tested with rigid motions,
/// which are in its space: these balance up to rounding for every Newton iterate, those of sigma(u_h) do not.

#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

enum class BalanceKind
{
  load,      ///< integral of f over a region, or of g_N over a boundary
  reaction,  ///< a(u, phi) - L(phi) - (t, [phi])_C summed over the nodes of a boundary, in the components it
             ///< fixes
  spring,    ///< integral of -K (u - u_0) over a boundary
  contact,   ///< integral of the traction t^k over a boundary in contact, slave or master
  sum        ///< of all rows
};

/// "load", "reaction", "spring", "contact", "sum".
[[nodiscard]] std::string to_string(BalanceKind kind);

/// A force on the body, in 2D per unit of depth, or of an axisymmetric body on the full circle.
struct BalanceRow
{
  BalanceKind kind = BalanceKind::load;
  std::string name;    ///< of the region or the boundary; empty for the sum
  std::string source;  ///< such as "body force", "traction", "pressure"
  std::vector<double> force;
  std::vector<double> moment;  ///< of (x - about) x force; one number in 2D
};

struct Balance
{
  std::vector<double> about;  ///< the point of the moments
  std::vector<BalanceRow> rows;
};

/// The centroid of the body.
template <int dim>
[[nodiscard]] Point<dim> centroid(const mesh::Mesh<dim>& mesh);

/// Loads, reactions, contact forces and their sum, which vanishes up to rounding and the accuracy of the
/// linear solver, of an iterate u with the running traction t. Rows come in the order of BalanceKind, then of
/// regions and boundaries; a region or boundary without force has no row.
template <int dim>
[[nodiscard]] Balance balance(const contact::NitscheForm<dim>& form, std::span<const double> u,
                              std::span<const Point<dim>> t, const Point<dim>& about);

}  // namespace tribound::certify
