#include "tribound/certify/bound/transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/certify/bound/constants.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

constexpr int largest_exponent = 64;

/// sum_i c_i theta_i(s).
template <int dim>
Point<dim> value(int degree, std::span<const Point<dim>> coefficients, const Point<dim - 1>& s,
                 std::vector<double>& theta)
{
  fem::orthonormal_values<dim - 1>(degree, s, theta);
  Point<dim> sum = Point<dim>::Zero();
  for (std::size_t i = 0; i < coefficients.size(); ++i) sum += theta[i] * coefficients[i];
  return sum;
}

/// F in its cell, and Pi_F q.
template <int dim>
class Facet
{
 public:
  Facet(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
        std::span<const TractionPiece<dim>> pieces)
      : degree_(degree),
        theta_(fem::polynomial_dimension(dim - 1, degree)),
        map_(mesh::facet_map(mesh, facet.cell, facet.local)),
        geometry_(mesh::facet_geometry(mesh, facet.cell, facet.local))
  {
    const Point<dim> apex = mesh.vertices()[mesh.cell(facet.cell)[facet.local]];
    height_ = geometry_.normal.dot(map_.origin - apex);
    foot_ = apex + height_ * geometry_.normal;
    project(pieces);
  }

  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] double det() const { return geometry_.det(); }
  [[nodiscard]] double diameter() const { return geometry_.diameter; }
  [[nodiscard]] const Point<dim>& normal() const { return geometry_.normal; }
  /// Along the first edge.
  [[nodiscard]] Point<dim> tangent() const { return map_.jacobian.col(0).normalized(); }
  /// xi - a_F.
  [[nodiscard]] Point<dim> from_foot(const Point<dim - 1>& s) const { return map_(s) - foot_; }
  /// Of a piece, by its own coordinates.
  [[nodiscard]] Point<dim> traction(const TractionPiece<dim>& piece, const Point<dim - 1>& s)
  {
    return value<dim>(degree_, piece.coefficients, s, theta_);
  }
  /// Pi_F q.
  [[nodiscard]] Point<dim> projected(const Point<dim - 1>& s)
  {
    return value<dim>(degree_, projection_, s, theta_);
  }

 private:
  void project(std::span<const TractionPiece<dim>> pieces)
  {
    projection_.assign(theta_.size(), Point<dim>::Zero());
    const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * degree_);
    for (const TractionPiece<dim>& piece : pieces)
    {
      const double share = fem::fraction<dim - 1>(piece.part);
      for (int q = 0; q < rule.size(); ++q)
      {
        const Point<dim> t = traction(piece, rule.points[q]);
        fem::orthonormal_values<dim - 1>(degree_, fem::point_in<dim - 1>(piece.part, rule.points[q]), theta_);
        for (std::size_t i = 0; i < theta_.size(); ++i)
          projection_[i] += share * rule.weights[q] * theta_[i] * t;
      }
    }
  }

  int degree_;
  std::vector<double> theta_;  ///< working space
  mesh::FacetMap<dim> map_;
  mesh::FacetGeometry<dim> geometry_;
  double height_;
  Point<dim> foot_;
  std::vector<Point<dim>> projection_;
};

/// The m with the smallest square(m).
template <class Square>
int best_exponent(const Square& square)
{
  int best = 1;
  double smallest = square(1);
  for (int m = 2; m <= largest_exponent; ++m)
    if (const double value = square(m); value < smallest)
    {
      smallest = value;
      best = m;
    }
  return best;
}

/// The ends of all parts between those of the facet.
std::vector<double> ends_of(std::span<const TractionPiece<2>> pieces)
{
  std::vector<double> ends = {0, 1};
  for (const TractionPiece<2>& piece : pieces)
    for (const Point<1>& end : piece.part) ends.push_back(std::clamp(end[0], 0.0, 1.0));
  std::ranges::sort(ends);
  return ends;
}

/// q at s, in the interval with the given middle, on which it is one polynomial.
Point<2> sum_of_tractions(Facet<2>& facet, std::span<const TractionPiece<2>> pieces, double middle, double s)
{
  Point<2> sum = Point<2>::Zero();
  for (const TractionPiece<2>& piece : pieces)
  {
    const double first = piece.part[0][0];
    const double length = piece.part[1][0] - first;
    const double place = (middle - first) / length;
    if (place > 0 && place < 1) sum += facet.traction(piece, Point<1>((s - first) / length));
  }
  return sum;
}

/// r and R = int r, from the first end of F on, at a point of a rule.
struct Loss
{
  double s;       ///< on the reference facet
  double weight;  ///< with the length of the facet
  double x;       ///< xi - a_F along the tangent
  Point<2> r;
  Point<2> rho;
};

std::vector<Loss> losses(Facet<2>& facet, int degree, std::span<const TractionPiece<2>> pieces)
{
  const fem::Quadrature<1> rule = fem::quadrature<1>(2 * degree + 2);
  const std::vector<double> ends = ends_of(pieces);
  std::vector<Loss> result;
  Point<2> at_first = Point<2>::Zero();
  for (std::size_t k = 0; k + 1 < ends.size(); ++k)
  {
    const double first = ends[k];
    const double length = ends[k + 1] - first;
    const auto r = [&](double s) -> Point<2>
    { return sum_of_tractions(facet, pieces, first + length / 2, s) - facet.projected(Point<1>(s)); };
    const auto integral = [&](double to)
    {
      Point<2> sum = Point<2>::Zero();
      for (int q = 0; q < rule.size(); ++q)
        sum += rule.weights[q] * (to - first) * facet.det() * r(first + (to - first) * rule.points[q][0]);
      return sum;
    };
    for (int q = 0; q < rule.size(); ++q)
    {
      const double s = first + length * rule.points[q][0];
      const double x = facet.tangent().dot(facet.from_foot(Point<1>(s)));
      result.push_back({s, length * facet.det() * rule.weights[q], x, r(s), at_first + integral(s)});
    }
    at_first += integral(ends[k + 1]);
  }
  return result;
}

