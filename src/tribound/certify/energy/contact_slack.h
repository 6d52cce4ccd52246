#pragma once

/// @file contact_slack.h
/// What is allowed of dual pairs on the contact boundary where the state of contact is nearly known.

#include <span>
#include <vector>

#include "tribound/certify/energy/linear_bound.h"

namespace tribound::certify
{

/// Limits of |y^n|, |y^t|, |r^n| and |r^t| for one coefficient of a facet in Bernstein's basis, to be
/// multiplied by m; infinite: no limit.
struct Slack
{
  double normal_y = 0;
  double tangential_y = 0;
  double normal_r = 0;
  double tangential_r = 0;
};

/// For every facet, with m the factor of linear_bound():
///     closed, v^n = g_h:   |r^n| <= m (-t^n);       open, t^n = 0:            |y^n| <= m (g_h - v^n);
///     stick, v^t = w:      |r^t| <= m (s - |t^t|);  slip, t^t = -s (v^t - w)/|v^t - w|: |y^t| <= m |v^t - w|
///     (2D: v^t - w of one sign), w the slip before this load step; without friction y^t is free, between
///     tied bodies r;
/// everything else is 0, also between meshes that do not match; between bodies [v] takes the place of v. The
/// limits for coefficients hold at every point, since both sides are in the same nonnegative basis.
template <int dim>
class ContactSlack
{
 public:
  explicit ContactSlack(const BoundedState<dim>& state);

  [[nodiscard]] const Slack& at(std::size_t k, std::size_t j) const { return slack_[k * n_ + j]; }
  /// Whether facet k is closed and not also open: r^n may be nonzero there.
  [[nodiscard]] bool is_pressed(std::size_t k) const { return is_pressed_[k] != 0; }
  /// Whether facet k has friction and sticks: r^t may be nonzero there.
  [[nodiscard]] bool is_held(std::size_t k) const { return is_held_[k] != 0; }

  /// Cuts the coefficients of r on facet k to the limits.
  void limit_r(std::size_t k, double m, std::span<Point<dim>> r) const;
  /// The same for y, by nodes of the slaves, which facets share. y is 0 where facets with different normals
  /// or three bodies meet, and where a component is fixed. All ranks together.
  void limit_y(double m, std::span<double> y) const;

 private:
  void set_tied(std::size_t k);
  void set_slider(std::size_t k);
  void set_normal(std::size_t k);
  void set_tangential(std::size_t k);

  const BoundedState<dim>& state_;
  std::size_t n_;  ///< coefficients of a facet
  double length_;  ///< rounding of displacements
  double stress_;  ///< of tractions
  std::vector<Slack> slack_;
  std::vector<char> is_pressed_;
  std::vector<char> is_held_;
};

}  // namespace tribound::certify
