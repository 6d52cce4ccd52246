#pragma once

/// @file linearised.h
/// What a Newton step linearises, and where.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::solve
{

/// T_lin of a Newton step.
template <int dim>
struct Linearised
{
  contact::Linearisation kind = contact::Linearisation::newton;
  std::vector<double> u = {};  ///< where, on the cells at the contact boundary
  double delta = 0;            ///< of T_delta

  [[nodiscard]] std::vector<Point<dim>> traction(const contact::NitscheForm<dim>& form,
                                                 std::span<const double> w) const
  {
    return form.linearised_traction(kind, u, w, delta);
  }
  [[nodiscard]] std::vector<double> tangent(const contact::NitscheForm<dim>& form) const
  {
    return form.contact_tangent_values(kind, u, delta);
  }
};

}  // namespace tribound::solve
