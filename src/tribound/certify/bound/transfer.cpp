#include "tribound/certify/bound/transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/certify/bound/constants.h"
#include "tribound/certify/bound/transfer_losses.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

constexpr int largest_exponent = 64;

/// The m with the smallest square(m).
template <class Square>
int argmin(const Square& square)
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

/// int |r|^2 and int |xi - a_F|^2 |r|^2; int |Pi_F q|^2 over the covered part.
struct Squares
{
  double plain = 0;
  double weighted = 0;
  double carried = 0;

  void add(double weight, const Point<3>& from_foot, const Point<3>& r)
  {
    plain += weight * r.squaredNorm();
    weighted += weight * from_foot.squaredNorm() * r.squaredNorm();
  }
};

Squares squares(const LoadedFacet<3>& facet, std::span<const TractionPiece<3>> pieces)
{
  constexpr double rounding = 1e-11;  // of the covered part
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * facet.degree() + 2);
  Squares sums;
  Squares rest;  // where F is not covered, r = -Pi_F q: the integrals over F less those over the parts
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
      sums.carried += weight * projected.squaredNorm();
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
  return sums;
}

/// A bound of ||tau|| that needs no rho.
double closed_form(const LoadedFacet<3>& facet, const Squares& sums)
{
  const double h = facet.height();
  const double of_rho = poincare_constant_of_triangle(facet.diameter()) * std::sqrt(sums.plain);
  const auto square_of = [&](int m)
  { return h / (2 * m - 1) * (sums.plain + std::pow((std::sqrt(sums.weighted) + m * of_rho) / h, 2)); };
  return std::sqrt(square_of(argmin(square_of)));
}

}  // namespace

template <int dim>
TransferLifting<dim>::TransferLifting(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet,
                                      int degree, std::span<const TractionPiece<dim>> pieces)
    : local_(facet.local), degree_(degree)
{
  const LoadedFacet<dim> loaded(mesh, facet, degree, pieces);
  height_ = loaded.height();
  normal_ = loaded.normal();
  if constexpr (dim == 3)
  {
    constexpr double rounding = 1e-24;  // relative, in the squares, if nothing is lost
    const Squares sums = squares(loaded, pieces);
    norm_ = closed_form(loaded, sums);
    if (sums.plain <= rounding * sums.carried) return;
  }
  losses_ = transfer_losses(loaded, pieces);
  for (const auto& [at, weight, r, moved, rho] : losses_)
  {
    fixed_ += weight * (height_ * r.squaredNorm() + moved.squaredNorm() / height_);
    linear_ -= weight * 2 * moved.cwiseProduct(rho).sum() / height_;
    quadratic_ += weight * rho.squaredNorm() / height_;
  }
  if (!losses_.empty()) norm_ = std::sqrt(square(best_exponent()));
}

template <int dim>
int TransferLifting<dim>::best_exponent() const
{
  return argmin([&](int m) { return square(m); });
}

/// (s, tau)_T = int_0^1 (1 - z)^m g_m(z), g_m(z) = int_F s : {H r n^T + (xi - a_F) r - m rho}: g_m is of
/// degree p.
template <int dim>
double TransferLifting<dim>::change(const std::function<Tensor<dim>(const Point<dim>&)>& s) const
{
  if (losses_.empty()) return std::numeric_limits<double>::infinity();
  const fem::Quadrature<1> rule = fem::quadrature<1>(2 * degree_);
  const Point<dim> apex = fem::reference_simplex<dim>()[local_];
  std::vector<double> theta(degree_ + 1);
  std::vector<double> fixed(degree_ + 1);     // coefficients of g_0
  std::vector<double> with_rho(degree_ + 1);  // g_0 - g_1
  for (int q = 0; q < rule.size(); ++q)
  {
    double of_fixed = 0;
    double of_rho = 0;
    const double z = rule.points[q][0];
    for (const auto& [at, weight, r, moved, rho] : losses_)
    {
      const Tensor<dim> stress = s((1 - z) * mesh::facet_to_cell<dim>(local_, at) + z * apex);
      of_fixed += weight * stress.cwiseProduct(height_ * r * normal_.transpose() + moved).sum();
      of_rho += weight * stress.cwiseProduct(rho).sum();
    }
    fem::orthonormal_values<1>(degree_, rule.points[q], theta);
    for (int i = 0; i <= degree_; ++i)
    {
      fixed[i] += rule.weights[q] * theta[i] * of_fixed;
      with_rho[i] += rule.weights[q] * theta[i] * of_rho;
    }
  }
  const int best = best_exponent();
  double smallest = std::numeric_limits<double>::infinity();
  for (const int near : {1, best / 2, best, best + 1, 2 * best})
  {
    const int m = std::clamp(near, 1, largest_exponent);
    const fem::Quadrature<1> up = fem::quadrature<1>(degree_ + m);
    double product = 0;
    for (int q = 0; q < up.size(); ++q)
    {
      fem::orthonormal_values<1>(degree_, up.points[q], theta);
      for (int i = 0; i <= degree_; ++i)
        product += up.weights[q] * std::pow(1 - up.points[q][0], m) * theta[i] * (fixed[i] - m * with_rho[i]);
    }
    smallest = std::min(smallest, square(m) + 2 * product);
  }
  return smallest;
}

template <int dim>
double transfer_loss(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                     std::span<const TractionPiece<dim>> pieces)
{
  const LoadedFacet<dim> loaded(mesh, facet, degree, pieces);
  double square = 0;
  if constexpr (dim == 3)
    square = squares(loaded, pieces).plain;
  else
    for (const TransferLoss<dim>& loss : transfer_losses(loaded, pieces))
      square += loss.weight * loss.r.squaredNorm();
  return std::sqrt(square);
}

template class TransferLifting<2>;
template class TransferLifting<3>;
template double transfer_loss(const mesh::Mesh<2>&, const mesh::BoundaryFacet&, int,
                              std::span<const TractionPiece<2>>);
template double transfer_loss(const mesh::Mesh<3>&, const mesh::BoundaryFacet&, int,
                              std::span<const TractionPiece<3>>);

}  // namespace tribound::certify
