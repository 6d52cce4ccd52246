#include "tribound/certify/equilibrate/meridian_fields.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

template <int k>
Eigen::VectorXd orthonormal_basis_at(int degree, const Point<k>& x)
{
  Eigen::VectorXd values(fem::polynomial_dimension(k, degree));
  fem::orthonormal_values<k>(degree, x, std::span(values.data(), values.size()));
  return values;
}

/// By columns the functions of the orthonormal basis in a cell's own coordinates, by that in sorted ones.
PermutedTables coordinates_sorted(int degree)
{
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * degree);
  PermutedTables tables = tabulate_permuted(degree, rule);
  const Eigen::MatrixXd own =
      Eigen::Map<const Eigen::VectorXd>(rule.weights.data(), rule.size()).asDiagonal() * tables.front();
  for (Eigen::MatrixXd& table : tables) table = (table.transpose() * own).eval();
  return tables;
}

}  // namespace

MeridianReference::MeridianReference(int p)
    : n_stress(fem::polynomial_dimension(2, p + 1)),
      n_divergence(fem::polynomial_dimension(2, p)),
      n_facet(p + 2)
{
  const int q = p + 1;
  derivative.fill(Eigen::MatrixXd::Zero(n_divergence, n_stress));
  trace.fill(Eigen::MatrixXd::Zero(n_facet, n_stress));
  hat.fill(Eigen::MatrixXd::Zero(n_stress, n_divergence));
  hat_on_facet.fill(Eigen::MatrixXd::Zero(n_facet, n_facet - 1));
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * q);
  std::vector<Point<2>> gradients(n_stress);
  Eigen::VectorXd phi(n_stress);
  for (int i = 0; i < rule.size(); ++i)
  {
    fem::orthonormal_gradients<2>(q, rule.points[i], std::span(phi.data(), phi.size()), gradients);
    const auto phi_p = phi.head(n_divergence);
    for (int j = 0; j < n_stress; ++j)
      for (int k = 0; k < 2; ++k) derivative[k].col(j) += rule.weights[i] * gradients[j][k] * phi_p;
    const std::array<double, 3> lambda = fem::barycentric<2>(rule.points[i]);
    for (int a = 0; a < 3; ++a) hat[a] += rule.weights[i] * lambda[a] * phi * phi_p.transpose();
  }
  const fem::Quadrature<1> facet_rule = fem::quadrature<1>(2 * q);
  for (int i = 0; i < facet_rule.size(); ++i)
  {
    const Eigen::VectorXd theta = orthonormal_basis_at<1>(q, facet_rule.points[i]);
    const std::array<double, 2> lambda = fem::barycentric<1>(facet_rule.points[i]);
    for (int v = 0; v < 2; ++v)
      hat_on_facet[v] += facet_rule.weights[i] * lambda[v] * theta * theta.head(n_facet - 1).transpose();
    for (int f = 0; f < 3; ++f)
      trace[f] += facet_rule.weights[i] * theta *
                  orthonormal_basis_at<2>(q, mesh::facet_to_cell<2>(f, facet_rule.points[i])).transpose();
  }
}

PermutedTables tabulate_permuted(int degree, const fem::Quadrature<2>& rule)
{
  PermutedTables tables;
  std::array<int, 3> local = {0, 1, 2};
  do
  {
    Eigen::MatrixXd& table = tables[permutation_number(local)];
    table.resize(rule.size(), fem::polynomial_dimension(2, degree));
    for (int i = 0; i < rule.size(); ++i)
      table.row(i) = orthonormal_basis_at<2>(degree, to_sorted_cell<2>(local, rule.points[i])).transpose();
  } while (std::ranges::next_permutation(local).found);
  return tables;
}

MeridianFields::MeridianFields(const contact::NitscheForm<2>& form)
    : form_(form),
      reference_(form.space().degree()),
      stress_rule_(fem::quadrature<2>(2 * form.space().degree())),
      stress_phi_(tabulate_permuted(form.space().degree(), stress_rule_)),
      stress_tabulation_(form.space().basis().tabulate(stress_rule_.points)),
      to_sorted_(coordinates_sorted(form.space().degree() + 1)),
      body_phi_(tabulate_permuted(form.space().degree(), form.data().cell_rule()))
{
}

