#include "tribound/certify/equilibrate/meridian_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/certify/equilibrate/too_flat.h"
#include "tribound/certify/equilibrate/weak_symmetry.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

namespace
{

double interpolate(const std::array<double, 3>& at_vertices, const Point<2>& xhat)
{
  return (1 - xhat.sum()) * at_vertices[0] + xhat[0] * at_vertices[1] + xhat[1] * at_vertices[2];
}

}  // namespace

MeridianCellSource::MeridianCellSource(const contact::NitscheForm<2>& form, bool by_rows,
                                       std::vector<StressMetric> metrics)
    : form_(form),
      by_rows_(by_rows),
      metrics_(std::move(metrics)),
      fields_(form),
      rules_(form.space().mesh(), 2 * form.space().degree() + 2),
      body_phi_(tabulate_permuted(form.space().degree(), form.data().cell_rule()))
{
  for (int i = 0; i < rules_.size(); ++i)
    phi_.push_back(tabulate_permuted(form.space().degree() + 1, rules_[i]));
}

MeridianCell MeridianCellSource::prepare(Index c, std::span<const double> u,
                                         std::span<const Tensor<2>> turning) const
{
  MeridianCell cell;
  cell.sorted = make_sorted_cell(form_.space().mesh(), c);
  cell.r = fields_.radii(cell.sorted);
  cell.has_edge_on_axis = has_edge_on_axis(cell.r);
  const Eigen::MatrixXd times_r = fields_.times_radius(cell.r);
  if (cell.has_edge_on_axis) cell.basis = times_r;
  const double one = std::sqrt(cell.sorted.det / 2);  // the coefficient of 1
  cell.radius_moment = one * times_r.col(0).head(reference().n_divergence);
  cell.radius_integral = one * cell.radius_moment[0];
  const int permutation = permutation_number(cell.sorted.local);
  find_stress(cell, c, u);
  find_body_moments(cell, c, permutation);
  if (by_rows_)
    find_row_operators(cell, products(cell, c, permutation));
  else
    find_symmetric_operators(cell, c, products(cell, c, permutation), turning_in_cell(cell.sorted, turning));
  return cell;
}

Eigen::MatrixXd MeridianCellSource::products(const MeridianCell& cell, Index c, int permutation) const
{
  const fem::Quadrature<2>& rule = rules_.of_cell(c);
  const Eigen::MatrixXd& all = phi_[rules_.number(c)][permutation];
  const Eigen::MatrixXd phi = cell.has_edge_on_axis ? Eigen::MatrixXd(all * cell.basis) : all;
  Eigen::VectorXd weights(rule.size());
  for (int i = 0; i < rule.size(); ++i)
    weights[i] = rule.weights[i] / interpolate(cell.r, to_sorted_cell<2>(cell.sorted.local, rule.points[i]));
  return phi.transpose() * weights.asDiagonal() * phi;
}

void MeridianCellSource::find_row_operators(MeridianCell& cell, const Eigen::MatrixXd& products) const
{
  const SortedCell<2>& sorted = cell.sorted;
  const int m = reference().n_divergence;
  cell.mass = CholeskyFactors(products);
  const CholeskyFactors radius(fields_.times_radius(cell.r).topRows(m));
  if (!cell.mass.is_definite() || !radius.is_definite())
    throw no_equilibrated_stress<2>(sorted.origin, slenderness(sorted));

  const auto reduced = [&](const std::array<Eigen::MatrixXd, 2>& components)
  {
    const Eigen::Index n = cell.mass.lower().rows();
    Eigen::MatrixXd result(2 * n, components[0].rows());
    for (int k = 0; k < 2; ++k)
    {
      const Eigen::MatrixXd in_basis =
          cell.has_edge_on_axis ? Eigen::MatrixXd(components[k] * cell.basis) : components[k];
      result.middleRows(k * n, n) = solve_lower(cell.mass.lower(), in_basis.transpose());
    }
    return result;
  };
  std::array<Eigen::MatrixXd, 2> components;
  for (int k = 0; k < 2; ++k)
    components[k] =
        sorted.inverse(0, k) * reference().derivative[0] + sorted.inverse(1, k) * reference().derivative[1];
  cell.conditions = reduced(components);
  for (int f = 0; f < 3; ++f)
  {
    if (cell.is_on_axis(f)) continue;
    for (int k = 0; k < 2; ++k)
      components[k] = -sorted.grad[f][k] / std::sqrt(sorted.grad_norm[f]) * reference().trace[f];
    cell.trace[0][f] = reduced(components);
  }
  cell.compliance = radius.solve(Eigen::MatrixXd::Identity(m, m));
}

