#pragma once

/// @file admissible_stress_testing.h
/// Stresses of one cell and of its pieces at points of space, and the problem of the nearest admissible
/// stress as a dense one, by collocation: nothing here is shared with certify/energy but the meaning of
/// coefficients.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/admissible_stress.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

/// The orthonormal basis of a simplex, whose vertices are given, at a point of space.
template <int dim>
struct BasisAt
{
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;  ///< one row for each function

  BasisAt(const fem::Part<dim>& simplex, int degree, const Point<dim>& x)
  {
    Tensor<dim> edges;
    for (int k = 0; k < dim; ++k) edges.col(k) = simplex[k + 1] - simplex[0];
    const Tensor<dim> inverse = edges.inverse();
    const double scale = 1 / std::sqrt(std::abs(edges.determinant()));
    std::vector<double> phi(fem::polynomial_dimension(dim, degree));
    std::vector<Point<dim>> gradient(phi.size());
    fem::orthonormal_gradients<dim>(degree, inverse * (x - simplex[0]), phi, gradient);
    values.resize(static_cast<Eigen::Index>(phi.size()));
    gradients.resize(values.size(), dim);
    for (Eigen::Index j = 0; j < values.size(); ++j)
    {
      values[j] = scale * phi[j];
      gradients.row(j) = scale * (inverse.transpose() * gradient[j]).transpose();
    }
  }
};

/// A stress and its divergence at a point.
template <int dim>
struct StressAt
{
  Tensor<dim> value = Tensor<dim>::Zero();
  Point<dim> divergence = Point<dim>::Zero();
};

/// coefficient(r, c, j) on the functions of a basis.
template <int dim, class Coefficient>
StressAt<dim> evaluate(const BasisAt<dim>& basis, const Coefficient& coefficient)
{
  StressAt<dim> result;
  for (int r = 0; r < dim; ++r)
    for (int c = 0; c < dim; ++c)
      for (int j = 0; j < basis.values.size(); ++j)
      {
        result.value(r, c) += coefficient(r, c, j) * basis.values[j];
        result.divergence[r] += coefficient(r, c, j) * basis.gradients(j, c);
      }
  return result;
}

/// A cell with stresses sigma_h and sigma(v) of given degrees; sigma_h of any skew part or of mean 0.
template <int dim>
class CellData
{
 public:
  CellData(const fem::Part<dim>& corners, int degree, int degree_v, bool balanced, std::mt19937& random)
      : corners(corners), degree(degree), degree_v(degree_v)
  {
    std::uniform_real_distribution<double> entry(-1, 1);
    const int n = fem::polynomial_dimension(dim, degree);
    const int n_v = fem::polynomial_dimension(dim, degree_v);
    sigma_h.resize(dim * dim * n);
    sigma_v.resize(dim * dim * n_v);
    for (double& x : sigma_h) x = entry(random);
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c <= r; ++c)
      {
        if (balanced) sigma_h[(dim * r + c) * n] = sigma_h[(dim * c + r) * n];
        for (int j = 0; j < n_v; ++j)
          sigma_v[(dim * r + c) * n_v + j] = sigma_v[(dim * c + r) * n_v + j] = entry(random);
      }
  }

  [[nodiscard]] certify::SortedCell<dim> cell() const
  {
    certify::SortedCell<dim> result;
    result.origin = corners[0];
    for (int k = 0; k < dim; ++k) result.jacobian.col(k) = corners[k + 1] - corners[0];
    result.inverse = result.jacobian.inverse();
    result.det = std::abs(result.jacobian.determinant());
    return result;
  }
  [[nodiscard]] StressAt<dim> at(const std::vector<double>& stress, int of_degree, const Point<dim>& x) const
  {
    const int n = fem::polynomial_dimension(dim, of_degree);
    return evaluate<dim>(BasisAt<dim>(corners, of_degree, x),
                         [&](int r, int c, int j) { return stress[(dim * r + c) * n + j]; });
  }
  [[nodiscard]] StressAt<dim> sigma_h_at(const Point<dim>& x) const { return at(sigma_h, degree, x); }
  [[nodiscard]] StressAt<dim> sigma_v_at(const Point<dim>& x) const { return at(sigma_v, degree_v, x); }
  /// The mean of the skew part of sigma_h.
  [[nodiscard]] Tensor<dim> mean_skew() const
  {
    const fem::Quadrature<dim> rule = fem::quadrature<dim>(degree);
    Tensor<dim> sum = Tensor<dim>::Zero();
    for (int q = 0; q < rule.size(); ++q)
      sum += mesh::factorial<dim> * rule.weights[q] *
             sigma_h_at(fem::point_in<dim>(corners, rule.points[q])).value;
    return (sum - sum.transpose()) / 2;
  }
  /// ||sigma_h||_T / root |T|.
  [[nodiscard]] double root_mean_square() const
  {
    double sum = 0;
    for (const double x : sigma_h) sum += x * x;
    return std::sqrt(sum * mesh::factorial<dim> / cell().det);
  }
  [[nodiscard]] fem::Part<dim> piece(int i) const
  {
    fem::Part<dim> result = corners;
    Point<dim> barycentre = Point<dim>::Zero();
    for (const Point<dim>& corner : corners) barycentre += corner / (dim + 1);
    result[i] = barycentre;
    return result;
  }
  /// An integral over piece i.
  [[nodiscard]] double integral(int i, int of_degree, const std::function<double(const Point<dim>&)>& f) const
  {
    const fem::Quadrature<dim> rule = fem::quadrature<dim>(of_degree);
    double sum = 0;
    for (int q = 0; q < rule.size(); ++q)
      sum += rule.weights[q] * f(fem::point_in<dim>(piece(i), rule.points[q]));
    return sum * cell().det / (dim + 1);
  }

  fem::Part<dim> corners;
  int degree;
  int degree_v;
  std::vector<double> sigma_h;
  std::vector<double> sigma_v;
};

