#pragma once

/// @file mesh_equilibrator.h
/// The implementations of Equilibrator: one for each dimension and degree, with sizes known at compile time.

#include <memory>
#include <span>

#include "tribound/certify/equilibrate/equilibrate.h"

namespace tribound::certify
{

/// What the objects of all degrees have in common.
template <int dim>
class Equilibrator<dim>::Implementation
{
 public:
  virtual ~Implementation() = default;
  /// The stress for the arguments of Equilibrator's members; without sigma_dis unless `with_dis`.
  virtual Stress<dim> run(std::span<const double> u, std::span<const Point<dim>> t, double delta,
                          bool with_dis) = 0;
};

/// An Equilibrator of degree p; arguments are those of its constructor. Compiled for each dimension and
/// degree by certify/equilibrate/kernel.cpp.in.
template <int dim, int p>
[[nodiscard]] std::unique_ptr<typename Equilibrator<dim>::Implementation> make_mesh_equilibrator(
    const contact::NitscheForm<dim>& form, int n_threads);

}  // namespace tribound::certify