/// ||tau||^2 for m.
double square(const Facet<2>& facet, std::span<const Loss> losses, int m)
{
  const double h = facet.height();
  double sum = 0;
  for (const auto& [s, weight, x, r, rho] : losses)
    sum += weight * (h * r.squaredNorm() + (x * r - m * rho).squaredNorm() / h);
  return sum / (2 * m);
}

/// (s, tau)_T = int_0^1 int_F H (1 - z)^m s : {r n^T + [(xi - a_F) r - m R] / H t^T}, t the tangent.
double inner_product(const Facet<2>& facet, int local, int degree, std::span<const Loss> losses,
                     const std::function<Tensor<2>(const Point<2>&)>& s, int m)
{
  const fem::Quadrature<1> rule = fem::quadrature<1>(degree + m);
  const Point<2> apex = fem::reference_simplex<2>()[local];
  double sum = 0;
  for (const auto& [at, weight, x, r, rho] : losses)
  {
    const Point<2> base = mesh::facet_to_cell<2>(local, Point<1>(at));
    const Tensor<2> tau =
        facet.height() * r * facet.normal().transpose() + (x * r - m * rho) * facet.tangent().transpose();
    for (int q = 0; q < rule.size(); ++q)
    {
      const double z = rule.points[q][0];
      sum += weight * rule.weights[q] * std::pow(1 - z, m) *
             s((1 - z) * base + z * apex).cwiseProduct(tau).sum();
    }
  }
  return sum;
}

/// int |r|^2 and int |xi - a_F|^2 |r|^2.
struct Squares
{
  double plain = 0;
  double weighted = 0;

  void add(double weight, const Point<3>& from_foot, const Point<3>& r)
  {
    plain += weight * r.squaredNorm();
    weighted += weight * from_foot.squaredNorm() * r.squaredNorm();
  }
};

double transfer_norm_3d(Facet<3>& facet, int degree, std::span<const TractionPiece<3>> pieces)
{
  constexpr double rounding = 1e-11;  // of what is covered
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * degree + 2);
  Squares sums;
  Squares rest;  // where nothing covers F, r = -Pi_F q: what the parts leave of the integrals over F
  double uncovered = 1;
  for (const TractionPiece<3>& piece : pieces)
  {
    const double share = fem::fraction<2>(piece.part);
    uncovered -= share;
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<2> s = fem::point_in<2>(piece.part, rule.points[q]);
      const double weight = share * facet.det() * rule.weights[q];
      const Point<3> projected = facet.projected(s);
      sums.add(weight, facet.from_foot(s), facet.traction(piece, rule.points[q]) - projected);
      rest.add(-weight, facet.from_foot(s), projected);
    }
  }
  if (uncovered > rounding)
  {
    for (int q = 0; q < rule.size(); ++q)
      rest.add(facet.det() * rule.weights[q], facet.from_foot(rule.points[q]),
               facet.projected(rule.points[q]));
    sums.plain += std::max(0.0, rest.plain);
    sums.weighted += std::max(0.0, rest.weighted);
  }
  const double h = facet.height();
  const double norm = std::sqrt(sums.plain);
  const double of_rho = poincare_constant(facet.diameter()) * norm;
  const auto square_of = [&](int m)
  { return h / (2 * m - 1) * (sums.plain + std::pow((std::sqrt(sums.weighted) + m * of_rho) / h, 2)); };
  return std::sqrt(square_of(best_exponent(square_of)));
}

}  // namespace

template <int dim>
double transfer_norm(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                     std::span<const TractionPiece<dim>> pieces)
{
  Facet<dim> in_cell(mesh, facet, degree, pieces);
  if constexpr (dim == 3) return transfer_norm_3d(in_cell, degree, pieces);
  if constexpr (dim == 2)
  {
    const std::vector<Loss> lost = losses(in_cell, degree, pieces);
    const auto square_of = [&](int m) { return square(in_cell, lost, m); };
    return std::sqrt(square_of(best_exponent(square_of)));
  }
}

double transfer_change(const mesh::Mesh<2>& mesh, const mesh::BoundaryFacet& facet, int degree,
                       std::span<const TractionPiece<2>> pieces,
                       const std::function<Tensor<2>(const Point<2>&)>& s)
{
  Facet<2> in_cell(mesh, facet, degree, pieces);
  const std::vector<Loss> lost = losses(in_cell, degree, pieces);
  const auto square_of = [&](int m) { return square(in_cell, lost, m); };
  const int best = best_exponent(square_of);
  double smallest = std::numeric_limits<double>::infinity();
  for (const int near : {1, best / 2, best, best + 1, 2 * best})
  {
    const int m = std::clamp(near, 1, largest_exponent);
    smallest = std::min(smallest, square_of(m) + 2 * inner_product(in_cell, facet.local, degree, lost, s, m));
  }
  return smallest;
}

template double transfer_norm(const mesh::Mesh<2>&, const mesh::BoundaryFacet&, int,
                              std::span<const TractionPiece<2>>);
template double transfer_norm(const mesh::Mesh<3>&, const mesh::BoundaryFacet&, int,
                              std::span<const TractionPiece<3>>);

}  // namespace tribound::certify
