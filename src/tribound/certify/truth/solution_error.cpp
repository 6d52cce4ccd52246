#include "tribound/certify/truth/solution_error.h"

#include <algorithm>
#include <cmath>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/nested.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/overlay.h"

namespace tribound::certify
{

namespace
{

/// The gradient of a function of a space at the points of a rule on cells inside those of its mesh.
template <int dim>
class CellGradients
{
 public:
  CellGradients(const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                const fem::Quadrature<dim>& rule)
      : space_(&space), u_(u), on_cell_(space.basis().tabulate(rule.points)), values_(rule.size())
  {
  }

  /// The values in the cell with the map `map`, at the `points` of the rule on the cell with the map
  /// `inside`, which is part of it. Valid until the next call.
  std::span<const Tensor<dim>> at(Index cell, const mesh::CellMap<dim>& map, const mesh::CellMap<dim>& inside,
                                  std::span<const Point<dim>> points)
  {
    if (map.origin == inside.origin && map.jacobian == inside.jacobian) return evaluate(cell, map, on_cell_);
    in_cell_.clear();
    for (const Point<dim>& x : points) in_cell_.push_back(fem::reference_point(map, x));
    return evaluate(cell, map, space_->basis().tabulate(in_cell_));
  }

 private:
  std::span<const Tensor<dim>> evaluate(Index cell, const mesh::CellMap<dim>& map,
                                        const fem::Tabulation<dim>& table)
  {
    for (int q = 0; q < table.n_points; ++q)
      values_[q] =
          fem::gradient_at<dim>(space_->cell_nodes(cell), u_, table.gradients_at(q), map.inverse_transpose);
    return values_;
  }

  const fem::LagrangeSpace<dim>* space_;
  std::span<const double> u_;
  fem::Tabulation<dim> on_cell_;
  std::vector<Point<dim>> in_cell_;
  std::vector<Tensor<dim>> values_;
};

/// Replaces squares by their roots and returns the root of their sum.
double take_roots(std::vector<double>& squares)
{
  double sum = 0;
  for (double& x : squares)
  {
    sum += x;
    x = std::sqrt(x);
  }
  return std::sqrt(sum);
}

}  // namespace

template <int dim>
LocalError solution_error(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                          std::span<const double> u, const fem::LagrangeSpace<dim>& reference_space,
                          std::span<const double> u_ref)
{
  const fem::Quadrature<dim> rule =
      fem::quadrature<dim>(2 * std::max(space.degree(), reference_space.degree()) - 2);
  CellGradients<dim> gradients(space, u, rule);
  CellGradients<dim> reference_gradients(reference_space, u_ref, rule);
  LocalError error;
  error.energy.resize(space.mesh().n_cells(), 0.0);
  error.stress.resize(space.mesh().n_cells(), 0.0);
  std::vector<Point<dim>> points(rule.size());
  for (const auto& [cell, reference_cell] : mesh::overlay(space.mesh(), reference_space.mesh()))
  {
    const mesh::CellMap<dim> own = mesh::cell_map(space.mesh(), cell);
    const mesh::CellMap<dim> reference = mesh::cell_map(reference_space.mesh(), reference_cell);
    const mesh::CellMap<dim>& smaller = own.det < reference.det ? own : reference;
    std::ranges::transform(rule.points, points.begin(), smaller);
    const std::span<const Tensor<dim>> values = gradients.at(cell, own, smaller, points);
    const std::span<const Tensor<dim>> expected =
        reference_gradients.at(reference_cell, reference, smaller, points);
    const problem::Material& material = problem.material(space.mesh().region(cell));
    for (int q = 0; q < rule.size(); ++q)
    {
      const Tensor<dim> difference = values[q] - expected[q];
      const Tensor<dim> stress = contact::sigma<dim>(material, difference);
      error.energy[cell] += rule.weights[q] * smaller.det * stress.cwiseProduct(difference).sum();
      error.stress[cell] += rule.weights[q] * smaller.det * stress.squaredNorm();
    }
  }
  error.global.energy = take_roots(error.energy);
  error.global.stress = take_roots(error.stress);
  return error;
}

template LocalError solution_error(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                   std::span<const double>, const fem::LagrangeSpace<2>&,
                                   std::span<const double>);
template LocalError solution_error(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                   std::span<const double>, const fem::LagrangeSpace<3>&,
                                   std::span<const double>);

}  // namespace tribound::certify
