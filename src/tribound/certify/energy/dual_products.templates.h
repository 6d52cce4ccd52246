#pragma once

/// @file dual_products.templates.h
/// The definition of dual_products.h, only for the kernels (certify/energy/kernel.cpp.in).

#include <algorithm>
#include <memory>

#include "tribound/base/norm.h"
#include "tribound/base/parallel.h"
#include "tribound/certify/energy/admissible_stress.h"
#include "tribound/certify/energy/dual_products.h"
#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/initial_moments.h"

namespace tribound::certify
{

namespace detail
{

/// Treats one cell after another; one object per thread.
template <int dim, int q>
class DualCell
{
 public:
  DualCell(const contact::NitscheForm<dim>& form, const Stress<dim>& stress, std::span<const double> v)
      : form_(form), initial_(form), stress_(stress), v_(v)
  {
  }

  void move_to(Index cell)
  {
    cell_ = cell;
    sorted_ = make_sorted_cell(form_.space().mesh(), cell);
    material_ = &form_.problem().material(form_.space().mesh().region(cell));
    const StressCoefficients<dim, q> of_v = initial_.total(cell, sorted_, elastic(v_));
    error_ = solver_.solve(sorted_, *material_, stress_.dis_in(cell), of_v).difference;
    tau_ = on_pieces<dim, q>(of_v);
    add_multiple(tau_, 1, error_);
  }

  /// Sets the products of the cell; returns the unbalanced part of its dual stress.
  [[nodiscard]] double add(const DualPair<dim>& pair, DualProducts& products)
  {
    double unbalanced = 0;
    const PiecewiseStress<dim, q> of_z = on_pieces<dim, q>(elastic(pair.z));
    PiecewiseStress<dim, q> zeta;
    if (pair.stress)
    {
      const std::span<const double> sigma_h = pair.stress->dis_in(cell_);
      const auto nearest = solver_.solve(sorted_, *material_, sigma_h, elastic(pair.target));
      zeta = on_pieces<dim, q>(elastic(pair.target));
      add_multiple(zeta, 1, nearest.difference);
      if (const double size = norm(sigma_h); size > 0) unbalanced = nearest.unbalanced / size;
    }
    products.work[cell_] = compliance_product(*material_, tau_, of_z);
    products.energy[cell_] = compliance_product(*material_, of_z, of_z);
    PiecewiseStress<dim, q> sum = zeta;
    add_multiple(sum, 1, of_z);
    products.centre[cell_] = 0.5 * compliance_product(*material_, sum, error_);
    add_multiple(zeta, -1, of_z);
    products.square[cell_] = compliance_product(*material_, zeta, zeta);
    return unbalanced;
  }

 private:
  /// C eps(w): dual problems have no initial stress.
  [[nodiscard]] auto elastic(std::span<const double> w) const
  {
    return discrete_stress<dim, q>(sorted_, *material_, form_.space().cell_nodes(cell_), w);
  }

  const contact::NitscheForm<dim>& form_;
  InitialMoments<dim, q> initial_;
  const Stress<dim>& stress_;
  std::span<const double> v_;
  AdmissibleStressSolver<dim, q> solver_;
  Index cell_ = 0;
  SortedCell<dim> sorted_{};
  const problem::Material* material_ = nullptr;
  PiecewiseStress<dim, q> error_;  ///< tau - sigma(v), total stresses
  PiecewiseStress<dim, q> tau_;
};

}  // namespace detail

template <int dim, int q>
DualProducts dual_products(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                           std::span<const double> v, const DualPair<dim>& pair)
{
  const auto n_cells = static_cast<std::size_t>(form.space().mesh().n_owned_cells());
  const std::vector<double> none(n_cells, 0.0);
  DualProducts result{none, none, none, none};
  const int n_threads = max_threads();
  std::vector<double> unbalanced(n_threads, 0.0);
  const auto on_thread = [&](int thread)
  {
    const auto cell = std::make_unique<detail::DualCell<dim, q>>(form, stress, v);
    for (std::size_t k = n_cells * thread / n_threads; k < n_cells * (thread + 1) / n_threads; ++k)
    {
      cell->move_to(static_cast<Index>(k));
      unbalanced[thread] = std::max(unbalanced[thread], cell->add(pair, result));
    }
  };
  in_threads(n_threads, on_thread);
  result.unbalanced = *std::ranges::max_element(unbalanced);
  return result;
}

}  // namespace tribound::certify
