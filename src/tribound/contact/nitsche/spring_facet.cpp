#include "tribound/contact/nitsche/spring_facet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "tribound/base/error.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/formula.h"

namespace tribound::contact
{

namespace
{

/// Largest value and distances of a field on a facet, upper bounds.
struct FieldRange
{
  double most = 0;
  double from_low = 0;   ///< from P^low
  double from_high = 0;  ///< from P^{p+2}
};

template <int dim>
using FacetVertices = std::array<Point<dim>, dim>;

/// What the field does on a simplex: a range of values, and Taylor coefficients up to the order.
template <int dim>
void enclose(const problem::Field& field, const FacetVertices<dim>& vertices,
             std::span<problem::Enclosure> taylor)
{
  field.enclose(flat_coordinates(vertices), dim, taylor);
}

/// The values of the field on a simplex, which is halved where one enclosure of all of it is unbounded.
template <int dim>
problem::Enclosure values_on(const problem::Field& field, const FacetVertices<dim>& vertices, int halvings)
{
  std::array<problem::Enclosure, 1> taylor;
  enclose<dim>(field, vertices, taylor);
  if (std::isfinite(taylor[0].magnitude()) || halvings == 0) return taylor[0];
  std::array<int, 2> longest{0, 1};
  const auto length = [&](int i, int j) { return (vertices[i] - vertices[j]).norm(); };
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < i; ++j)
      if (length(i, j) > length(longest[0], longest[1])) longest = {i, j};
  const Point<dim> middle = (vertices[longest[0]] + vertices[longest[1]]) / 2;
  problem::Enclosure all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const int replaced : longest)
  {
    FacetVertices<dim> half = vertices;
    half[replaced] = middle;
    const problem::Enclosure of_half = values_on<dim>(field, half, halvings - 1);
    all = {std::min(all.lower, of_half.lower), std::max(all.upper, of_half.upper)};
  }
  return all;
}

/// The largest coefficient of a quadratic function in Bernstein's basis on a simplex, >= its largest value.
template <int dim>
double largest_coefficient(const problem::Field& field, const FacetVertices<dim>& vertices)
{
  double largest = 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j <= i; ++j)
    {
      const double half = field(Point<dim>((vertices[i] + vertices[j]) / 2));
      largest = std::max(largest, std::abs(2 * half - (field(vertices[i]) + field(vertices[j])) / 2));
    }
  return largest;
}

/// A field that is known only at points counts as a polynomial; DataEffort::unenclosed tells where that is
/// more than is known.
template <int dim>
FieldRange range_of(const problem::Field& field, const FacetVertices<dim>& vertices, int low, int high)
{
  constexpr int most_halvings = 12;
  if (!field.is_enclosed()) return {.most = largest_coefficient<dim>(field, vertices)};
  std::array<problem::Enclosure, problem::Formula::max_order + 1> storage;
  const auto taylor = std::span(storage).first(high + 2);
  enclose<dim>(field, vertices, taylor);
  if (!std::isfinite(taylor[0].magnitude()))
  {
    std::ranges::fill(taylor, problem::Enclosure{-std::numeric_limits<double>::infinity(),
                                                 std::numeric_limits<double>::infinity()});
    taylor[0] = values_on<dim>(field, vertices, most_halvings);
  }
  if (!std::isfinite(taylor[0].magnitude()))
    throw InputError(
        field.where(),
        fmt::format("may be unbounded near the point ({:.6g})", fmt::join(vertices.front(), ", ")),
        "bound it, such as 1/max(x, 1e-12) for 1/x");
  FieldRange result{.most = taylor[0].magnitude()};
  if (field.degree() > low) result.from_low = problem::distance_from_polynomials(taylor, low + 1);
  if (field.degree() > high) result.from_high = problem::distance_from_polynomials(taylor, high + 1);
  return result;
}

/// The least value of a quadratic function on a segment from 0 to 1, from its values at 0, 1/2 and 1.
double least_on_segment(double at_0, double at_half, double at_1)
{
  const double slope = 4 * at_half - 3 * at_0 - at_1;
  const double curvature = 4 * (at_0 + at_1 - 2 * at_half);
  const double ends = std::min(at_0, at_1);
  return slope < 0 && slope + curvature > 0 ? std::min(ends, at_0 - slope * slope / (2 * curvature)) : ends;
}

/// A quadratic function on a facet, known from its values inside: there a formula that jumps between facets
/// has one branch.
template <int dim>
class QuadraticOnFacet
{
 public:
  QuadraticOnFacet(const problem::Field& field, const FacetVertices<dim>& vertices)
  {
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j <= i; ++j)
      {
        Barycentric lambda = Barycentric::Constant((1 - shrunk) / dim);
        lambda[i] += shrunk / 2;
        lambda[j] += shrunk / 2;
        Point<dim> x = Point<dim>::Zero();
        for (int k = 0; k < dim; ++k) x += lambda[k] * vertices[k];
        values_(i, j) = values_(j, i) = field(x);
      }
  }

  /// Its value in the middle of vertices i and j, by Lagrange's basis of the points inside.
  [[nodiscard]] double between(int i, int j) const
  {
    Barycentric lambda = Barycentric::Constant((1 - 1 / shrunk) / dim);
    lambda[i] += 1 / (2 * shrunk);
    lambda[j] += 1 / (2 * shrunk);
    double sum = 0;
    for (int k = 0; k < dim; ++k)
      for (int l = 0; l <= k; ++l)
        sum += values_(k, l) * (k == l ? lambda[k] * (2 * lambda[k] - 1) : 4 * lambda[k] * lambda[l]);
    return sum;
  }

 private:
  using Barycentric = Eigen::Matrix<double, dim, 1>;
  static constexpr double shrunk = 0.5;  // the simplex of these points, over the facet
  Eigen::Matrix<double, dim, dim> values_;
};

