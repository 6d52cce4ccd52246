#pragma once

/// @file quantities.h
/// Quantities for tests, and checks of their intervals.

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "tribound/certify/energy/energy_bound.h"

namespace tribound::test
{

using certify::EnergyBound;
using certify::EnergyEstimator;
using certify::QuantityInterval;
using problem::Quantity;
using problem::QuantityKind;

template <int dim>
using Quantities = std::vector<Quantity<dim>>;

template <int dim>
Quantity<dim> contact_force(const std::string& boundary, const Point<dim>& direction, double ramp = 0)
{
  return {.name = boundary,
          .kind = QuantityKind::contact_force,
          .boundary = boundary,
          .direction = direction,
          .ramp = ramp};
}

template <int dim>
Quantity<dim> mean_displacement(const std::string& boundary, const Point<dim>& direction)
{
  return {.name = "u " + boundary,
          .kind = QuantityKind::mean_displacement,
          .boundary = boundary,
          .direction = direction};
}

template <int dim>
std::vector<QuantityInterval> intervals(const DiscreteProblem<dim>& c, const Quantities<dim>& quantities,
                                        std::span<const double> u)
{
  return EnergyEstimator<dim>(c.form, c.method.solver, quantities)(u).quantities;
}

/// `accuracy`: of the truth.
inline void expect_contains(const QuantityInterval& interval, double truth, const std::string& what = {},
                            double accuracy = 0)
{
  EXPECT_EQ(interval.reason, "") << interval.name << what << interval.note;
  EXPECT_LE(interval.lower, truth + accuracy) << interval.name << what;
  EXPECT_GE(interval.upper, truth - accuracy) << interval.name << what;
}

}  // namespace tribound::test
