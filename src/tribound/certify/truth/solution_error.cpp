#include "tribound/certify/truth/solution_error.h"

#include <algorithm>
#include <cmath>

#include "tribound/certify/truth/meridian_error.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/nested.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/partition.h"

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

/// Two cells in one place, and the points of a rule on the smaller one.
template <int dim>
struct Overlap
{
  Index cell;
  Index reference_cell;
  const mesh::CellMap<dim>& own;
  const mesh::CellMap<dim>& reference;
  const mesh::CellMap<dim>& smaller;
  std::span<const Point<dim>> points;
};

template <int dim, class Use>
void for_each_overlap(const mesh::Mesh<dim>& mesh, const mesh::Mesh<dim>& reference_mesh,
                      const fem::Quadrature<dim>& rule, const Use& use)
{
  std::vector<Point<dim>> points(rule.size());
  for (const auto& [cell, reference_cell] : cell_pairs(mesh, reference_mesh))
  {
    const mesh::CellMap<dim> own = mesh::cell_map(mesh, cell);
    const mesh::CellMap<dim> reference = mesh::cell_map(reference_mesh, reference_cell);
    const mesh::CellMap<dim>& smaller = own.det < reference.det ? own : reference;
    std::ranges::transform(rule.points, points.begin(), smaller);
    use(Overlap<dim>{cell, reference_cell, own, reference, smaller, points});
  }
}

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

/// Squares in place of roots, of the cells of this rank.
template <int dim>
LocalError squares_of(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                      std::span<const double> u, const fem::LagrangeSpace<dim>& reference_space,
                      std::span<const double> u_ref)
{
  if constexpr (dim == 2)
    if (problem.is_axisymmetric()) return meridian_squares(problem, space, u, reference_space, u_ref);
  const fem::Quadrature<dim> rule =
      fem::quadrature<dim>(2 * std::max(space.degree(), reference_space.degree()) - 2);
  CellGradients<dim> gradients(space, u, rule);
  CellGradients<dim> reference_gradients(reference_space, u_ref, rule);
  LocalError error;
  error.energy.resize(space.mesh().n_cells(), 0.0);
  error.stress.resize(space.mesh().n_cells(), 0.0);
  for_each_overlap<dim>(
      space.mesh(), reference_space.mesh(), rule,
      [&](const Overlap<dim>& at)
      {
        const std::span<const Tensor<dim>> values = gradients.at(at.cell, at.own, at.smaller, at.points);
        const std::span<const Tensor<dim>> expected =
            reference_gradients.at(at.reference_cell, at.reference, at.smaller, at.points);
        const problem::Material& material = problem.material(space.mesh().region(at.cell));
        for (int q = 0; q < rule.size(); ++q)
        {
          const double weight = rule.weights[q] * at.smaller.det;
          const Tensor<dim> difference = values[q] - expected[q];
          const Tensor<dim> stress = contact::sigma<dim>(material, difference);
          error.energy[at.cell] += weight * stress.cwiseProduct(difference).sum();
          error.stress[at.cell] += weight * stress.squaredNorm();
          const Tensor<dim> own = contact::sigma<dim>(material, values[q]);
          error.own_energy += weight * own.cwiseProduct(values[q]).sum();
          error.product += weight * own.cwiseProduct(expected[q]).sum();
          error.reference_energy +=
              weight * contact::sigma<dim>(material, expected[q]).cwiseProduct(expected[q]).sum();
        }
      });
  return error;
}

