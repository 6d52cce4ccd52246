#pragma once

/// @file admissible_traction.h
/// Contact tractions that obey the law everywhere on a facet: those nearest to T(u).

#include <memory>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/certify/energy/obstacle_facets.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// t_h = sum_j t_j B_j on every facet of ObstacleFacets, of the degree of the space, where N varies M times
/// that, with
///     t_j^n <= 0,   |t_j^t| <= s_j,   s_h = sum_j s_j B_j >= 0,
/// so that t_h^n <= 0 and |t_h^t| <= s_h at every point. s_h interpolates the threshold of Tresca's law, with
/// negative s_j set to 0; for Coulomb's law it is -mu_F t_h^n, without friction 0.
template <int dim>
struct AdmissibleTraction
{
  std::vector<double> thresholds;        ///< s_j, facet by facet, in the order of ObstacleFacets
  std::vector<Point<dim>> coefficients;  ///< t_j
  std::vector<Point<dim>> at_points;     ///< t_h at the contact points of the form
  double threshold_remainder = 0;        ///< largest |s - s_h| at the contact points of this rank
};

/// The nearest to t, given at the contact points of the form, in L2 on each facet.
template <int dim>
[[nodiscard]] AdmissibleTraction<dim> admissible_traction(const contact::NitscheForm<dim>& form,
                                                          std::span<const Point<dim>> t);

/// An upper bound of what is missing in complementarity and slip on facet k:
///     G_F = int_F (t_h^n (v^n - g_h) + s_h |v^t - w| + t_h^t . (v^t - w)) >= 0   for v admissible for g_h,
/// w the slip before this load step; with the weight r on a meridian. Keeps references.
template <int dim>
class ContactGap
{
 public:
  ContactGap(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets);
  ~ContactGap();
  ContactGap(const ContactGap&) = delete;
  ContactGap& operator=(const ContactGap&) = delete;

  [[nodiscard]] double operator()(std::size_t k, const AdmissibleTraction<dim>& t,
                                  std::span<const double> v) const;

 private:
  struct Tables;

  const contact::NitscheForm<dim>& form_;
  const ObstacleFacets<dim>& facets_;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace tribound::certify
