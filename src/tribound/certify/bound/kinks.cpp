#include "tribound/certify/bound/kinks.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tribound/fem/bernstein.h"

namespace tribound::certify
{

namespace
{

/// The enclosure of a function, and its smallest and largest values at the points.
struct Range
{
  double lowest, highest;
  double seen_lowest, seen_highest;

  [[nodiscard]] bool changes_sign(double noise) const { return lowest < -noise && highest > noise; }
  /// The square of the possible values of the sign that was not seen.
  [[nodiscard]] double hidden() const
  {
    if (seen_lowest > 0) return std::pow(std::min(lowest, 0.0), 2);
    if (seen_highest < 0) return std::pow(std::max(highest, 0.0), 2);
    return 0;
  }
};

/// P^n, P^t and S_h (if it is polynomial) in columns; rows are their values at the points or their
/// coefficients.
template <int dim>
using Columns = Eigen::Matrix<double, Eigen::Dynamic, dim + 2>;

auto matrix(const std::vector<double>& entries, Eigen::Index n_columns)
{
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(entries.data(), static_cast<Eigen::Index>(entries.size()) / n_columns,
                                    n_columns);
}

/// P^t in a frame in which it is a polynomial: that of space, or in 2D that of a varying N.
template <int dim>
Point<dim> tangential_part(const Point<dim>& p, double p_n, const Point<dim>& n, bool turns)
{
  if constexpr (dim == 2)
    if (turns) return {n[0] * p[1] - n[1] * p[0], 0};
  return p - p_n * n;
}

/// |P^t| - S_h, S_h <= 0 standing for 0.
template <int dim>
Range slip_range(const Columns<dim>& at_points, const Columns<dim>& coefficients)
{
  const auto tangential = [](const Columns<dim>& values) { return values.template middleCols<dim>(1); };
  const auto excess = [&](const Columns<dim>& values)
  { return (tangential(values).rowwise().norm() - values.col(dim + 1)).eval(); };
  Point<dim> direction = tangential(at_points).colwise().sum().transpose();
  if (direction.norm() > 0) direction.normalize();
  const Eigen::VectorXd seen = excess(at_points);
  return {(tangential(coefficients) * direction - coefficients.col(dim + 1)).minCoeff(),
          excess(coefficients).maxCoeff(), seen.minCoeff(), seen.maxCoeff()};
}

/// Whether an undamaged bond carries everything: T = P.
template <int dim>
bool bond_holds(const problem::ContactLaw& law, const Columns<dim>& at_points,
                const Columns<dim>& coefficients)
{
  const double pulled = coefficients.col(0).maxCoeff();
  if (const auto* joint = std::get_if<problem::JointLaw>(&law))
    return pulled <= joint->tension.strength &&
           (joint->stick || slip_range<dim>(at_points, coefficients).highest <= joint->cohesion);
  const auto* const mixed = std::get_if<problem::MixedLaw>(&law);
  if (mixed == nullptr) return false;
  Columns<dim> scaled = coefficients;
  scaled.template middleCols<dim>(1) /= mixed->shear_ratio;
  scaled.col(0) = scaled.col(0).cwiseMax(0.0);
  return scaled.template leftCols<dim + 1>().rowwise().norm().maxCoeff() <= mixed->tension.strength;
}

}  // namespace

template <int dim>
KinkFinder<dim>::KinkFinder(const fem::Quadrature<dim - 1>& rule, int degree)
    : to_bernstein_(fem::bernstein_from_points<dim - 1>(rule, degree)),
      amplification_(matrix(to_bernstein_, rule.size()).cwiseAbs().rowwise().sum().maxCoeff())
{
}

template <int dim>
Kinks KinkFinder<dim>::operator()(const problem::ContactLaw& law, std::span<const Point<dim>> normals,
                                  std::span<const Point<dim>> p, std::span<const double> strength, Bond bond,
                                  double noise) const
{
  const problem::FrictionCone friction = cone(law);
  Columns<dim> at_points(p.size(), dim + 2);
  const bool turns = normals.size() > 1;
  for (std::size_t q = 0; q < p.size(); ++q)
  {
    const Point<dim>& n = normals[turns ? q : 0];
    const double p_n = p[q].dot(n);
    at_points(q, 0) = p_n;
    at_points.template block<1, dim>(q, 1) = tangential_part<dim>(p[q], p_n, n, turns).transpose();
    at_points(q, dim + 1) = friction.closed_limit(strength[q], p_n);
  }
  const Columns<dim> coefficients = matrix(to_bernstein_, at_points.rows()) * at_points;

  const Range pressing{coefficients.col(0).minCoeff(), coefficients.col(0).maxCoeff(),
                       at_points.col(0).minCoeff(), at_points.col(0).maxCoeff()};
  Kinks result{
      .possible = pressing.changes_sign(noise), .hidden = pressing.hidden(), .lowest = pressing.lowest};
  const bool is_friction =
      bond == Bond::none || (bond == Bond::broken && !std::holds_alternative<problem::EndoLaw>(law));
  if (!is_friction)
  {
    result.possible = result.slips = bond != Bond::fresh || !bond_holds<dim>(law, at_points, coefficients);
    result.hidden = 0;
    return result;
  }
  const bool rubs = coefficients.col(dim + 1).maxCoeff() > noise;
  if (!rubs) return result;
  const Range slipping = slip_range<dim>(at_points, coefficients);
  result.possible = result.possible || slipping.changes_sign(noise);
  result.slips = slipping.highest > noise;
  result.hidden += slipping.hidden();
  return result;
}

template class KinkFinder<2>;
template class KinkFinder<3>;

}  // namespace tribound::certify
