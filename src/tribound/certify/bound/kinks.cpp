#include "tribound/certify/bound/kinks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tribound/certify/equilibrate/small_dense.h"
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

/// P^n, P^t and S_h (if it is polynomial): the values at a point, or a coefficient.
template <int dim>
struct Row : DenseVector<dim + 2>
{
  [[nodiscard]] double normal() const { return (*this)[0]; }
  [[nodiscard]] Point<dim> tangential() const { return Eigen::Map<const Point<dim>>(this->data() + 1); }
  [[nodiscard]] double limit() const { return (*this)[dim + 1]; }
  /// |P^t| - S_h
  [[nodiscard]] double excess() const { return tangential().norm() - limit(); }
};

template <int dim>
using Rows = std::vector<Row<dim>>;

template <int dim, class Value>
double least(const Rows<dim>& rows, const Value& value)
{
  double result = std::numeric_limits<double>::infinity();
  for (const Row<dim>& row : rows) result = std::min(result, value(row));
  return result;
}
template <int dim, class Value>
double greatest(const Rows<dim>& rows, const Value& value)
{
  return -least(rows, [&](const Row<dim>& row) { return -value(row); });
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
Range slip_range(const Rows<dim>& at_points, const Rows<dim>& coefficients)
{
  const auto excess = [](const Row<dim>& row) { return row.excess(); };
  Point<dim> direction = Point<dim>::Zero();
  for (const Row<dim>& row : at_points) direction += row.tangential();
  if (direction.norm() > 0) direction.normalize();
  return {
      least(coefficients, [&](const Row<dim>& row) { return row.tangential().dot(direction) - row.limit(); }),
      greatest(coefficients, excess), least(at_points, excess), greatest(at_points, excess)};
}

/// Whether an undamaged bond carries everything: T = P.
template <int dim>
bool bond_holds(const problem::ContactLaw& law, const Rows<dim>& at_points, const Rows<dim>& coefficients)
{
  if (const auto* joint = std::get_if<problem::JointLaw>(&law))
    return greatest(coefficients, [](const Row<dim>& row) { return row.normal(); }) <=
               joint->tension.strength &&
           (joint->stick || slip_range<dim>(at_points, coefficients).highest <= joint->cohesion);
  const auto* const mixed = std::get_if<problem::MixedLaw>(&law);
  if (mixed == nullptr) return false;
  return greatest(coefficients,
                  [&](const Row<dim>& row) {
                    return std::hypot(std::max(row.normal(), 0.0),
                                      row.tangential().norm() / mixed->shear_ratio);
                  }) <= mixed->tension.strength;
}

}  // namespace

template <int dim>
KinkFinder<dim>::KinkFinder(const fem::Quadrature<dim - 1>& rule, int degree)
    : to_bernstein_(fem::bernstein_from_points<dim - 1>(rule, degree)), n_points_(rule.size())
{
  for (auto row = to_bernstein_.begin(); row != to_bernstein_.end(); row += n_points_)
    amplification_ = std::max(
        amplification_,
        std::accumulate(row, row + n_points_, 0.0, [](double sum, double x) { return sum + std::abs(x); }));
}

template <int dim>
Kinks KinkFinder<dim>::operator()(const problem::ContactLaw& law, std::span<const Point<dim>> normals,
                                  std::span<const Point<dim>> p, std::span<const double> strength, Bond bond,
                                  double noise) const
{
  const problem::FrictionCone friction = cone(law);
  if (friction.is_bilateral) return {.lowest = -std::numeric_limits<double>::infinity()};  // T is linear
  Rows<dim> at_points(p.size());
  const bool turns = normals.size() > 1;
  for (std::size_t q = 0; q < p.size(); ++q)
  {
    const Point<dim>& n = normals[turns ? q : 0];
    const double p_n = p[q].dot(n);
    at_points[q][0] = p_n;
    Eigen::Map<Point<dim>>(at_points[q].data() + 1) = tangential_part<dim>(p[q], p_n, n, turns);
    at_points[q][dim + 1] = friction.closed_limit(strength[q], p_n);
  }
  Rows<dim> coefficients(to_bernstein_.size() / n_points_);
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    for (int q = 0; q < n_points_; ++q)
      add_multiple(coefficients[i], to_bernstein_[i * n_points_ + q], at_points[q]);

  const auto normal = [](const Row<dim>& row) { return row.normal(); };
  const Range pressing{least(coefficients, normal), greatest(coefficients, normal), least(at_points, normal),
                       greatest(at_points, normal)};
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
  const bool rubs = greatest(coefficients, [](const Row<dim>& row) { return row.limit(); }) > noise;
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