// r sigma and r sigma_tt are polynomials of degree p, of which nothing need be divided by r.
auto MeridianFields::stress(Index c, const SortedCell<2>& cell, std::span<const double> u) const
    -> WeightedStress
{
  const fem::LagrangeSpace<2>& space = form_.space();
  const problem::Material& material = form_.problem().material(space.mesh().region(c));
  const mesh::CellMap<2> map = mesh::cell_map(space.mesh(), c);
  const Eigen::MatrixXd& phi = stress_phi_[permutation_number(cell.local)];
  WeightedStress result;
  for (auto& row : result.plane) row.fill(Eigen::VectorXd::Zero(phi.cols()));
  result.hoop.setZero(phi.cols());
  for (int i = 0; i < stress_rule_.size(); ++i)
  {
    const double r = map(stress_rule_.points[i])[0];
    const Tensor<2> gradient = fem::gradient_at<2>(space.cell_nodes(c), u, stress_tabulation_.gradients_at(i),
                                                   map.inverse_transpose);
    const double u_r = fem::value_at<2>(space.cell_nodes(c), u, stress_tabulation_.values_at(i))[0];
    const Tensor<2> sigma = contact::sigma<2>(material, r * gradient, u_r);
    const Eigen::VectorXd weighted = stress_rule_.weights[i] * std::sqrt(map.det) * phi.row(i).transpose();
    for (int row = 0; row < 2; ++row)
      for (int k = 0; k < 2; ++k) result.plane[row][k] += sigma(row, k) * weighted;
    result.hoop += contact::hoop_stress(material, Tensor<2>(r * gradient), u_r) * weighted;
  }
  return result;
}

std::array<Eigen::VectorXd, 4> MeridianFields::initial_stress(Index c, const SortedCell<2>& cell) const
{
  const contact::InitialStress<2>& initial = form_.data().initial_stress();
  const std::span<const Tensor<2>> plane = initial.coefficients(c);
  const std::span<const double> hoop = initial.hoop_coefficients(c);
  const Eigen::MatrixXd& to_sorted = to_sorted_[permutation_number(cell.local)];
  std::array<Eigen::VectorXd, 4> result;
  result.fill(Eigen::VectorXd::Zero(reference_.n_stress));
  for (std::size_t j = 0; j < plane.size(); ++j)
  {
    const Eigen::VectorXd column = std::sqrt(cell.det) * to_sorted.col(static_cast<Eigen::Index>(j));
    result[0] += plane[j](0, 0) * column;
    result[1] += plane[j](1, 1) * column;
    result[2] += plane[j](0, 1) * column;
    result[3] += hoop[j] * column;
  }
  return result;
}

void MeridianFields::add_initial_stress(Index c, const SortedCell<2>& cell, WeightedStress& stress) const
{
  if (!has_initial_stress(c)) return;
  const std::array<double, 3> r = radii(cell);
  const Eigen::MatrixXd to_moments = times_radius(r).transpose();
  std::array<Eigen::VectorXd, 4> moments = initial_stress(c, cell);
  for (Eigen::VectorXd& component : moments) component = (to_moments * component).eval();
  if (has_edge_on_axis(r)) project_at_axis(r, std::span(moments).first<3>());
  const auto& [rr, zz, rz, hoop] = moments;
  stress.plane[0][0] += rr;
  stress.plane[1][1] += zz;
  stress.plane[0][1] += rz;
  stress.plane[1][0] += rz;
  stress.hoop += hoop;
}

std::array<Eigen::VectorXd, 2> MeridianFields::load(Index c, const SortedCell<2>& cell) const
{
  std::array<Eigen::VectorXd, 2> result;
  result.fill(Eigen::VectorXd::Zero(reference_.n_divergence));
  if (!form_.data().has_body_force(c)) return result;
  const fem::Quadrature<2>& rule = form_.data().cell_rule();
  const Eigen::MatrixXd& phi = body_phi_[permutation_number(cell.local)];
  const mesh::CellMap<2> map = mesh::cell_map(form_.space().mesh(), c);
  std::vector<Point<2>> f(rule.size());
  form_.data().body_force(c, f);
  for (int i = 0; i < rule.size(); ++i)
  {
    const double weight = rule.weights[i] * std::sqrt(map.det) * map(rule.points[i])[0];
    for (int k = 0; k < 2; ++k) result[k] += weight * f[i][k] * phi.row(i).transpose();
  }
  const std::array<double, 3> r = radii(cell);
  if (has_edge_on_axis(r)) project_at_axis(r, result);
  return result;
}

void MeridianFields::project_at_axis(const std::array<double, 3>& r, std::span<Eigen::VectorXd> moments) const
{
  const int n = fem::polynomial_dimension(2, form_.space().degree() - 1);
  const Eigen::MatrixXd by_radius = times_radius(r).topLeftCorner(reference_.n_divergence, n);
  const CholeskyFactors radius(by_radius.topRows(n));
  for (Eigen::VectorXd& component : moments) component = by_radius * radius.solve(component.head(n));
}

Eigen::MatrixXd MeridianFields::times_radius(const std::array<double, 3>& r) const
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(reference_.n_stress, reference_.n_divergence);
  for (int i = 0; i < 3; ++i) result += r[i] * reference_.hat[i];
  return result;
}

std::array<double, 3> MeridianFields::radii(const SortedCell<2>& cell) const
{
  std::array<double, 3> r;
  for (int i = 0; i < 3; ++i) r[i] = form_.space().mesh().vertex(cell.vertices[i])[0];
  return r;
}

}  // namespace tribound::certify
