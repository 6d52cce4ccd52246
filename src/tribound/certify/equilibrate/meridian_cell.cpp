#include "tribound/certify/equilibrate/meridian_cell.h"

#include <algorithm>
#include <cmath>

#include "tribound/certify/equilibrate/too_flat.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

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

double interpolate(const std::array<double, 3>& at_vertices, const Point<2>& xhat)
{
  return (1 - xhat.sum()) * at_vertices[0] + xhat[0] * at_vertices[1] + xhat[1] * at_vertices[2];
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

MeridianCellSource::MeridianCellSource(const contact::NitscheForm<2>& form)
    : form_(form),
      reference_(form.space().degree()),
      rules_(form.space().mesh(), 2 * form.space().degree() + 2),
      stress_rule_(fem::quadrature<2>(2 * form.space().degree())),
      stress_phi_(tabulate(form.space().degree(), stress_rule_)),
      stress_tabulation_(form.space().basis().tabulate(stress_rule_.points)),
      body_phi_(tabulate(form.space().degree(), form.data().cell_rule()))
{
  for (int i = 0; i < rules_.size(); ++i) phi_.push_back(tabulate(form.space().degree() + 1, rules_[i]));
}

MeridianCellSource::Tables MeridianCellSource::tabulate(int degree, const fem::Quadrature<2>& rule)
{
  Tables tables;
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

MeridianCell MeridianCellSource::prepare(Index c, std::span<const double> u) const
{
  MeridianCell cell;
  cell.sorted = make_sorted_cell(form_.space().mesh(), c);
  for (int i = 0; i < 3; ++i) cell.r[i] = form_.space().mesh().vertex(cell.sorted.vertices[i])[0];
  const int permutation = permutation_number(cell.sorted.local);
  find_operators(cell, c, permutation);
  find_stress(cell, c, permutation, u);
  find_body_moments(cell, c, permutation);
  return cell;
}

void MeridianCellSource::find_operators(MeridianCell& cell, Index c, int permutation) const
{
  const SortedCell<2>& sorted = cell.sorted;
  const int m = reference_.n_divergence;
  Eigen::MatrixXd times_r = Eigen::MatrixXd::Zero(reference_.n_stress, m);
  for (int i = 0; i < 3; ++i) times_r += cell.r[i] * reference_.hat[i];
  cell.has_edge_on_axis = std::ranges::count(cell.r, 0.0) == 2;
  if (cell.has_edge_on_axis) cell.basis = times_r;
  const auto in_basis = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd
  { return cell.has_edge_on_axis ? matrix * cell.basis : matrix; };

  const fem::Quadrature<2>& rule = rules_.of_cell(c);
  const Eigen::MatrixXd phi = in_basis(phi_[rules_.number(c)][permutation]);
  Eigen::VectorXd weights(rule.size());
  for (int i = 0; i < rule.size(); ++i)
    weights[i] = rule.weights[i] / interpolate(cell.r, to_sorted_cell<2>(sorted.local, rule.points[i]));
  cell.mass = CholeskyFactors(phi.transpose() * weights.asDiagonal() * phi);
  const CholeskyFactors radius(times_r.topRows(m));
  if (!cell.mass.is_definite() || !radius.is_definite())
    throw no_equilibrated_stress<2>(sorted.origin, slenderness(sorted));

  const auto reduced = [&](const std::array<Eigen::MatrixXd, 2>& components)
  {
    const Eigen::Index n = cell.mass.lower().rows();
    Eigen::MatrixXd result(2 * n, components[0].rows());
    for (int k = 0; k < 2; ++k)
      result.middleRows(k * n, n) = solve_lower(cell.mass.lower(), in_basis(components[k]).transpose());
    return result;
  };
  std::array<Eigen::MatrixXd, 2> components;
  for (int k = 0; k < 2; ++k)
    components[k] =
        sorted.inverse(0, k) * reference_.derivative[0] + sorted.inverse(1, k) * reference_.derivative[1];
  cell.divergence = reduced(components);
  for (int f = 0; f < 3; ++f)
  {
    if (cell.is_on_axis(f)) continue;
    for (int k = 0; k < 2; ++k)
      components[k] = -sorted.grad[f][k] / std::sqrt(sorted.grad_norm[f]) * reference_.trace[f];
    cell.trace[f] = reduced(components);
  }
  cell.compliance = radius.solve(Eigen::MatrixXd::Identity(m, m));
  const double one = std::sqrt(sorted.det / 2);  // the coefficient of 1
  cell.radius_moment = one * times_r.col(0).head(m);
  cell.radius_integral = one * cell.radius_moment[0];
}

/// r sigma and r sigma_tt are polynomials of degree p, of which nothing need be divided by r.
void MeridianCellSource::find_stress(MeridianCell& cell, Index c, int permutation,
                                     std::span<const double> u) const
{
  const fem::LagrangeSpace<2>& space = form_.space();
  const problem::Material& material = form_.problem().material(space.mesh().region(c));
  const mesh::CellMap<2> map = mesh::cell_map(space.mesh(), c);
  const int m = reference_.n_divergence;
  for (auto& row : cell.sigma) row.fill(Eigen::VectorXd::Zero(m));
  Eigen::VectorXd hoop = Eigen::VectorXd::Zero(m);
  for (int i = 0; i < stress_rule_.size(); ++i)
  {
    const double r = map(stress_rule_.points[i])[0];
    const Tensor<2> gradient = fem::gradient_at<2>(space.cell_nodes(c), u, stress_tabulation_.gradients_at(i),
                                                   map.inverse_transpose);
    const double u_r = fem::value_at<2>(space.cell_nodes(c), u, stress_tabulation_.values_at(i))[0];
    const Tensor<2> sigma = contact::sigma<2>(material, r * gradient, u_r);
    const Eigen::VectorXd weighted =
        stress_rule_.weights[i] * std::sqrt(map.det) * stress_phi_[permutation].row(i).transpose();
    for (int row = 0; row < 2; ++row)
      for (int k = 0; k < 2; ++k) cell.sigma[row][k] += sigma(row, k) * weighted;
    hoop += contact::hoop_stress(material, Tensor<2>(r * gradient), u_r) * weighted;
  }
  for (int row = 0; row < 2; ++row)
  {
    cell.residual[row] = Eigen::VectorXd::Zero(m);
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l)
        cell.residual[row] +=
            cell.sorted.inverse(l, k) * (reference_.derivative[l].leftCols(m) * cell.sigma[row][k]);
  }
  Eigen::VectorXd times_r = Eigen::VectorXd::Zero(m);
  for (int a = 0; a < 3; ++a) times_r += cell.r[a] * (reference_.hat[a].topRows(m) * cell.residual[0]);
  cell.residual[0] = times_r - hoop;
}

void MeridianCellSource::find_body_moments(MeridianCell& cell, Index c, int permutation) const
{
  for (auto& row : cell.body) row.fill(Eigen::VectorXd::Zero(reference_.n_divergence));
  if (!form_.data().has_body_force(c)) return;
  const fem::Quadrature<2>& rule = form_.data().cell_rule();
  std::vector<Point<2>> f(rule.size());
  form_.data().body_force(c, f);
  for (int i = 0; i < rule.size(); ++i)
  {
    const Point<2> xhat = to_sorted_cell<2>(cell.sorted.local, rule.points[i]);
    const double r = interpolate(cell.r, xhat);
    const Eigen::VectorXd weighted =
        rule.weights[i] * std::sqrt(cell.sorted.det) * r * body_phi_[permutation].row(i).transpose();
    const std::array<double, 3> lambda = fem::barycentric<2>(xhat);
    for (int a = 0; a < 3; ++a)
    {
      cell.body[0][a] += lambda[a] * r * f[i][0] * weighted;
      cell.body[1][a] += lambda[a] * f[i][1] * weighted;
    }
  }
  if (!cell.has_edge_on_axis) return;
  const int n = fem::polynomial_dimension(2, form_.space().degree() - 1);
  const CholeskyFactors radius(cell.basis.topLeftCorner(n, n));
  for (Eigen::VectorXd& moments : cell.body[1])
    moments = cell.basis.topLeftCorner(moments.size(), n) * radius.solve(moments.head(n));
}

}  // namespace tribound::certify
