#pragma once

/// @file checked_stress.h
/// The stress of a cell as check_identities() evaluates it, with tables of its own.

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

/// Tables on the reference cell whose vertices are in ascending order.
template <int dim>
struct CheckTables
{
  int n;       ///< dim P^p(T)
  int n_less;  ///< dim P^{p-1}(T)
  fem::Quadrature<dim> data_rule;
  std::array<std::vector<double>, dim> derivative;    ///< (d_k phi_j, chi_i), [i * n + j]
  fem::Quadrature<dim - 1> jump_rule;                 ///< exact to degree 2p
  std::array<std::vector<double>, dim + 1> on_facet;  ///< phi at its points, [q * n + j]

  explicit CheckTables(int degree)
      : n(fem::polynomial_dimension(dim, degree)),
        n_less(fem::polynomial_dimension(dim, degree - 1)),
        data_rule(fem::quadrature<dim>(fem::data_quadrature_degree(degree))),
        jump_rule(fem::quadrature<dim - 1>(2 * degree))
  {
    std::vector<double> phi(n);
    std::vector<Point<dim>> gradients(n);
    for (auto& matrix : derivative) matrix.assign(static_cast<std::size_t>(n_less) * n, 0.0);
    for (int q = 0; q < data_rule.size(); ++q)
    {
      fem::orthonormal_gradients<dim>(degree, data_rule.points[q], phi, gradients);
      for (int k = 0; k < dim; ++k)
        for (int i = 0; i < n_less; ++i)
          for (int j = 0; j < n; ++j)
            derivative[k][i * n + j] += data_rule.weights[q] * phi[i] * gradients[j][k];
    }
    for (int f = 0; f <= dim; ++f)
      for (const Point<dim - 1>& s : jump_rule.points)
      {
        fem::orthonormal_values<dim>(degree, mesh::facet_to_cell<dim>(f, s), phi);
        on_facet[f].insert(on_facet[f].end(), phi.begin(), phi.end());
      }
  }
};

/// sigma_h = sigma_dis + sigma_lin + sigma_reg on one cell, in the coordinates of its vertices in ascending
/// order.
template <int dim>
class CheckedStress
{
 public:
  CheckedStress(const mesh::Mesh<dim>& mesh, const Stress<dim>& stress, Index cell)
      : degree_(stress.degree),
        n_(stress.n),
        coefficients_(stress.dis_in(cell).begin(), stress.dis_in(cell).end()),
        vertices_(mesh.cell(cell))
  {
    for (const std::span<const double> part : {stress.lin_in(cell), stress.reg_in(cell)})
      for (std::size_t i = 0; i < part.size(); ++i) coefficients_[i] += part[i];
    std::ranges::sort(vertices_);
    origin_ = mesh.vertex(vertices_[0]);
    for (int j = 0; j < dim; ++j) jacobian_.col(j) = mesh.vertex(vertices_[j + 1]) - origin_;
    det_ = std::abs(jacobian_.determinant());
    inverse_ = jacobian_.inverse();
  }

  [[nodiscard]] int degree() const { return degree_; }
  /// The basis of P^{p-1}(T) at a point of space, up to the factor 1/sqrt(det J).
  void truncated_basis_at(const Point<dim>& x, std::span<double> values) const
  {
    fem::orthonormal_values<dim>(degree_ - 1, inverse_ * (x - origin_), values);
  }
  /// Which of the ascending vertices is opposite to the facet; `opposite` is that vertex of the cell.
  [[nodiscard]] int facet_opposite(Index opposite) const
  {
    return static_cast<int>(std::ranges::find(vertices_, opposite) - vertices_.begin());
  }
  [[nodiscard]] double squared_norm() const
  {
    double sum = 0;
    for (const double c : coefficients_) sum += c * c;
    return sum;
  }

  /// sigma_h n from the values of the basis at a point.
  [[nodiscard]] Point<dim> normal_trace(const double* basis, const Point<dim>& normal) const
  {
    Point<dim> trace = Point<dim>::Zero();
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
      {
        double entry = 0;
        for (int j = 0; j < n_; ++j) entry += coefficient(r, c, j) * basis[j];
        trace[r] += entry * normal[c] / std::sqrt(det_);
      }
    return trace;
  }
  /// sigma_h n at a point of space.
  [[nodiscard]] Point<dim> normal_trace_at(const Point<dim>& x, const Point<dim>& normal) const
  {
    std::vector<double> values(n_);
    fem::orthonormal_values<dim>(degree_, inverse_ * (x - origin_), values);
    return normal_trace(values.data(), normal);
  }

  /// The coefficients of div sigma_h in the orthonormal basis of P^{p-1}(T).
  [[nodiscard]] std::vector<Point<dim>> divergence(const CheckTables<dim>& tables) const
  {
    std::vector<Point<dim>> result(tables.n_less, Point<dim>::Zero());
    for (int k = 0; k < dim; ++k)
      for (int i = 0; i < tables.n_less; ++i)
        for (int r = 0; r < dim; ++r)
          for (int c = 0; c < dim; ++c)
            for (int j = 0; j < n_; ++j)
              result[i][r] += inverse_(k, c) * tables.derivative[k][i * n_ + j] * coefficient(r, c, j);
    return result;
  }

  /// ||Pi^{p-1} skew sigma_h||^2: the skew part of the leading coefficients.
  [[nodiscard]] double squared_skew_part(int n_less) const
  {
    double sum = 0;
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        for (int j = 0; j < n_less; ++j)
          sum += std::pow((coefficient(r, c, j) - coefficient(c, r, j)) / 2, 2);
    return sum;
  }

 private:
  [[nodiscard]] double coefficient(int r, int c, int j) const
  {
    return coefficients_[(dim * r + c) * n_ + j];
  }

  int degree_;
  int n_;
  std::vector<double> coefficients_;
  mesh::Cell<dim> vertices_;  ///< ascending
  Point<dim> origin_;
  Tensor<dim> jacobian_;
  Tensor<dim> inverse_;
  double det_;
};

}  // namespace tribound::certify
