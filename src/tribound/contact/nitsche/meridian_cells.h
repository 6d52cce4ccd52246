#pragma once

/// @file meridian_cells.h
/// Linear elasticity of bodies of revolution on the cells of their meridian (r, z):
///     a(u, v) = int r (sigma(u) : grad v + sigma_tt(u) v_r / r),
/// sigma = lambda (tr grad u + u_r / r) I + 2 mu eps, sigma_tt = lambda (tr grad u + u_r / r) + 2 mu u_r / r.

#include <memory>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/meridian_rules.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

template <int dim>
class InitialStress;

/// Keeps references to problem and space.
class MeridianCells
{
 public:
  MeridianCells(const problem::Problem<2>& problem, const fem::LagrangeSpace<2>& space);

  /// The blocks a(phi_j e_b, phi_i e_a) of node i of a cell with all its nodes j.
  [[nodiscard]] std::vector<Tensor<2>> stiffness_row(Index cell, int i) const;
  /// vector_i += a(u, phi_i) on a cell.
  void add_forces(Index cell, std::span<const double> u, std::span<double> vector) const;

  /// vector_i -= the integral over a cell of r sigma_0 : grad phi_i and of sigma_{0,tt} phi_{i,r}.
  void add_initial_forces(Index cell, const InitialStress<2>& initial, std::span<double> vector) const;

  /// Integrals over a cell with the weight r.
  struct Squares
  {
    double energy = 0;  ///< a(u, u)
    double sigma = 0;   ///< ||sigma(u)||^2 + ||sigma_tt(u)||^2, sigma(u) = C eps(u) + sigma_0
    /// Of (2 mu + 3 lambda) sum_i |u_i| (|grad phi_i| + |phi_i| / r) + |sigma_0|: what cancels in sigma(u)
    double terms = 0;
  };
  /// `initial`: null without sigma_0.
  [[nodiscard]] Squares squares(Index cell, std::span<const double> u,
                                const InitialStress<2>* initial = nullptr) const;

 private:
  /// The entries of sigma_0 in the plane, and that around the axis.
  struct Stress
  {
    Tensor<2> plane = Tensor<2>::Zero();
    double hoop = 0;
  };
  /// At the points of the rule of a cell.
  [[nodiscard]] std::vector<Stress> at_points(const InitialStress<2>* initial, Index cell) const;
  /// visit(r, weight, values, gradients): of the basis functions at the points of the rule, in space; the
  /// weight contains r.
  template <class Visit>
  void for_each_point(Index cell, const Visit& visit) const;
  [[nodiscard]] const problem::Material& material(Index cell) const
  {
    return problem_.material(space_.mesh().region(cell));
  }

  const problem::Problem<2>& problem_;
  const fem::LagrangeSpace<2>& space_;
  fem::MeridianRules rules_;
  std::vector<fem::Tabulation<2>> tables_;  ///< at the points of each rule
};

/// Those of an axisymmetric problem, otherwise none.
template <int dim>
[[nodiscard]] std::shared_ptr<const MeridianCells> meridian_cells(const problem::Problem<dim>& problem,
                                                                  const fem::LagrangeSpace<dim>& space)
{
  if constexpr (dim == 2)
    if (problem.is_axisymmetric()) return std::make_shared<const MeridianCells>(problem, space);
  return nullptr;
}

}  // namespace tribound::contact
