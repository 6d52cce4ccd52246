#include "tribound/mesh/quadratic_piece.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tribound::mesh
{

namespace
{

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Of barycentric coordinates.
constexpr double end_of_steps = 16 * epsilon;

/// The zero in [0, 1] of an increasing cubic, given by its Bernstein coefficients; an end if there is none
/// inside. Newton's method between brackets.
double zero_of_increasing(const std::array<double, 4>& b)
{
  if (!(b[0] < 0)) return 0;
  if (!(b[3] > 0)) return 1;
  constexpr int most_steps = 100;
  double lower = 0;
  double upper = 1;
  double t = b[0] / (b[0] - b[3]);
  for (int step = 0; step < most_steps; ++step)
  {
    const auto mean = [t](double from, double to) { return (1 - t) * from + t * to; };
    const std::array<double, 3> first = {mean(b[0], b[1]), mean(b[1], b[2]), mean(b[2], b[3])};
    const std::array<double, 2> second = {mean(first[0], first[1]), mean(first[1], first[2])};
    const double value = mean(second[0], second[1]);
    if (value == 0) break;
    (value < 0 ? lower : upper) = t;
    double next = t - value / (3 * (second[1] - second[0]));
    if (!(next > lower && next < upper)) next = (lower + upper) / 2;
    const bool has_settled = std::abs(next - t) <= end_of_steps;
    t = next;
    if (has_settled) break;
  }
  return t;
}

/// Numbers of coefficients by their four corners: the same in every order of them.
template <int dim>
constexpr auto numbers = []
{
  std::array<std::array<std::array<std::array<int, dim>, dim>, dim>, dim> result{};
  int next = 0;
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j)
      for (int k = j; k < dim; ++k)
        for (int l = k; l < dim; ++l, ++next)
        {
          std::array<int, 4> corners{i, j, k, l};
          do result[corners[0]][corners[1]][corners[2]][corners[3]] = next;
          while (std::ranges::next_permutation(corners).found);
        }
  return result;
}();

/// The barycentric coordinates of corner i.
template <int dim>
std::array<double, dim> unit(int i)
{
  std::array<double, dim> l{};
  l[i] = 1;
  return l;
}

}  // namespace

template <int dim>
QuadraticPiece<dim>::QuadraticPiece(const std::array<Point<dim>, n_facet_nodes<dim>>& nodes,
                                    const Point<dim>& x)
{
  for (int i = 0; i < dim; ++i)
  {
    corners[i] = unit<dim>(i);
    control[i][i] = nodes[i] - x;
  }
  constexpr auto& edges = local_edges<dim - 1>;
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const auto [i, j] = edges[e];
    control[i][j] = control[j][i] = 2 * (nodes[dim + e] - x) - (control[i][i] + control[j][j]) / 2;
  }
  find_coefficients();
}

template <int dim>
Point<dim> QuadraticPiece<dim>::polar(const Barycentric& l, const Barycentric& m) const
{
  Point<dim> sum = Point<dim>::Zero();
  for (int i = 0; i < dim; ++i)
  {
    sum += l[i] * m[i] * control[i][i];
    for (int j = 0; j < i; ++j) sum += (l[i] * m[j] + l[j] * m[i]) * control[i][j];
  }
  return sum;
}

template <int dim>
auto QuadraticPiece<dim>::place(const Barycentric& l) const -> Barycentric
{
  Barycentric result{};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) result[j] += l[i] * corners[i][j];
  return result;
}

/// |D|^2 is the product of D with itself, made symmetric.
template <int dim>
void QuadraticPiece<dim>::find_coefficients()
{
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j)
      for (int k = j; k < dim; ++k)
        for (int l = k; l < dim; ++l)
          coefficients_[numbers<dim>[i][j][k][l]] =
              (control[i][j].dot(control[k][l]) + control[i][k].dot(control[j][l]) +
               control[i][l].dot(control[j][k])) /
              3;
}

template <int dim>
double QuadraticPiece<dim>::coefficient(int i, int j, int k, int l) const
{
  return coefficients_[numbers<dim>[i][j][k][l]];
}

template <int dim>
BoundingBox<dim> QuadraticPiece<dim>::box() const
{
  BoundingBox<dim> box;
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j) box.add(control[i][j]);
  return box;
}

template <int dim>
double QuadraticPiece<dim>::lower_bound() const
{
  return std::ranges::min(coefficients_);
}

// Up to a factor the Hessian along the edges from corner 0 has the coefficients
// H_kl[a][b] = c_abkl - c_a0kl - c_0bkl + c_00kl, c those of |D|^2.
template <int dim>
bool QuadraticPiece<dim>::is_convex() const
{
  for (int k = 0; k < dim; ++k)
    for (int l = k; l < dim; ++l)
    {
      const auto second = [&](int a, int b)
      {
        return coefficient(a, b, k, l) - coefficient(a, 0, k, l) - coefficient(0, b, k, l) +
               coefficient(0, 0, k, l);
      };
      const double first = second(1, 1);
      if (!(first >= 0)) return false;
      if constexpr (dim == 3)
      {
        const double last = second(2, 2);
        const double mixed = second(1, 2);
        if (!(last >= 0 && first * last >= mixed * mixed)) return false;
      }
    }
  return true;
}

