#pragma once

/// @file quantity_bounds.h
/// Intervals of the requested numbers of a solution, method section 14.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tribound/certify/energy/linear_intervals.h"
#include "tribound/certify/energy/quantity_interval.h"

namespace tribound::certify
{

/// The quantities of the solutions on one mesh. All ranks construct and call it together.
template <int dim>
class QuantityBounds
{
 public:
  /// For functions of the form's space; the form must outlive the object. Throws like parts_of().
  QuantityBounds(const contact::NitscheForm<dim>& form, std::span<const problem::Quantity<dim>> quantities);
  ~QuantityBounds();
  QuantityBounds(const QuantityBounds&) = delete;
  QuantityBounds& operator=(const QuantityBounds&) = delete;

  /// Prepares what energy bounds of this form, on the same mesh and of no lower degree, need; keeps a
  /// reference to its systems. `is_held`: whether displacement conditions alone hold every body. Throws
  /// SolveError.
  void prepare(const contact::NitscheForm<dim>& bounded, const ObstacleFacets<dim>& facets,
               ContactSystems<dim>& systems, bool is_held);
  /// The values for u and the intervals that follow from equilibrium alone; `reason` says why there are no
  /// others.
  [[nodiscard]] std::vector<QuantityInterval> from_equilibrium(std::span<const double> u,
                                                               const std::string& reason) const;
  /// Sets the intervals that follow from an energy bound.
  void add_bounded(const BoundedState<dim>& state, std::vector<QuantityInterval>& intervals) const;

 private:
  struct Item;

  /// Whether the quantity is a(u, u), by itself or because the loads do the same work.
  [[nodiscard]] bool is_energy(const Item& item) const;
  [[nodiscard]] double value(const Item& item, std::span<const double> u,
                             std::span<const Point<dim>> t) const;
  [[nodiscard]] QuantityInterval bounded(const Item& item, const LinearNumber<dim>& number,
                                         const BoundedState<dim>& state,
                                         const LinearIntervals<dim>& intervals) const;

  const contact::NitscheForm<dim>& form_;
  std::vector<Item> items_;
  ContactSystems<dim>* systems_ = nullptr;
  std::unique_ptr<DualProblem<dim>> unloaded_;  ///< if there are numbers without loads
  bool is_held_ = false;                        ///< by displacement conditions alone
  bool is_homogeneous_ = false;                 ///< u_D = 0 and g = 0
  bool work_is_energy_ = false;                 ///< L(u) = a(u, u): homogeneous and without friction
};

}  // namespace tribound::certify
