#include "tribound/contact/nitsche/datum_moments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// An affine function of this size, relative to its terms, counts as 0.
constexpr double rounding = 1e-13;

/// The number of parts that a formula may need before it is seen to be bounded. It depends on the formula and
/// the simplex, not on the effort that all simplices together are worth.
constexpr int most_unbounded_parts = 1 << 15;

/// The smallest edge of a part, relative to the simplex.
constexpr double smallest_edge = 1e-4;

/// Lengths and costs whose relative difference is smaller are equal, so that rounding, and with it the
/// numbering of the mesh, decides nothing.
constexpr double tie = 1e-9;

/// k!: integrals over a simplex of measure |T| are k! |T| times those over the reference simplex.
template <int k>
constexpr double factorial = k == 3 ? 6 : k;

template <int k, int dim, int n>
double measure_of(const DatumPart<k, n>& part, const SimplexMap<k, dim>& map)
{
  return map.measure * fem::fraction<k>(part.part);
}

/// The whole simplex, its vertices ordered by their coordinates (x, then y, then z): how it is cut and halved
/// then does not depend on their numbering.
template <int k, int dim>
fem::Part<k> ordered_simplex(const SimplexMap<k, dim>& map)
{
  fem::Part<k> whole = fem::reference_simplex<k>();
  double size = 0;
  for (const Point<k>& s : whole) size = std::max(size, map(s).cwiseAbs().maxCoeff());
  std::ranges::sort(whole, [&](const Point<k>& a, const Point<k>& b)
                    { return mesh::comes_before<dim>(map(a), map(b), rounding * size); });
  return whole;
}

/// The two halves of a part, cut at the midpoint of its longest edge; of equally long ones, the first.
template <int k, int dim>
std::array<fem::Part<k>, 2> halves(const fem::Part<k>& part, const SimplexMap<k, dim>& map)
{
  int first = 0;
  int second = 1;
  double longest = 0;
  for (int i = 0; i <= k; ++i)
    for (int j = i + 1; j <= k; ++j)
    {
      const double length = (map.jacobian * (part[j] - part[i])).squaredNorm();
      if (length <= (1 + tie) * longest) continue;
      longest = length;
      first = i;
      second = j;
    }
  return fem::split<k>(part, first, second, (part[first] + part[second]) / 2);
}

}  // namespace

template <int k, int dim, int n>
DatumMoments<k, dim, n>::DatumMoments(int p, int projected, int exact)
    : p_(p),
      n_projected_(fem::polynomial_dimension(k, projected)),
      rule_(fem::quadrature<k>(exact)),
      n_theta_(fem::polynomial_dimension(k, p + 1)),
      theta_(static_cast<std::size_t>(n_theta_) * rule_.size())
{
  for (int q = 0; q < rule_.size(); ++q)
    fem::orthonormal_values<k>(p + 1, rule_.points[q],
                               std::span(theta_).subspan(static_cast<std::size_t>(q) * n_theta_, n_theta_));
}

template <int k, int dim, int n>
auto DatumMoments<k, dim, n>::cut_at_switches(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map,
                                              int max_parts) const -> Parts
{
  std::vector<fem::Part<k>> parts{ordered_simplex(map)};
  for (const auto& term : datum.terms)
    for (const problem::Affine& a : term.value->switches())
    {
      if (static_cast<int>(parts.size()) >= max_parts) break;  // parts that are not cut are enclosed
      std::vector<fem::Part<k>> finer;
      for (const fem::Part<k>& part : parts)
      {
        std::array<double, k + 1> values;
        double size = std::abs(a.b);
        for (int i = 0; i <= k; ++i)
        {
          const Point<dim> x = map(part[i]);
          values[i] = a.b;
          for (int d = 0; d < dim; ++d)
          {
            values[i] += a.a[d] * x[d];
            size = std::max(size, std::abs(a.a[d] * x[d]));
          }
        }
        fem::cut<k>(part, values, rounding * size, finer);
      }
      parts = std::move(finer);
    }
  Parts result;
  for (const fem::Part<k>& part : parts) result.push_back({part, {}, {}, {}});
  return result;
}

