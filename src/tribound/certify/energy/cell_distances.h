#pragma once

/// @file cell_distances.h
/// The distance of statically admissible stresses from those of displacements, cell by cell.

#include <span>
#include <vector>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Per own cell, with tau the admissible stress nearest to sigma(v) (certify/energy/admissible_stress.h) and
/// c = u - v.
struct CellDistances
{
  std::vector<double> square;       ///< ||tau - sigma(v)||^2 in the norm of C^{-1}
  std::vector<double> to_discrete;  ///< ||(tau + sigma(v))/2 - sigma(u)||^2
  std::vector<double> correction;   ///< ||c||_en^2
  double unbalanced = 0;  ///< largest part of sigma_h that a cell cannot balance, relative to its norm there
};

/// For the stress of `dis` and functions u, v of the form's space; `stress` is in equilibrium on every cell.
/// `known`: those of another v, which are kept on cells where both are the same; empty with an empty
/// `known_v`.
template <int dim, int q>
[[nodiscard]] CellDistances cell_distances(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                                           std::span<const double> u, std::span<const double> v,
                                           const CellDistances& known, std::span<const double> known_v);

}  // namespace tribound::certify
