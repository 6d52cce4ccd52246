#include "tribound/certify/energy/meridian_admissible.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/alfeld.h"
#include "tribound/certify/energy/alfeld_reference.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

/// Where the normal stresses, whose sum is the trace, stand among the columns.
constexpr std::array normal_stresses = {0, 1, 3};

/// C^{-1} in these columns: 1/2mu on deviators, 1/(2 mu + 3 lambda) on pressures.
Eigen::Matrix4d compliance_around_axis(const problem::Material& material)
{
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity() / (2 * material.mu);
  const double of_trace = (1 / (2 * material.mu + 3 * material.lambda) - 1 / (2 * material.mu)) / 3;
  for (const int a : normal_stresses)
    for (const int b : normal_stresses) result(a, b) += of_trace;
  return result;
}

/// The radii of the pieces of each cell: piece i has the barycentre in place of vertex i.
std::vector<std::array<double, 3>> radii_of_pieces(std::span<const std::array<double, 3>> of_cells)
{
  std::vector<std::array<double, 3>> result;
  for (const std::array<double, 3>& r : of_cells)
    for (int i = 0; i < 3; ++i)
    {
      result.push_back(r);
      result.back()[i] = (r[0] + r[1] + r[2]) / 3;
    }
  return result;
}

/// Three columns for each of the functions.
Eigen::MatrixXd by_components(const std::vector<double>& functions, int n_rows)
{
  return Eigen::Map<const Eigen::MatrixXd>(functions.data(), n_rows,
                                           static_cast<Eigen::Index>(functions.size()) / n_rows);
}

/// sum_k x_k times the columns 3 k, 3 k + 1, 3 k + 2.
Eigen::MatrixXd combination(const Eigen::MatrixXd& functions, const Eigen::VectorXd& x)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(functions.rows(), 3);
  for (Eigen::Index k = 0; k < x.size(); ++k) result += x[k] * functions.middleCols(3 * k, 3);
  return result;
}

/// The map of the components of tau^ to those of J tau^ J^T.
Eigen::Matrix3d component_map(const Tensor<2>& jacobian)
{
  Eigen::Matrix3d map;
  for (int a = 0; a < 3; ++a)
    map.col(a) = symmetric_vector<2>(jacobian * symmetric_tensor<2>(SymmetricVector<2>::Unit(a)) *
                                     jacobian.transpose());
  return map;
}

}  // namespace

Eigen::MatrixXd MeridianMetric::in_orthonormal_basis(const Eigen::MatrixXd& on_pieces) const
{
  Eigen::MatrixXd result(on_pieces.rows(), on_pieces.cols());
  for (int i = 0; i < 3; ++i)
  {
    const Eigen::Index n = lower[i].rows();
    result.middleRows(i * n, n) =
        lower[i].transpose().triangularView<Eigen::Upper>() * on_pieces.middleRows(i * n, n);
  }
  return result;
}

// Of deviators and traces, so that a square is not negative.
double MeridianMetric::product(const MeridianStress& a, const MeridianStress& b) const
{
  const auto split = [&](const MeridianStress& stress)
  {
    MeridianStress deviator = in_orthonormal_basis(stress);
    const Eigen::VectorXd trace = deviator.col(0) + deviator.col(1) + deviator.col(3);
    for (const int c : normal_stresses) deviator.col(c) -= trace / 3;
    return std::pair(deviator, trace);
  };
  const auto [deviator_a, trace_a] = split(a);
  const auto [deviator_b, trace_b] = split(b);
  return deviator_a.cwiseProduct(deviator_b).sum() / (2 * material.mu) +
         trace_a.dot(trace_b) / (3 * (2 * material.mu + 3 * material.lambda));
}

// With 1 / r = pi + e, |e| <= E, pi of a degree for which the rule is exact, the rule errs by the integral of
// e and by its own value of it, at most 2 E ||a|| ||b|| without weight; these norms are exact by the rule and
// at most the square root of the largest r times those with 1 / r.
double MeridianMetric::doubt(const MeridianStress& a, const MeridianStress& b) const
{
  return error * std::sqrt(product(a, a) * product(b, b));
}

MeridianStressSolver::MeridianStressSolver(std::vector<std::array<double, 3>> radii, int q)
    : q_(q),
      n_(fem::polynomial_dimension(2, q)),
      radii_(std::move(radii)),
      rules_(radii_of_pieces(radii_), 2 * q)
{
  for (int number = 0; number < rules_.size(); ++number)
  {
    const fem::Quadrature<2>& rule = rules_[number];
    Eigen::MatrixXd& table = phi_.emplace_back(rule.size(), n_);
    Eigen::VectorXd phi(n_);
    for (int k = 0; k < rule.size(); ++k)
    {
      fem::orthonormal_values<2>(q, rule.points[k], {phi.data(), static_cast<std::size_t>(n_)});
      table.row(k) = phi.transpose();
    }
  }
  for (int facet = 0; facet < 4; ++facet)
  {
    const AlfeldFactors factors =
        facet < 3 ? alfeld_factors_without_stress_on(facet, q) : alfeld_factors<2>(q);
    references_[facet] = {by_components(factors.kernel, 3 * n_), by_components(factors.lifting, 3 * n_)};
    restriction_ = by_components(factors.restriction, 3 * n_);
  }
}