/// Sets the remainders of the part.
template <int k, int dim, int n>
void DatumMoments<k, dim, n>::enclose(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map,
                                      DatumPart<k, n>& part) const
{
  // Less than the degree of the rule: moments against affine weights are integrated as well.
  const int order = std::min(fem::data_quadrature_degree(p_), problem::Formula::max_order);
  std::array<problem::Enclosure, problem::Formula::max_order + 1> storage;
  const auto taylor = std::span(storage).first(order + 1);
  const std::array<double, (k + 1)* dim> vertices = corner_coordinates(map, part.part);
  part.remainder.setZero();
  part.mean_remainder.setZero();
  for (const auto& [value, direction] : datum.terms)
  {
    if (value->degree() <= p_ + 2 || !value->is_enclosed()) continue;
    value->enclose(vertices, dim, taylor);
    const double remainder = problem::distance_from_polynomials(taylor, p_ + 3);
    const double mean_remainder = problem::distance_from_polynomials(taylor, order);
    for (int d = 0; d < n; ++d)
    {
      if (direction[d] == 0) continue;
      part.remainder[d] += remainder * std::abs(direction[d]);
      part.mean_remainder[d] += mean_remainder * std::abs(direction[d]);
    }
  }
}

/// Throws for a term that is not seen to be bounded on a part.
template <int k, int dim, int n>
void DatumMoments<k, dim, n>::require_bounds(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map,
                                             const Parts& parts) const
{
  const auto is_bounded = [](const DatumPart<k, n>& part) { return part.remainder.allFinite(); };
  const auto found = std::ranges::find_if_not(parts, is_bounded);
  if (found == parts.end()) return;
  const Point<dim> x = map(fem::point_in<k>(found->part, Point<k>::Constant(1.0 / (k + 1))));
  for (const auto& term : datum.terms)
  {
    DatumPart<k, n> part = *found;
    enclose({{term}}, map, part);
    if (!is_bounded(part))
      throw InputError(
          term.value->where(),
          fmt::format("may be unbounded near the point ({:.6g})", fmt::join(x.data(), x.data() + dim, ", ")),
          "bound it, such as 1/max(x, 1e-12) for 1/x; if it is bounded, rewrite it so that interval "
          "arithmetic can show this, such as 1/((x - 0.5)^2 + 0.01) for 1/(x^2 - x + 0.26)");
  }
}

/// Halves the parts that leave out most.
template <int k, int dim, int n>
void DatumMoments<k, dim, n>::refine(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map,
                                     const DatumWeights& weights, double allowed, int max_parts,
                                     Parts& parts) const
{
  const auto costs = [&](const DatumPart<k, n>& part)
  {
    const double measure = measure_of(part, map);
    return std::pair(weights.remainder * 2 * part.remainder.norm() * std::sqrt(measure),
                     weights.mean > 0 ? weights.mean * 2 * part.mean_remainder.norm() * measure : 0.0);
  };
  // Smaller parts, at the branch points of roots or at poles, are only rounding.
  const auto is_small = [](const DatumPart<k, n>& part)
  { return fem::fraction<k>(part.part) < std::pow(smallest_edge, k); };
  const auto is_unbounded = [](const DatumPart<k, n>& part) { return !part.remainder.allFinite(); };
  while (static_cast<int>(parts.size()) <
         (std::ranges::any_of(parts, is_unbounded) ? most_unbounded_parts : max_parts))
  {
    double squares = 0;
    double means = 0;
    double largest = 0;
    for (const auto& part : parts)
    {
      const auto [remainder, mean] = costs(part);
      squares += remainder * remainder;
      means += mean;
      if (!is_small(part)) largest = std::max({largest, remainder, mean});
    }
    if (std::sqrt(squares) + means <= allowed || largest == 0) return;
    Parts finer;
    for (DatumPart<k, n>& part : parts)
    {
      const auto [remainder, mean] = costs(part);
      if (is_small(part) || std::max(remainder, mean) < (1 - tie) * largest / 4)
      {
        finer.push_back(std::move(part));
        continue;
      }
      for (const fem::Part<k>& half : halves<k, dim>(part.part, map))
        enclose(datum, map, finer.emplace_back(DatumPart<k, n>{half, {}, {}, {}}));
    }
    parts = std::move(finer);
  }
}

template <int k, int dim, int n>
std::vector<Point<n>> DatumMoments<k, dim, n>::moments(const Parts& parts) const
{
  std::vector<Point<n>> result(n_theta_, Point<n>::Zero());
  std::vector<double> at_point(n_theta_);
  for (const auto& part : parts)
    for (int q = 0; q < rule_.size(); ++q)
    {
      std::span<const double> theta = at_point;
      if (parts.size() == 1)
        theta = std::span(theta_).subspan(static_cast<std::size_t>(q) * n_theta_, n_theta_);
      else
        fem::orthonormal_values<k>(p_ + 1, fem::point_in<k>(part.part, rule_.points[q]), at_point);
      const Point<n> weighted = fem::fraction<k>(part.part) * rule_.weights[q] * part.values[q];
      for (int j = 0; j < n_theta_; ++j) result[j] += theta[j] * weighted;
    }
  return result;
}

