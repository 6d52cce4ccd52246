#pragma once

/// @file contact_moments.h
/// Moments of the contact traction on the two sides of Gamma_C.

#include <span>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// arm x force; in 2D its only component, positive from x to y.
[[nodiscard]] Point<1> moment(const Point<2>& arm, const Point<2>& force);
[[nodiscard]] Point<3> moment(const Point<3>& arm, const Point<3>& force);

/// Moments about the origin of a contact traction t given at the contact points, over all ranks.
template <int dim>
struct ContactMoments
{
  using Moment = Point<dim == 2 ? 1 : 3>;

  Moment slave = Moment::Zero();   ///< integral of x x t, acting on the slaves
  Moment master = Moment::Zero();  ///< -integral of Pi(x) x t, acting on the masters; obstacles: none
  double scale = 0;                ///< integral of |x| |t|, to which rounding is proportional
};

/// Over the segments whose slave has boundary number `tag`; over all for tag < 0.
template <int dim>
[[nodiscard]] ContactMoments<dim> contact_moments(const NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                                  int tag = -1);

}  // namespace tribound::contact