auto MeridianStressSolver::reference(Index cell) const -> const Reference&
{
  const std::array<double, 3>& r = radii_[cell];
  if (std::ranges::count(r, 0.0) != 2) return references_[3];
  return references_[std::ranges::max_element(r) - r.begin()];
}

MeridianMetric MeridianStressSolver::metric(Index cell, const problem::Material& material) const
{
  MeridianMetric result{material, {}, 0};
  for (int i = 0; i < 3; ++i)
  {
    std::array<double, 3> r = radii_[cell];
    r[i] = (r[0] + r[1] + r[2]) / 3;
    const Index piece = 3 * cell + i;
    const fem::Quadrature<2>& rule = rules_.of_cell(piece);
    const Eigen::MatrixXd& phi = phi_[rules_.number(piece)];
    Eigen::VectorXd weights(rule.size());
    for (int k = 0; k < rule.size(); ++k)
    {
      const std::array<double, 3> lambda = fem::barycentric<2>(rule.points[k]);
      weights[k] = rule.weights[k] / (lambda[0] * r[0] + lambda[1] * r[1] + lambda[2] * r[2]);
    }
    result.lower[i] = CholeskyFactors(phi.transpose() * weights.asDiagonal() * phi).lower();
    result.error = std::max(result.error, rules_.relative_error(piece));
  }
  return result;
}

MeridianStress MeridianStressSolver::on_pieces(const MeridianStress& on_cell) const
{
  return restriction_.leftCols(on_cell.rows()) * on_cell;
}

AdmissibleMeridianStress MeridianStressSolver::solve(Index cell, const SortedCell<2>& sorted,
                                                     const MeridianMetric& metric,
                                                     std::span<const double> tau_h,
                                                     const Eigen::VectorXd& r_vartheta_h,
                                                     const MeridianStress& target) const
{
  const Eigen::Map<const Eigen::MatrixXd> entries(tau_h.data(), n_, 4);
  const Eigen::VectorXd skew = (entries.col(1) - entries.col(2)) / 2;
  MeridianStress rest = MeridianStress::Zero(n_, 4);
  rest.topRows(target.rows()) -= target;
  rest.col(0) += entries.col(0);
  rest.col(1) += entries.col(3);
  rest.col(2) += (entries.col(1) + entries.col(2)) * M_SQRT1_2;
  rest.col(3).head(r_vartheta_h.size()) += r_vartheta_h;

  const Reference& on_reference = reference(cell);
  AdmissibleMeridianStress result{on_pieces(rest), M_SQRT2 * std::abs(skew[0])};
  // J^{-1} w J^{-T} of a skew tensor is a multiple of it.
  const Eigen::MatrixXd lifted =
      combination(on_reference.lifting, sorted.inverse.determinant() * skew.tail(n_ - 1));
  result.difference.leftCols<3>() += lifted * component_map(sorted.jacobian).transpose();
  minimise(on_reference, metric, sorted.jacobian, result.difference);
  return result;
}

// The functions of the kernel have no hoop stress; that of the difference acts on them through the trace.
void MeridianStressSolver::minimise(const Reference& reference, const MeridianMetric& metric,
                                    const Tensor<2>& jacobian, MeridianStress& difference) const
{
  const Eigen::Matrix3d map = component_map(jacobian);
  const Eigen::Matrix<double, 3, 4> compliance =
      map.transpose() * compliance_around_axis(metric.material).topRows<3>();
  const Eigen::Matrix3d of_components = compliance.leftCols<3>() * map;
  const Eigen::MatrixXd kernel = metric.in_orthonormal_basis(reference.kernel);
  const Eigen::MatrixXd products = kernel.transpose() * kernel;
  const Eigen::MatrixXd data = kernel.transpose() * metric.in_orthonormal_basis(difference);
  const Eigen::Index n = kernel.cols() / 3;
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    right[k] = compliance.cwiseProduct(data.middleRows(3 * k, 3)).sum();
    for (Eigen::Index l = 0; l < n; ++l)
      gram(k, l) = of_components.cwiseProduct(products.block<3, 3>(3 * k, 3 * l)).sum();
  }
  const CholeskyFactors factors(gram);
  if (!factors.is_definite()) return;
  difference.leftCols<3>() -= combination(reference.kernel, factors.solve(right)) * map.transpose();
}

}  // namespace tribound::certify
