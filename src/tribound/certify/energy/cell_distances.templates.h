#pragma once

/// @file cell_distances.templates.h
/// The definition of cell_distances.h, only for the kernels (certify/energy/kernel.cpp.in).

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tribound/base/norm.h"
#include "tribound/base/parallel.h"
#include "tribound/certify/energy/admissible_stress.h"
#include "tribound/certify/energy/cell_distances.h"
#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/initial_moments.h"
#include "tribound/certify/equilibrate/repeated_shapes.h"

namespace tribound::certify
{

template <int dim, int q>
CellDistances cell_distances(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                             std::span<const double> u, std::span<const double> v, const CellDistances& known,
                             std::span<const double> known_v)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  const auto n_cells = static_cast<std::size_t>(mesh.n_owned_cells());
  CellDistances result = known;
  result.square.resize(n_cells);
  result.to_discrete.resize(n_cells);
  result.correction.resize(n_cells);
  std::vector<double> c(u.begin(), u.end());
  for (std::size_t i = 0; i < c.size(); ++i) c[i] -= v[i];
  const auto is_known = [&](Index cell)
  {
    return !known_v.empty() &&
           std::ranges::all_of(
               space.cell_nodes(cell), [&](Index node)
               { return std::ranges::equal(v.subspan(dim * node, dim), known_v.subspan(dim * node, dim)); });
  };
  const InitialMoments<dim, q> initial(form);
  std::vector<Index> order(n_cells);  // cells of a shape, which share factors, one after the other
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(
      order, {}, [shapes = classify_shapes(mesh, true).number](Index cell) { return shapes[cell]; });
  const int n_threads = max_threads();
  std::vector<double> unbalanced(n_threads, 0.0);
  const auto on_thread = [&](int thread)
  {
    AdmissibleStressSolver<dim, q> solver;
    for (std::size_t k = n_cells * thread / n_threads; k < n_cells * (thread + 1) / n_threads; ++k)
    {
      const Index cell = order[k];
      if (is_known(cell)) continue;
      const SortedCell<dim> sorted = make_sorted_cell(mesh, cell);
      const problem::Material& material = form.problem().material(mesh.region(cell));
      const auto elastic = [&](std::span<const double> w)
      { return discrete_stress<dim, q>(sorted, material, space.cell_nodes(cell), w); };
      const std::span<const double> sigma_h = stress.dis_in(cell);
      const AdmissibleStress<dim, q> tau =
          solver.solve(sorted, material, sigma_h, initial.total(cell, sorted, elastic(v)));
      const double size = norm(sigma_h);
      if (size > 0) unbalanced[thread] = std::max(unbalanced[thread], tau.unbalanced / size);
      const PiecewiseStress<dim, q> of_c = on_pieces<dim, q>(elastic(c));
      result.square[cell] = tau.square;
      result.correction[cell] = compliance_product(material, of_c, of_c);
      PiecewiseStress<dim, q> from_mean;  // (tau + sigma(v))/2 - sigma(u) = (tau - sigma(v))/2 - C eps(c)
      add_multiple(from_mean, 0.5, tau.difference);
      add_multiple(from_mean, -1, of_c);
      result.to_discrete[cell] = compliance_product(material, from_mean, from_mean);
    }
  };
  in_threads(n_threads, on_thread);
  result.unbalanced = std::max(known.unbalanced, std::ranges::max(unbalanced));
  return result;
}

}  // namespace tribound::certify