template <int dim>
StressError stress_squares(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                           std::span<const Tensor<dim>> s, std::span<const double> hoop,
                           const fem::LagrangeSpace<dim>& reference_space, std::span<const double> u_ref)
{
  if constexpr (dim == 2)
    if (problem.is_axisymmetric())
      return meridian_stress_squares(problem, space, s, hoop, reference_space, u_ref);
  const int degree = std::max(space.degree(), reference_space.degree());
  const fem::Quadrature<dim> rule =
      fem::quadrature<dim>(problem.has_initial_stress() ? 2 * degree + 5 : 2 * degree);
  CellGradients<dim> reference_gradients(reference_space, u_ref, rule);
  StressError error{.cells = std::vector<double>(space.mesh().n_cells(), 0.0)};
  const auto n_nodes = static_cast<std::size_t>(space.basis().n_nodes());
  std::vector<Point<dim>> in_cell(rule.size());
  for_each_overlap<dim>(
      space.mesh(), reference_space.mesh(), rule,
      [&](const Overlap<dim>& at)
      {
        const std::span<const Tensor<dim>> expected =
            reference_gradients.at(at.reference_cell, at.reference, at.smaller, at.points);
        std::ranges::transform(at.points, in_cell.begin(),
                               [&](const Point<dim>& x) { return fem::reference_point(at.own, x); });
        const fem::Tabulation<dim> table = space.basis().tabulate(in_cell);
        const int region = space.mesh().region(at.cell);
        const problem::Material& material = problem.material(region);
        const bool is_loaded = problem.regions()[region].has_initial_stress();
        for (int q = 0; q < rule.size(); ++q)
        {
          Tensor<dim> difference = -contact::sigma<dim>(material, expected[q]);
          if (is_loaded) difference -= problem.initial_stress(region, at.points[q]);
          for (std::size_t i = 0; i < n_nodes; ++i)
            difference += table.values_at(q)[i] * s[n_nodes * at.cell + i];
          // C^-1 s = (s - lambda / (2 mu + d lambda) tr s I) / (2 mu)
          const double trace = difference.trace();
          const double share = material.lambda / (2 * material.mu + dim * material.lambda);
          error.cells[at.cell] += rule.weights[q] * at.smaller.det *
                                  (difference.squaredNorm() - share * trace * trace) / (2 * material.mu);
        }
      });
  return error;
}

}  // namespace

template <int dim>
std::vector<mesh::CellPair> cell_pairs(const mesh::Mesh<dim>& mesh, const mesh::Mesh<dim>& reference)
{
  if (!reference.partition()) return mesh::overlay(mesh, reference);
  std::vector<mesh::CellPair> pairs;
  pairs.reserve(reference.n_owned_cells());
  for (Index c = 0; c < reference.n_owned_cells(); ++c)
    pairs.push_back({static_cast<Index>(reference.partition()->names[c].root), c});
  return pairs;
}

template <int dim>
LocalError solution_error(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                          std::span<const double> u, const fem::LagrangeSpace<dim>& reference_space,
                          std::span<const double> u_ref)
{
  LocalError error = squares_of<dim>(problem, space, u, reference_space, u_ref);
  const Ranks& ranks = reference_space.mesh().ranks();
  ranks.sum(error.energy);
  ranks.sum(error.stress);
  for (double* number : {&error.own_energy, &error.product, &error.reference_energy})
    *number = ranks.sum(*number);
  error.doubt = ranks.max(error.doubt);
  error.global.energy = take_roots(error.energy);
  error.global.stress = take_roots(error.stress);
  return error;
}

template <int dim>
StressError stress_error(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                         std::span<const Tensor<dim>> s, std::span<const double> hoop,
                         const fem::LagrangeSpace<dim>& reference_space, std::span<const double> u_ref)
{
  StressError error = stress_squares<dim>(problem, space, s, hoop, reference_space, u_ref);
  const Ranks& ranks = reference_space.mesh().ranks();
  ranks.sum(error.cells);
  error.doubt = ranks.max(error.doubt);
  (void)take_roots(error.cells);
  return error;
}

template std::vector<mesh::CellPair> cell_pairs(const mesh::Mesh<2>&, const mesh::Mesh<2>&);
template std::vector<mesh::CellPair> cell_pairs(const mesh::Mesh<3>&, const mesh::Mesh<3>&);
template LocalError solution_error(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                   std::span<const double>, const fem::LagrangeSpace<2>&,
                                   std::span<const double>);
template LocalError solution_error(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                   std::span<const double>, const fem::LagrangeSpace<3>&,
                                   std::span<const double>);

template StressError stress_error(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                  std::span<const Tensor<2>>, std::span<const double>,
                                  const fem::LagrangeSpace<2>&, std::span<const double>);
template StressError stress_error(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                  std::span<const Tensor<3>>, std::span<const double>,
                                  const fem::LagrangeSpace<3>&, std::span<const double>);

}  // namespace tribound::certify
