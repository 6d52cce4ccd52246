#pragma once

/// @file dual_products.h
/// The effect of the error on a number of the solution, cell by cell, from displacements and stresses that
/// are dual to it.

#include <optional>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// A displacement z and a stress zeta.
template <int dim>
struct DualPair
{
  std::vector<double> z;  ///< degrees of freedom of the form's space
  /// zeta is the admissible stress nearest to sigma(target) with the divergence and the tractions of this
  /// stress; absent: 0.
  std::optional<Stress<dim>> stress{};
  std::vector<double> target{};
  const contact::NitscheForm<dim>* form = nullptr;  ///< whose loads zeta carries; for axisymmetric problems
  double oscillation = 0;  ///< ||O|| of the loads and springs that zeta does not carry, over all ranks
};

/// Per own cell; tau is the admissible stress nearest to sigma(v), products are those of C^{-1}.
struct DualProducts
{
  std::vector<double> centre;  ///< 1/2 (zeta + sigma(z), tau - sigma(v))
  std::vector<double> square;  ///< ||zeta - sigma(z)||^2
  std::vector<double> work;    ///< (tau, sigma(z))
  std::vector<double> energy;  ///< ||sigma(z)||^2
  /// How far 4 centre, square, 2 work and ||tau - sigma(v)||^2 may be off together, because of integrals over
  /// 1/r. Empty unless the problem is axisymmetric.
  std::vector<double> doubt{};
  double unbalanced = 0;  ///< largest part of the dual stress not balanced by a cell, of its norm there
};

/// `stress` and v as for cell_distances(); stresses have the form's degree.
template <int dim, int q>
[[nodiscard]] DualProducts dual_products(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                                         std::span<const double> v, const DualPair<dim>& pair);

}  // namespace tribound::certify