/// The stress that the coefficients mean in piece i, at a point of space.
template <int dim, int q>
StressAt<dim> in_piece(const CellData<dim>& data, const certify::PiecewiseStress<dim, q>& stress, int i,
                       const Point<dim>& x)
{
  const int n = fem::polynomial_dimension(dim, q);
  return evaluate<dim>(BasisAt<dim>(data.piece(i), q, x),
                       [&](int r, int c, int j)
                       {
                         int a = std::min(r, c);
                         if (r != c) a = dim + (dim == 2 ? 0 : r + c - 1);
                         return stress(a, i * n + j) * (r == c ? 1 : std::sqrt(0.5));
                       });
}

/// (C^{-1} a) : b.
template <int dim>
double compliance_of(const problem::Material& material, const Tensor<dim>& a, const Tensor<dim>& b)
{
  return (a.cwiseProduct(b).sum() -
          material.lambda / (2 * material.mu + dim * material.lambda) * a.trace() * b.trace()) /
         (2 * material.mu);
}

/// The nearest admissible stress by dense algebra: unknowns are the entries (r, c), r <= c, on orthonormal
/// bases of the pieces; constraints hold at points in which they determine polynomials of their degree.
template <int dim>
class DenseAdmissible
{
 public:
  DenseAdmissible(const CellData<dim>& data, const problem::Material& material)
      : data_(data), n_(fem::polynomial_dimension(dim, data.degree))
  {
    constrain();
    // Y = L^T X with (C^{-1} tau, tau) = |Y|^2
    Eigen::MatrixXd metric(n_entries, n_entries);
    for (int a = 0; a < n_entries; ++a)
      for (int b = 0; b < n_entries; ++b) metric(a, b) = compliance_of<dim>(material, unit(a), unit(b));
    const Eigen::MatrixXd root = CholeskyFactors(metric).lower().transpose();
    const Eigen::MatrixXd inverse = inverse_of(root);
    Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(matrix_.rows(), matrix_.cols());
    Eigen::VectorXd target = Eigen::VectorXd::Zero(matrix_.cols());
    const Eigen::VectorXd v = coefficients_of_v();
    const int block = (dim + 1) * n_;
    for (int a = 0; a < n_entries; ++a)
      for (int b = 0; b < n_entries; ++b)
      {
        scaled.middleCols(b * block, block) += inverse(a, b) * matrix_.middleCols(a * block, block);
        target.segment(a * block, block) += root(a, b) * v.segment(b * block, block);
      }
    const Eigen::VectorXd difference = least_norm_solution(scaled, data_vector_ - scaled * target, dependent);
    residual_ = (scaled * (target + difference) - data_vector_).norm() / data_vector_.norm();
    square_ = difference.squaredNorm();
    tau_ = v;
    for (int a = 0; a < n_entries; ++a)
      for (int b = 0; b < n_entries; ++b)
        tau_.segment(a * block, block) += inverse(a, b) * difference.segment(b * block, block);
  }

