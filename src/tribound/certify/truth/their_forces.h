#pragma once

/// @file their_forces.h
/// What the stress of another program does at boundaries.

#include <cstddef>
#include <span>
#include <vector>

#include "tribound/fem/space.h"

namespace tribound::certify
{

/// Where their stress pulls at a contact, which cannot be.
struct Tension
{
  double largest = 0;
  std::size_t n_facets = 0;
};

/// At points of the given boundary facets of the mesh, whose numbers ascend.
template <int dim>
[[nodiscard]] Tension tension(const fem::LagrangeSpace<dim>& their_space, std::span<const Tensor<dim>> stress,
                              std::span<const std::size_t> facets);

/// Per boundary of the mesh: the integral of s n, the force on the body there that their stress stands for.
/// Of an axisymmetric body that on the full circle, where only axial forces do not cancel.
template <int dim>
[[nodiscard]] std::vector<Point<dim>> boundary_forces(const fem::LagrangeSpace<dim>& their_space,
                                                      std::span<const Tensor<dim>> stress,
                                                      bool is_axisymmetric = false);

}  // namespace tribound::certify
