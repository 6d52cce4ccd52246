#pragma once

/// @file elasticity.h
/// Linear elasticity: sigma, the bilinear form a(u, v) = (sigma(u), eps(v)) and norms of stresses. Integrals
/// of axisymmetric problems have the weight r and the hoop terms of meridian_cells.h.

#include <memory>
#include <span>
#include <vector>

#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

template <int dim>
class DiscreteData;
template <int dim>
class Springs;
class MeridianCells;

// `meridian` below: meridian_cells() of problem and space; null: made where it is needed.

/// sigma = lambda tr(eps) I + 2 mu eps with eps = sym(grad u).
template <int dim>
[[nodiscard]] Tensor<dim> sigma(const problem::Material& material, const Tensor<dim>& gradient)
{
  Tensor<dim> s = material.mu * (gradient + gradient.transpose());
  s.diagonal().array() += material.lambda * gradient.trace();
  return s;
}

/// The same on a meridian with the hoop strain u_r / r.
template <int dim>
[[nodiscard]] Tensor<dim> sigma(const problem::Material& material, const Tensor<dim>& gradient, double hoop)
{
  Tensor<dim> s = sigma<dim>(material, gradient);
  s.diagonal().array() += material.lambda * hoop;
  return s;
}

/// The stress around the axis.
[[nodiscard]] inline double hoop_stress(const problem::Material& material, const Tensor<2>& gradient,
                                        double hoop)
{
  return material.lambda * (gradient.trace() + hoop) + 2 * material.mu * hoop;
}

/// u_r / r at the radius r; on the axis, where u_r = 0, its limit d_r u_r.
[[nodiscard]] inline double hoop_strain(double r, double u_r, double dr_u_r)
{
  return r > 0 ? u_r / r : dr_u_r;
}

/// a(phi_j, phi_i) over free i and j, and (K phi_j, phi_i)_S if springs are given. The row of a fixed degree
/// of freedom i has only a(phi_i, phi_i) on the diagonal, which decouples it without spoiling the scaling. If
/// its node has free components, the rest of the row is stored as zeros, so that nodes are coupled by whole
/// blocks. On several ranks: the rows of the own nodes.
template <int dim>
[[nodiscard]] algebra::SparseRows stiffness(const problem::Problem<dim>& problem,
                                            const fem::LagrangeSpace<dim>& space,
                                            const fem::Constraints& constraints,
                                            const Springs<dim>* springs = nullptr,
                                            const std::shared_ptr<const MeridianCells>& meridian = nullptr);

/// a(u, phi_i) for every degree of freedom, fixed ones included, cell by cell; incomplete at ghosts.
template <int dim>
[[nodiscard]] std::vector<double> apply_stiffness(
    const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space, std::span<const double> u,
    const std::shared_ptr<const MeridianCells>& meridian = nullptr);

/// The norms of the stress of a displacement u.
struct StressNorms
{
  double energy = 0;  ///< a(u, u), not halved: without the initial stress
  double sigma = 0;   ///< ||sigma(u)||, sigma(u) = C eps(u) + sigma_0
  /// If sigma(u) is only rounding, so that the exact stress is zero as far as can be known: how large
  /// rounding may be, a multiple of the unit round-off times the norm of (2 mu + dim lambda) sum_i |u_i|
  /// |grad phi_i|, whose terms cancel in sigma(u) when u is a rigid motion. Otherwise 0; so under loads,
  /// which need a stress, and if rounding might hide a significant stress: more than 1e-5 of that of a strain
  /// max |u| over the size of the body in the softest material.
  double round_off = 0;
};

/// With Pi^{p+1} sigma_0 for sigma_0, as the form sees it: where sigma_0 is no such polynomial, the norm of
/// sigma(u) is not smaller, so that what is relative to it is not taken for more accurate than it is. `data`:
/// of the problem, for the degree of the space; null: they are made where they are needed.
template <int dim>
[[nodiscard]] StressNorms stress_norms(const problem::Problem<dim>& problem,
                                       const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                                       const DiscreteData<dim>* data = nullptr,
                                       const std::shared_ptr<const MeridianCells>& meridian = nullptr);

/// (sigma(u), grad u)_T of every own cell, not halved.
template <int dim>
[[nodiscard]] std::vector<double> cell_energies(
    const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space, std::span<const double> u,
    const std::shared_ptr<const MeridianCells>& meridian = nullptr);

/// vector_i -= (sigma_0, grad phi_i) for every degree of freedom; incomplete at ghosts.
template <int dim>
void add_initial_stress(const DiscreteData<dim>& data, const fem::LagrangeSpace<dim>& space,
                        std::span<double> vector,
                        const std::shared_ptr<const MeridianCells>& meridian = nullptr);

/// (f, phi_i) + (g_N, phi_i)_N for every degree of freedom, fixed ones included;
/// incomplete at ghosts. The data are those for the degree of the space.
template <int dim>
[[nodiscard]] std::vector<double> assemble_load(const DiscreteData<dim>& data,
                                                const fem::LagrangeSpace<dim>& space);

}  // namespace tribound::contact
