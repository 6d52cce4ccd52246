#pragma once

/// @file path_facts.h
/// What is known of a load path before it is followed.

#include <optional>
#include <span>
#include <string>

#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::doctor
{

/// A load factor at which contact cannot balance the loads, whatever the pressures are.
struct LoadBeyondContact
{
  double t = 0;
  std::string why;  ///< in the words of contact::check_rigid_motions()
};

/// The first of the load factors at which this happens. Nothing where there is none, or a bond may carry what
/// contact cannot. Needs the whole mesh.
template <int dim>
[[nodiscard]] std::optional<LoadBeyondContact> load_beyond_contact(const problem::Problem<dim>& problem,
                                                                   const fem::LagrangeSpace<dim>& space,
                                                                   std::span<const double> load_factors);

}  // namespace tribound::doctor
