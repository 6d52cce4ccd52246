#pragma once

/// @file cell_products.h
/// The part of the dual norm's operator on cells.

#include <optional>
#include <span>
#include <vector>

#include "tribound/fem/meridian_rules.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// (grad phi_j, grad phi_i)_T of the basis functions of a cell; of an axisymmetric problem with the weight r,
/// and with (phi_j / r, phi_i / r)_T for the component u_r. Keeps a reference to the space.
template <int dim>
class CellProducts
{
 public:
  CellProducts(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space);

  /// block[i * n + j] for the given component. Basis functions that do not vanish on the axis have no product
  /// as u_r; what stands there is finite.
  void operator()(Index cell, int component, std::span<double> block) const;

 private:
  void on_meridian(Index cell, bool is_radial, std::span<double> block) const;

  const fem::LagrangeSpace<dim>& space_;
  std::vector<Tensor<dim>> reference_;
  std::optional<fem::MeridianRules> rules_;   ///< of an axisymmetric problem
  std::vector<fem::Tabulation<dim>> tables_;  ///< at the points of each rule
};

}  // namespace tribound::certify
