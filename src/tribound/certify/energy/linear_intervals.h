#pragma once

/// @file linear_intervals.h
/// Intervals of linear numbers from dual pairs that follow the state of contact. Where that is nearly known,
/// their width is of the order of the energy, not of its root.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/certify/energy/contact_slack.h"
#include "tribound/certify/energy/contact_systems.h"
#include "tribound/certify/energy/linear_number.h"

namespace tribound::certify
{

/// The number is in [lower, upper], up to rounding.
struct LinearInterval
{
  std::string reason{};  ///< why there is none
  double lower = 0;
  double upper = 0;
  double rounding = 0;
  bool is_second_order = false;  ///< m > 0
  std::vector<double> cells{};   ///< the shares of own cells in half the width
};

/// For numbers from one energy bound. All ranks construct and call it together.
template <int dim>
class LinearIntervals
{
 public:
  /// Keeps references. `is_held`: displacement conditions alone hold every body. If not, there are no
  /// intervals of numbers with loads; for others m = 0 and zeta = 0.
  /// `unloaded`: for numbers without loads, null if there are none.
  LinearIntervals(const BoundedState<dim>& state, ContactSystems<dim>& systems,
                  const DualProblem<dim>* unloaded, bool is_held);

  /// Uses m = 0, then m > 0 as long as the width decreases. `base`: as for linear_bound().
  [[nodiscard]] LinearInterval operator()(const LinearNumber<dim>& number, double base) const;

 private:
  /// z with [z] + phi held by stiff springs where contact holds, and free elsewhere.
  struct Natural
  {
    std::vector<double> y;         ///< [z] + phi on Gamma_C, coefficients in Bernstein's basis by node
    std::vector<double> opposite;  ///< z at the nodes of masters; 0 where meshes do not match
    std::vector<Point<dim>> r;     ///< tractions of the springs, coefficients facet by facet
  };
  [[nodiscard]] Natural natural(const LinearNumber<dim>& number) const;
  void set_opposite(std::span<const double> z, Natural& natural) const;
  /// The trace of z on Gamma_C.
  [[nodiscard]] std::vector<double> trace(const LinearNumber<dim>& number, const Natural& natural) const;
  /// Whether z vanishes where displacements are fixed and [z] + phi is y, up to rounding.
  [[nodiscard]] bool fits(const LinearNumber<dim>& number, const Natural& natural,
                          std::span<const double> z) const;
  /// What fits the slack for one m.
  struct Limited
  {
    double m = 0;
    Natural natural{};
    std::vector<Point<dim>> t{};   ///< natural.r at the contact points
    std::vector<double> z{};       ///< with the trace of `natural`
    std::vector<double> target{};  ///< z of the dual stress; empty: without loads
  };
  [[nodiscard]] std::vector<Limited> limited(const LinearNumber<dim>& number, const Natural& natural,
                                             std::span<const double> factors) const;
  [[nodiscard]] DualPair<dim> pair(const LinearNumber<dim>& number, Limited limited,
                                   std::string& reason) const;
  [[nodiscard]] LinearBound bound(const LinearNumber<dim>& number, Limited limited, double base,
                                  std::string& reason) const;
  /// The stiffness of the springs of facet k.
  [[nodiscard]] Tensor<dim> holding(std::size_t k) const;
  [[nodiscard]] algebra::Triplets springs() const;
  [[nodiscard]] std::vector<Point<dim>> exerted(std::span<const double> displacement) const;
  [[nodiscard]] std::vector<Point<dim>> at_points(std::span<const Point<dim>> coefficients) const;

  const BoundedState<dim>& state_;
  ContactSystems<dim>& systems_;
  const DualProblem<dim>* unloaded_;
  bool is_held_;
  ContactSlack<dim> slack_;
  fem::LagrangeBasis<dim - 1> basis_;
  double stiffness_ = 0;  ///< of the springs
};

}  // namespace tribound::certify