/// ||f - Pi f|| by the rules on the parts, and (sum_K (2 delta |K|^{1/2})^2)^{1/2} for what the rules miss.
template <int k, int dim, int n>
double DatumMoments<k, dim, n>::oscillation(const Parts& parts, std::span<const Point<n>> moments,
                                            double measure) const
{
  double squares = 0;  // on the reference simplex
  double missed = 0;
  for (const auto& part : parts)
  {
    missed += 4 * part.remainder.squaredNorm() * measure * fem::fraction<k>(part.part);
    for (int q = 0; q < rule_.size(); ++q)
    {
      Point<n> difference = part.values[q];
      if (parts.size() == 1)
        for (int j = 0; j < n_projected_; ++j) difference -= theta_[q * n_theta_ + j] * moments[j];
      squares += fem::fraction<k>(part.part) * rule_.weights[q] * difference.squaredNorm();
    }
  }
  if (parts.size() > 1)  // the rules on the parts are exact for products of the basis: ||f||^2 - ||Pi f||^2
  {
    // Sums of n terms; the error in each of the squares is at most n epsilon.
    const double n_terms = static_cast<double>(parts.size()) * rule_.size();
    const double cancellation = std::max(1e-14, std::numeric_limits<double>::epsilon() * n_terms);
    const double all = squares;
    for (int j = 0; j < n_projected_; ++j) squares -= moments[j].squaredNorm();
    squares = std::max(squares, 0.0) + cancellation * all;
  }
  return std::sqrt(factorial<k> * measure * squares) + std::sqrt(missed);
}

template <int k, int dim, int n>
DatumOnSimplex<k, n> DatumMoments<k, dim, n>::operator()(const Datum<dim, n>& datum,
                                                         const SimplexMap<k, dim>& map,
                                                         const DatumWeights& weights, double allowed,
                                                         int max_parts) const
{
  DatumOnSimplex<k, n> result;
  Parts& parts = result.parts;
  std::vector<Point<dim>> points(rule_.points.size());
  std::ranges::transform(rule_.points, points.begin(), map);
  std::vector<Point<n>> on_whole = datum(points);  // evaluated first: an undefined formula shows here
  parts = cut_at_switches(datum, map, max_parts);
  for (auto& part : parts) enclose(datum, map, part);
  refine(datum, map, weights, allowed, max_parts, parts);
  require_bounds(datum, map, parts);
  if (parts.size() == 1)
    parts.front().values = std::move(on_whole);
  else
    for (auto& part : parts)
    {
      std::ranges::transform(rule_.points, points.begin(),
                             [&](const Point<k>& s) { return map(fem::point_in<k>(part.part, s)); });
      part.values = datum(points);
    }
  Point<n> missed = Point<n>::Zero();
  for (const auto& part : parts) missed += 2 * measure_of(part, map) * part.mean_remainder;
  result.mean = missed.norm();
  result.moments = moments(parts);
  result.oscillation = oscillation(parts, result.moments, map.measure);
  return result;
}

template <int k, int dim, int n>
void DatumMoments<k, dim, n>::evaluate(std::span<const Point<n>> moments, std::span<Point<n>> values) const
{
  for (int q = 0; q < rule_.size(); ++q)
  {
    values[q].setZero();
    for (int j = 0; j < n_theta_; ++j) values[q] += theta_[q * n_theta_ + j] * moments[j];
  }
}

template <int k, int dim, int n>
Point<n> DatumMoments<k, dim, n>::evaluate(std::span<const Point<n>> moments, const Point<k>& s) const
{
  std::vector<double> theta(n_theta_);
  fem::orthonormal_values<k>(p_ + 1, s, theta);
  Point<n> value = Point<n>::Zero();
  for (std::size_t j = 0; j < moments.size(); ++j) value += theta[j] * moments[j];
  return value;
}

template class DatumMoments<1, 2>;
template class DatumMoments<1, 2, 3>;
template class DatumMoments<2, 2>;
template class DatumMoments<2, 2, 1>;
template class DatumMoments<2, 2, 3>;
template class DatumMoments<2, 3>;
template class DatumMoments<3, 3>;
template class DatumMoments<3, 3, 1>;
template class DatumMoments<3, 3, 6>;

}  // namespace tribound::contact