/// The least value of a quadratic function on a facet, up to rounding: at a vertex, on an edge, or where its
/// gradient vanishes inside. (If that is so on a line, the line meets an edge.)
template <int dim>
double least_of_quadratic(const problem::Field& field, const FacetVertices<dim>& vertices)
{
  const QuadraticOnFacet<dim> quadratic(field, vertices);
  const auto between = [&](int i, int j) { return quadratic.between(i, j); };
  std::array<double, dim> at;
  for (int i = 0; i < dim; ++i) at[i] = between(i, i);
  double least = least_on_segment(at[0], between(0, 1), at[1]);
  if constexpr (dim == 3)
  {
    const std::array<double, 3> half{between(0, 1), between(0, 2), between(1, 2)};
    least =
        std::min({least, least_on_segment(at[0], half[1], at[2]), least_on_segment(at[1], half[2], at[2])});
    const Eigen::Vector2d slope(4 * half[0] - 3 * at[0] - at[1], 4 * half[1] - 3 * at[0] - at[2]);
    Eigen::Matrix2d hessian;
    hessian(0, 0) = 4 * (at[0] + at[1] - 2 * half[0]);
    hessian(1, 1) = 4 * (at[0] + at[2] - 2 * half[1]);
    hessian(0, 1) = hessian(1, 0) = 4 * (at[0] + half[2] - half[0] - half[1]);
    if (hessian(0, 0) > 0 && hessian.determinant() > 0)
      if (const Eigen::Vector2d x = -(hessian.inverse() * slope); x.minCoeff() >= 0 && x.sum() <= 1)
        least = std::min(least, at[0] + slope.dot(x) / 2);
  }
  return least;
}

}  // namespace

template <int dim>
SpringFacet<dim> spring_facet(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                              std::size_t number, int degree, const fem::Quadrature<dim - 1>& rule)
{
  constexpr double rounding = 1e-12;  // of K, relative to its largest value
  const mesh::BoundaryFacet& on = mesh.boundary()[number];
  const problem::BoundaryCondition<dim>& boundary = problem.boundary(on.tag);
  const problem::Spring<dim>& spring = *boundary.spring;
  const Point<dim> normal = mesh::facet_geometry(mesh, on.cell, on.local).normal;
  const SimplexMap<dim - 1, dim> map = simplex_map(mesh, on);
  FacetVertices<dim> vertices;
  for (int i = 0; i < dim; ++i) vertices[i] = map(fem::reference_simplex<dim - 1>()[i]);
  const int of_stiffness = spring.stiffness_degree();
  const int of_rest = degree + 2 - of_stiffness;
  SpringFacet<dim> result{.number = number,
                          .cell = on.cell,
                          .local = on.local,
                          .measure = map.measure,
                          .is_resolved = of_stiffness == 0};
  for (const problem::Field* field : {&spring.normal, &spring.tangential})
  {
    const FieldRange range = range_of<dim>(*field, vertices, problem::most_of_stiffness, degree + 2);
    SpringDatum<Tensor<dim>>& datum = result.stiffness;
    result.most = std::max(result.most, range.most);
    datum.remainder = std::max(datum.remainder, range.from_low);
    datum.mean_remainder = std::max(datum.mean_remainder, range.from_high);
    const bool is_polynomial =
        field->degree() <= problem::most_of_stiffness || (field->is_enclosed() && range.from_low == 0);
    datum.is_polynomial = datum.is_polynomial && is_polynomial;
    if (is_polynomial)
      result.is_nonnegative =
          result.is_nonnegative && least_of_quadratic<dim>(*field, vertices) >= -rounding * range.most;
  }
  for (const problem::Field& field : spring.rest)
  {
    const FieldRange range = range_of<dim>(field, vertices, of_rest, degree + 2);
    result.rest.remainder = std::hypot(result.rest.remainder, range.from_low);
    result.rest.mean_remainder = std::hypot(result.rest.mean_remainder, range.from_high);
    result.rest.is_polynomial = result.rest.is_polynomial &&
                                (field.degree() <= of_rest || (field.is_enclosed() && range.from_low == 0));
    result.is_resolved = result.is_resolved && field.degree() <= degree;
  }
  for (int q = 0; q < rule.size(); ++q)
  {
    const Point<dim> x = map(rule.points[q]);
    result.weights.push_back(map.measure * rule.weights[q] * mesh::factorial<dim - 1> * problem.weight(x));
    result.stiffness.values.push_back(boundary.on_free(spring.stiffness(x, normal)));
    Point<dim>& rest = result.rest.values.emplace_back();
    for (int a = 0; a < dim; ++a) rest[a] = spring.rest[a](x);
  }
  return result;
}

template SpringFacet<2> spring_facet(const problem::Problem<2>&, const mesh::Mesh<2>&, std::size_t, int,
                                     const fem::Quadrature<1>&);
template SpringFacet<3> spring_facet(const problem::Problem<3>&, const mesh::Mesh<3>&, std::size_t, int,
                                     const fem::Quadrature<2>&);

}  // namespace tribound::contact
