#include "tribound/contact/nitsche/meridian_cells.h"

#include <cmath>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/initial_stress.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

MeridianCells::MeridianCells(const problem::Problem<2>& problem, const fem::LagrangeSpace<2>& space)
    : problem_(problem),
      space_(space),
      rules_(space.mesh(), 2 * (space.degree() + (problem.has_initial_stress() ? 2 : 0)))  // r sigma_0
{
  tables_.reserve(rules_.size());
  for (int k = 0; k < rules_.size(); ++k) tables_.push_back(space.basis().tabulate(rules_[k].points));
}

template <class Visit>
void MeridianCells::for_each_point(Index cell, const Visit& visit) const
{
  const mesh::CellMap<2> map = mesh::cell_map(space_.mesh(), cell);
  const fem::Tabulation<2>& table = tables_[rules_.number(cell)];
  std::vector<Point<2>> gradients(table.n_nodes);
  for (const auto& [q, x, dx] : fem::cell_points(map, rules_.of_cell(cell)))
  {
    for (int i = 0; i < table.n_nodes; ++i) gradients[i] = map.inverse_transpose * table.gradients_at(q)[i];
    visit(x[0], x[0] * dx, table.values_at(q), std::span<const Point<2>>(gradients));
  }
}

/// With D_ia = d_a phi_i, and phi_i / r added for a = r, the entry (a, b) is the integral of
///     r (lambda D_ia D_jb + mu d_b phi_i d_a phi_j + mu grad phi_i . grad phi_j delta_ab)
/// and, for a = b = r, of 2 mu phi_i phi_j / r.
std::vector<Tensor<2>> MeridianCells::stiffness_row(Index cell, int i) const
{
  const problem::Material& of = material(cell);
  std::vector<Tensor<2>> row(space_.cell_nodes(cell).size(), Tensor<2>::Zero());
  for_each_point(cell,
                 [&](double r, double weight, std::span<const double> phi, std::span<const Point<2>> gradient)
                 {
                   const double hoop_i = phi[i] / r;
                   const Point<2> d_i = gradient[i] + hoop_i * Point<2>::UnitX();
                   for (std::size_t j = 0; j < row.size(); ++j)
                   {
                     const double hoop_j = phi[j] / r;
                     const Point<2> d_j = gradient[j] + hoop_j * Point<2>::UnitX();
                     Tensor<2> density =
                         of.lambda * d_i * d_j.transpose() + of.mu * gradient[j] * gradient[i].transpose();
                     density.diagonal().array() += of.mu * gradient[i].dot(gradient[j]);
                     density(0, 0) += 2 * of.mu * hoop_i * hoop_j;
                     row[j] += weight * density;
                   }
                 });
  return row;
}

namespace
{

/// The gradient of a field with nodal values u.
Tensor<2> gradient_of(std::span<const Index> nodes, std::span<const double> u,
                      std::span<const Point<2>> gradients)
{
  return fem::gradient_at<2>(nodes, u, gradients, Tensor<2>::Identity());
}

}  // namespace

void MeridianCells::add_forces(Index cell, std::span<const double> u, std::span<double> vector) const
{
  const std::span<const Index> nodes = space_.cell_nodes(cell);
  for_each_point(cell,
                 [&](double r, double weight, std::span<const double> phi, std::span<const Point<2>> gradient)
                 {
                   const Tensor<2> of_u = gradient_of(nodes, u, gradient);
                   const double hoop = fem::value_at<2>(nodes, u, phi)[0] / r;
                   const Tensor<2> stress = weight * sigma<2>(material(cell), of_u, hoop);
                   const double hoop_force = weight / r * hoop_stress(material(cell), of_u, hoop);
                   for (std::size_t i = 0; i < nodes.size(); ++i)
                   {
                     Eigen::Map<Point<2>> force(&vector[2 * static_cast<std::size_t>(nodes[i])]);
                     force += stress * gradient[i];
                     force[0] += hoop_force * phi[i];
                   }
                 });
}

auto MeridianCells::at_points(const InitialStress<2>* initial, Index cell) const -> std::vector<Stress>
{
  const std::vector<Point<2>>& points = rules_.of_cell(cell).points;
  std::vector<Stress> values(points.size());
  if (initial == nullptr || !initial->acts_on(cell)) return values;
  const int degree = space_.degree() + 1;
  std::vector<double> theta(fem::polynomial_dimension(2, degree));
  const std::span<const Tensor<2>> plane = initial->coefficients(cell);
  const std::span<const double> hoop = initial->hoop_coefficients(cell);
  for (std::size_t q = 0; q < points.size(); ++q)
  {
    fem::orthonormal_values<2>(degree, points[q], theta);
    for (std::size_t j = 0; j < plane.size(); ++j)
    {
      values[q].plane += theta[j] * plane[j];
      values[q].hoop += theta[j] * hoop[j];
    }
  }
  return values;
}

void MeridianCells::add_initial_forces(Index cell, const InitialStress<2>& initial,
                                       std::span<double> vector) const
{
  const std::span<const Index> nodes = space_.cell_nodes(cell);
  const std::vector<Stress> given = at_points(&initial, cell);
  auto stress = given.begin();
  for_each_point(cell,
                 [&](double r, double weight, std::span<const double> phi, std::span<const Point<2>> gradient)
                 {
                   for (std::size_t i = 0; i < nodes.size(); ++i)
                   {
                     Eigen::Map<Point<2>> force(&vector[2 * static_cast<std::size_t>(nodes[i])]);
                     force -= weight * stress->plane * gradient[i];
                     force[0] -= weight / r * stress->hoop * phi[i];
                   }
                   ++stress;
                 });
}

auto MeridianCells::squares(Index cell, std::span<const double> u, const InitialStress<2>* initial) const
    -> Squares
{
  const problem::Material& of = material(cell);
  const std::span<const Index> nodes = space_.cell_nodes(cell);
  const std::vector<Stress> given = at_points(initial, cell);
  auto rest = given.begin();
  Squares sums;
  for_each_point(
      cell,
      [&](double r, double weight, std::span<const double> phi, std::span<const Point<2>> gradient)
      {
        const Tensor<2> of_u = gradient_of(nodes, u, gradient);
        const double hoop = fem::value_at<2>(nodes, u, phi)[0] / r;
        const Tensor<2> stress = sigma<2>(of, of_u, hoop);
        const double along = hoop_stress(of, of_u, hoop);
        sums.energy += weight * (stress.cwiseProduct(of_u).sum() + along * hoop);
        sums.sigma += weight * ((stress + rest->plane).squaredNorm() + std::pow(along + rest->hoop, 2));
        double terms = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          terms +=
              std::hypot(u[2 * nodes[i]], u[2 * nodes[i] + 1]) * (gradient[i].norm() + std::abs(phi[i]) / r);
        sums.terms +=
            weight *
            std::pow((2 * of.mu + 3 * of.lambda) * terms + std::hypot(rest->plane.norm(), rest->hoop), 2);
        ++rest;
      });
  return sums;
}

}  // namespace tribound::contact