void MeridianCellSource::find_symmetric_operators(MeridianCell& cell, Index c,
                                                  const Eigen::MatrixXd& products,
                                                  const Turning& turning) const
{
  const Eigen::MatrixXd times_r = fields_.times_radius(cell.r);
  const WeakSymmetry fields(reference(), cell, products, times_r,
                            metrics_.empty() ? StressMetric{} : metrics_[form_.space().mesh().region(c)]);
  cell.mass = CholeskyFactors(fields.gram());
  if (!cell.mass.is_definite()) throw no_equilibrated_stress<2>(cell.sorted.origin, slenderness(cell.sorted));
  cell.conditions = solve_lower(cell.mass.lower(), fields.conditions());
  for (int row = 0; row < 2; ++row)
    for (int f = 0; f < 3; ++f)
      if (!cell.is_on_axis(f)) cell.trace[row][f] = solve_lower(cell.mass.lower(), fields.trace(row, f));
  // rho = psi_a (div (r sigma_r(u)) + r f_r - sigma_tt(u)) - (K_{T,a} (x - x_T))_r
  const Eigen::VectorXd force = fields_.load(c, cell.sorted)[0];
  for (int a = 0; a < 3; ++a)
  {
    cell.body[1][a] -= turning[a][1];
    Eigen::VectorXd load = reference().hat[a] * force;
    load.head(reference().n_divergence) -= turning[a][0];
    cell.load[a] = solve_lower(cell.mass.lower(), fields.load(reference().hat[a] * cell.residual[0], load));
  }
}

auto MeridianCellSource::turning_in_cell(const SortedCell<2>& cell, std::span<const Tensor<2>> turning) const
    -> Turning
{
  Turning result;
  for (auto& components : result) components.fill(Eigen::VectorXd::Zero(reference().n_divergence));
  if (turning.empty()) return result;
  const double one = std::sqrt(cell.det / 2);
  const Point<2> centre = cell.jacobian.rowwise().sum() / 3;  // relative to vertex 0
  for (int a = 0; a < 3; ++a)
    for (int v = 0; v < 3; ++v)
    {
      const Point<2> at_vertex =
          turning[a] * (v == 0 ? Point<2>(-centre) : Point<2>(cell.jacobian.col(v - 1) - centre));
      for (int k = 0; k < 2; ++k)
        result[a][k] += at_vertex[k] * one * reference().hat[v].col(0).head(reference().n_divergence);
    }
  return result;
}

void MeridianCellSource::find_stress(MeridianCell& cell, Index c, std::span<const double> u) const
{
  const int m = reference().n_divergence;
  MeridianFields::WeightedStress stress = fields_.stress(c, cell.sorted, u);
  fields_.add_initial_stress(c, cell.sorted, stress);
  cell.sigma = stress.plane;
  for (int row = 0; row < 2; ++row)
  {
    cell.residual[row] = Eigen::VectorXd::Zero(m);
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l)
        cell.residual[row] +=
            cell.sorted.inverse(l, k) * (reference().derivative[l].leftCols(m) * cell.sigma[row][k]);
  }
  cell.residual[0] = fields_.times_radius(cell.r).topRows(m) * cell.residual[0] - stress.hoop;
}

void MeridianCellSource::find_body_moments(MeridianCell& cell, Index c, int permutation) const
{
  for (auto& row : cell.body) row.fill(Eigen::VectorXd::Zero(reference().n_divergence));
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
  if (cell.has_edge_on_axis) fields_.project_at_axis(cell.r, cell.body[1]);
}

}  // namespace tribound::certify
