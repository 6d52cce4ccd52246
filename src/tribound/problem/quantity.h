#pragma once

/// @file quantity.h
/// Quantities of interest of a solution: energies and forces (of the full circle), displacements.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/problem/problem.h"

namespace tribound::problem
{

enum class QuantityKind
{
  energy,             ///< a(u, u), twice the elastic energy
  load_work,          ///< L(u) = (f, u) + (g_N, u)_N
  contact_force,      ///< integral of sigma(u) n . e over contact boundaries, which acts on the body
  contact_moment,     ///< moment of sigma(u) n about a point, in 3D about an axis e through it
  safety_factor,      ///< mu_F N / H of a plane boundary with Coulomb's friction, without any bond: H =
                      ///< |integral of sigma^t|, N = -(integral of sigma^n + p_w), p_w of water in the joint
  mean_displacement,  ///< mean of u . e over a boundary
  spring_force        ///< integral of -K (u - u_0) . e over a boundary, which acts on the body
};

/// "energy", "load_work", ..., as in case files.
[[nodiscard]] constexpr std::string_view to_string(QuantityKind kind)
{
  switch (kind)
  {
    case QuantityKind::energy:
      return "energy";
    case QuantityKind::load_work:
      return "load_work";
    case QuantityKind::contact_force:
      return "contact_force";
    case QuantityKind::contact_moment:
      return "contact_moment";
    case QuantityKind::safety_factor:
      return "safety_factor";
    case QuantityKind::mean_displacement:
      return "mean_displacement";
    case QuantityKind::spring_force:
      return "spring_force";
  }
  return {};
}

template <int dim>
struct Quantity
{
  std::string name;
  QuantityKind kind = QuantityKind::energy;
  /// Of the mesh; empty: all contact boundaries (forces and moments).
  std::string boundary;
  /// e, of any length but 0; absent: the mean outward normal of the boundary.
  std::optional<Point<dim>> direction;
  std::optional<Point<dim>> point;  ///< of moments; absent: the origin
  /// Where displacements are fixed or another contact boundary begins, forces and moments cannot be taken
  /// alone: they are weighted by min(1, d / ramp), d the distance from there. 0: a tenth of the diagonal of
  /// the box around the boundary.
  double ramp = 0;
  Where where;  ///< for messages
};

/// The number of its boundary; -1 if it refers to all contact boundaries or to the whole. Throws InputError
/// if there is no such boundary, no contact for a force or moment, no spring for its force, no friction
/// coefficient for a safety factor, or for moments on bodies of revolution.
template <int dim>
[[nodiscard]] int boundary_number(const Quantity<dim>& quantity, const Problem<dim>& problem,
                                  std::span<const std::string> boundary_names);

}  // namespace tribound::problem