  /// In rows; column (e * (dim + 1) + i) * n + j is entry e = (r, c), r <= c, on function j of piece i.
  [[nodiscard]] const Eigen::MatrixXd& constraints() const { return matrix_; }
  [[nodiscard]] double square() const { return square_; }
  [[nodiscard]] double residual() const { return residual_; }  ///< relative, of the constraints
  /// Dimension of the kernel of the constraints.
  [[nodiscard]] Eigen::Index kernel() const
  {
    const Eigen::ArrayXd pivots = PivotedQr(matrix_).upper().diagonal().array().abs();
    return matrix_.cols() - (pivots > dependent * pivots[0]).count();
  }
  [[nodiscard]] StressAt<dim> tau(int i, const Point<dim>& x) const
  {
    return evaluate<dim>(BasisAt<dim>(data_.piece(i), data_.degree, x),
                         [&](int r, int c, int j) { return tau_[column(r, c, i) + j]; });
  }

 private:
  static constexpr int n_entries = dim * (dim + 1) / 2;
  static constexpr double dependent = 1e-9;  ///< relative pivots of dependent constraints

  [[nodiscard]] static int entry(int r, int c)
  {
    int number = 0;
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b, ++number)
        if (a == std::min(r, c) && b == std::max(r, c)) return number;
    return -1;
  }
  [[nodiscard]] static Tensor<dim> unit(int number)
  {
    return Tensor<dim>::NullaryExpr(
        [&](Eigen::Index r, Eigen::Index c)
        { return entry(static_cast<int>(r), static_cast<int>(c)) == number ? 1.0 : 0.0; });
  }
  [[nodiscard]] int column(int r, int c, int i) const { return (entry(r, c) * (dim + 1) + i) * n_; }

  /// Adds sign tau n at a point, or div tau, of piece i to `dim` rows.
  void add_traction(int row, int i, const Point<dim>& x, const Point<dim>& normal)
  {
    const BasisAt<dim> basis(data_.piece(i), data_.degree, x);
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        matrix_.row(row + r).segment(column(r, c, i), n_) += normal[c] * basis.values;
  }
  void add_divergence(int row, int i, const Point<dim>& x)
  {
    const BasisAt<dim> basis(data_.piece(i), data_.degree, x);
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        matrix_.row(row + r).segment(column(r, c, i), n_) += basis.gradients.col(c);
  }

  void constrain()
  {
    const fem::Quadrature<dim - 1> on_facet = fem::quadrature<dim - 1>(2 * data_.degree);
    const fem::Quadrature<dim> in_cell = fem::quadrature<dim>(2 * (data_.degree - 1));
    const int rows = dim * ((dim + 1 + n_entries) * on_facet.size() + (dim + 1) * in_cell.size());
    matrix_.setZero(rows, n_entries * (dim + 1) * n_);
    data_vector_.setZero(rows);
    int row = 0;
    for (int f = 0; f <= dim; ++f)
    {
      const auto outer = mesh::facet_vertices(data_.corners, f);
      const Point<dim> normal = mesh::facet_geometry<dim>(outer, 0).normal;
      for (const Point<dim - 1>& s : on_facet.points)
      {
        const Point<dim> x = mesh::facet_map<dim>(outer)(s);
        add_traction(row, f, x, normal);
        data_vector_.segment(row, dim) = data_.sigma_h_at(x).value * normal;
        row += dim;
      }
      for (int g = f + 1; g <= dim; ++g)
      {
        const auto inner = mesh::facet_vertices(data_.piece(f), g);
        const Point<dim> across = mesh::facet_geometry<dim>(inner, 0).normal;
        for (const Point<dim - 1>& s : on_facet.points)
        {
          const Point<dim> x = mesh::facet_map<dim>(inner)(s);
          add_traction(row, f, x, across);
          add_traction(row, g, x, -across);
          row += dim;
        }
      }
      for (const Point<dim>& s : in_cell.points)
      {
        const Point<dim> x = fem::point_in<dim>(data_.piece(f), s);
        add_divergence(row, f, x);
        data_vector_.segment(row, dim) = data_.sigma_h_at(x).divergence;
        row += dim;
      }
    }
  }

  [[nodiscard]] Eigen::VectorXd coefficients_of_v() const
  {
    Eigen::VectorXd result(matrix_.cols());
    for (int i = 0; i <= dim; ++i)
      for (int r = 0; r < dim; ++r)
        for (int c = r; c < dim; ++c)
          for (int j = 0; j < n_; ++j)
            result[column(r, c, i) + j] =
                data_.integral(i, 2 * data_.degree,
                               [&](const Point<dim>& x) {
                                 return data_.sigma_v_at(x).value(r, c) *
                                        BasisAt<dim>(data_.piece(i), data_.degree, x).values[j];
                               });
    return result;
  }

  const CellData<dim>& data_;
  int n_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd data_vector_;
  double residual_ = 0;
  double square_ = 0;
  Eigen::VectorXd tau_;
};

}  // namespace tribound::test
