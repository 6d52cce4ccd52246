#pragma once

/// @file second_order.h
/// Dual pairs that follow the state of contact: intervals whose width is of the order of the energy, not of
/// its root.

#include <memory>
#include <optional>
#include <string>

#include "tribound/certify/energy/contact_slack.h"
#include "tribound/certify/energy/linear_number.h"

namespace tribound::certify
{

/// Intervals of linear numbers from one energy bound. All ranks construct and call it together.
template <int dim>
class SecondOrder
{
 public:
  /// Keeps references.
  SecondOrder(const BoundedState<dim>& state, DualSystems<dim>& systems,
              const algebra::SolverOptions& solver);

  /// The bound that has the smallest radius for some m, given that with m = 0; nothing where it is not
  /// smaller.
  [[nodiscard]] std::optional<LinearBound> operator()(const LinearNumber<dim>& number, double base,
                                                      const LinearBound& first) const;

 private:
  /// z with z + phi held where contact holds, by stiff springs, and free elsewhere.
  struct Natural
  {
    std::vector<double> y;      ///< z + phi on Gamma_C, coefficients in Bernstein's basis by node
    std::vector<Point<dim>> r;  ///< what the springs exert, coefficients facet by facet
  };
  [[nodiscard]] Natural natural(const LinearNumber<dim>& number) const;
  [[nodiscard]] DualPair<dim> pair(const LinearNumber<dim>& number, Natural natural, double m,
                                   std::string& reason) const;
  /// The springs of facet k.
  [[nodiscard]] Tensor<dim> holding(std::size_t k) const;
  [[nodiscard]] algebra::Triplets springs() const;
  [[nodiscard]] std::vector<Point<dim>> exerted(std::span<const double> displacement) const;
  [[nodiscard]] std::vector<Point<dim>> at_points(std::span<const Point<dim>> coefficients) const;

  const BoundedState<dim>& state_;
  DualSystems<dim>& systems_;
  ContactSlack<dim> slack_;
  fem::LagrangeBasis<dim - 1> basis_;
  double stiffness_;  ///< of the springs
  std::unique_ptr<ElasticSystem<dim>> held_;
};

}  // namespace tribound::certify
