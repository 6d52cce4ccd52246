#pragma once

/// @file mesh_equilibrator.h
/// The implementations of Equilibrator: one for each dimension and degree, with sizes known at compile time.

#include <memory>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/equilibrate.h"

namespace tribound::certify
{

/// What the objects of all degrees have in common.
template <int dim>
class Equilibrator<dim>::Implementation
{
 public:
  virtual ~Implementation() = default;
  /// The stress of u, its parts with these tractions; without sigma_dis unless `with_dis`. `turning`: as
  /// Equilibrator::balanced() has it.
  virtual Stress<dim> run(std::span<const double> u, typename Stress<dim>::Tractions tractions, bool with_dis,
                          std::span<const Tensor<dim>> turning) = 0;
};

/// An Equilibrator of degree p; arguments are those of its constructor, the metrics those of the regions for
/// patches in the Arnold-Falk-Winther spaces (empty: L2 everywhere, as it is row by row). Compiled for each
/// dimension and degree by certify/equilibrate/kernel.cpp.in.
template <int dim, int p>
[[nodiscard]] std::unique_ptr<typename Equilibrator<dim>::Implementation> make_mesh_equilibrator(
    const contact::NitscheForm<dim>& form, int n_threads, bool by_rows, std::vector<StressMetric> metrics);

}  // namespace tribound::certify