template <int dim>
double QuadraticPiece<dim>::minimiser_on_edge(int from, int to) const
{
  std::array<double, 5> c;
  for (int k = 0; k < 5; ++k)
  {
    const auto corner = [&](int position) { return position < k ? to : from; };
    c[k] = coefficient(corner(0), corner(1), corner(2), corner(3));
  }
  return zero_of_increasing({c[1] - c[0], c[2] - c[1], c[3] - c[2], c[4] - c[3]});
}

template <int dim>
auto QuadraticPiece<dim>::tangents(const Barycentric& l) const -> std::array<Point<dim>, dim - 1>
{
  const auto along = [&](int corner)  // D(l, the corner)
  {
    Point<dim> sum = l[0] * control[0][corner];
    for (int i = 1; i < dim; ++i) sum += l[i] * control[i][corner];
    return sum;
  };
  std::array<Point<dim>, dim - 1> result;
  for (int a = 1; a < dim; ++a) result[a - 1] = 2 * (along(a) - along(0));
  return result;
}

/// Newton's method on a convex function that is smaller inside than on the boundary, damped so that it
/// descends and stays inside.
template <int dim>
auto QuadraticPiece<dim>::minimiser_inside() const -> Barycentric
{
  constexpr int most_steps = 100;
  constexpr int most_halvings = 50;
  Barycentric l;
  l.fill(1.0 / dim);
  for (int step = 0; step < most_steps; ++step)
  {
    const Point<dim> d = polar(l, l);
    const auto t = tangents(l);
    Point<dim - 1> gradient;
    Tensor<dim - 1> hessian;
    for (int a = 0; a < dim - 1; ++a)
    {
      gradient[a] = d.dot(t[a]);
      for (int b = 0; b < dim - 1; ++b)
      {
        const Point<dim> second =
            control[a + 1][b + 1] - control[a + 1][0] - control[0][b + 1] + control[0][0];
        hessian(a, b) = t[a].dot(t[b]) + 2 * d.dot(second);
      }
    }
    const Point<dim - 1> change = -hessian.inverse() * gradient;
    const auto at = [&](double length)
    {
      Barycentric moved = l;
      moved[0] -= length * change.sum();
      for (int a = 1; a < dim; ++a) moved[a] += length * change[a - 1];
      return moved;
    };
    double length = 1;
    Barycentric next = at(length);
    const auto is_inside = [&] { return std::ranges::all_of(next, [](double value) { return value > 0; }); };
    // The gain of the last step is within rounding errors.
    if (-change.dot(gradient) <= epsilon * d.squaredNorm() || change.norm() <= end_of_steps)
      return is_inside() ? next : l;
    for (int halving = 0; !(is_inside() && polar(next, next).squaredNorm() < d.squaredNorm()); ++halving)
    {
      if (halving == most_halvings) return l;
      next = at(length /= 2);
    }
    l = next;
  }
  return l;
}

// Convex: the least value on the edges is that of the part, unless the function decreases from there to the
// inside.
template <int dim>
auto QuadraticPiece<dim>::minimiser() const -> Barycentric
{
  Barycentric best{};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [i, j] : local_edges<dim - 1>)
  {
    const double t = minimiser_on_edge(i, j);
    Barycentric l{};
    l[i] = 1 - t;
    l[j] = t;
    const double square = polar(l, l).squaredNorm();
    if (square < least)
    {
      least = square;
      best = l;
    }
  }
  if constexpr (dim == 3)
  {
    const Point<dim> d = polar(best, best);
    const auto slope = [&](int towards) { return d.dot(polar(best, unit<dim>(towards)) - d); };
    for (int i = 0; i < dim; ++i)
      if (best[i] == 0 && slope(i) < 0) return minimiser_inside();
  }
  return best;
}

template <int dim>
QuadraticPiece<dim> QuadraticPiece<dim>::child(const std::array<Barycentric, dim>& vertices) const
{
  QuadraticPiece result;
  for (int i = 0; i < dim; ++i)
  {
    result.corners[i] = place(vertices[i]);
    for (int j = i; j < dim; ++j)
      result.control[i][j] = result.control[j][i] = polar(vertices[i], vertices[j]);
  }
  result.find_coefficients();
  return result;
}

template <int dim>
auto QuadraticPiece<dim>::children() const -> std::array<QuadraticPiece, n_children>
{
  const auto middle = [](int i, int j)
  {
    Barycentric l{};
    l[i] = l[j] = 0.5;
    return l;
  };
  const auto corner = [](int i) { return unit<dim>(i); };
  if constexpr (dim == 2)
    return {child({corner(0), middle(0, 1)}), child({middle(0, 1), corner(1)})};
  else
    return {child({corner(0), middle(0, 1), middle(0, 2)}), child({middle(0, 1), corner(1), middle(1, 2)}),
            child({middle(0, 2), middle(1, 2), corner(2)}),
            child({middle(0, 1), middle(1, 2), middle(0, 2)})};
}

template struct QuadraticPiece<2>;
template struct QuadraticPiece<3>;

}  // namespace tribound::mesh
