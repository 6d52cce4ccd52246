/// @file alfeld_factors.cpp
/// The constraints on the reference cell, and their solution.

#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/alfeld_reference.h"
#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// The pieces of the reference cell, with the functions psi_ij = root(dim + 1) phi_j on piece i.
template <int dim>
class Pieces
{
 public:
  static constexpr int count = dim + 1;

  explicit Pieces(int degree)
      : degree_(degree), n_(fem::polynomial_dimension(dim, degree)), corners_(fem::reference_simplex<dim>())
  {
  }

  [[nodiscard]] int n() const { return n_; }
  [[nodiscard]] Point<dim> barycentre() const { return Point<dim>::Constant(1.0 / count); }
  [[nodiscard]] const fem::Part<dim>& whole() const { return corners_; }
  [[nodiscard]] fem::Part<dim> piece(int i) const
  {
    fem::Part<dim> result = corners_;
    result[i] = barycentre();
    return result;
  }
  /// psi_ij, j = 0, ..., n - 1, at a point of the cell, or only the first of them, which span P^degree.
  [[nodiscard]] Eigen::VectorXd values(int i, const Point<dim>& x, int degree) const
  {
    Eigen::VectorXd result(fem::polynomial_dimension(dim, degree));
    fem::orthonormal_values<dim>(degree, to_piece<dim>(i, x), {result.data(), std::size_t(result.size())});
    return std::sqrt(count) * result;
  }
  /// Their gradients, column by column.
  [[nodiscard]] Eigen::MatrixXd gradients(int i, const Point<dim>& x) const
  {
    std::vector<double> phi(n_);
    std::vector<Point<dim>> gradient(n_);
    fem::orthonormal_gradients<dim>(degree_, to_piece<dim>(i, x), phi, gradient);
    Tensor<dim> edges;
    for (int k = 0; k < dim; ++k) edges.col(k) = piece(i)[k + 1] - piece(i)[0];
    Eigen::MatrixXd result(dim, n_);
    for (int j = 0; j < n_; ++j) result.col(j) = edges.transpose().inverse() * gradient[j];
    return std::sqrt(count) * result;
  }

 private:
  int degree_;
  int n_;
  fem::Part<dim> corners_;
};

/// The constraints on one row of a stress: moments of its normal components on the facets of the cell, of
/// their jumps between pieces, and of its divergence. Column (c * (dim + 1) + i) * n + j: entry c, psi_ij.
template <int dim>
class RowConstraints
{
 public:
  RowConstraints(const Pieces<dim>& pieces, int degree)
      : pieces_(pieces), degree_(degree), rule_(fem::quadrature<dim - 1>(2 * degree))
  {
    constexpr int n_pieces = Pieces<dim>::count;
    const int n_facet = fem::polynomial_dimension(dim - 1, degree);
    const int n_less = fem::polynomial_dimension(dim, degree - 1);
    matrix_.setZero((n_pieces + n_pieces * dim / 2) * n_facet + n_pieces * n_less,
                    dim * n_pieces * pieces.n());
    int row = 0;
    for (int f = 0; f <= dim; ++f, row += n_facet)
      add_normal_components(row, mesh::facet_vertices(pieces.whole(), f), f, 1);
    for (int f = 0; f <= dim; ++f)
      for (int g = f + 1; g <= dim; ++g, row += n_facet)
      {
        const auto between = mesh::facet_vertices(pieces.piece(f), g);
        add_normal_components(row, between, f, 1);
        add_normal_components(row, between, g, -1);
      }
    for (int i = 0; i <= dim; ++i, row += n_less) add_divergence(row, i);
  }

  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return matrix_; }
  /// The columns of entry c.
  [[nodiscard]] auto entry(int c) const
  {
    const int n = Pieces<dim>::count * pieces_.n();
    return matrix_.middleCols(c * n, n);
  }

 private:
  [[nodiscard]] int column(int c, int i) const { return (c * Pieces<dim>::count + i) * pieces_.n(); }

  /// The rows (sign tau n, theta)_F of the stress in piece i.
  void add_normal_components(int row, const std::array<Point<dim>, dim>& facet, int i, double sign)
  {
    const Point<dim> normal = mesh::facet_geometry<dim>(facet, 0).normal;
    const mesh::FacetMap<dim> map = mesh::facet_map<dim>(facet);
    std::vector<double> theta(fem::polynomial_dimension(dim - 1, degree_));
    for (int q = 0; q < rule_.size(); ++q)
    {
      fem::orthonormal_values<dim - 1>(degree_, rule_.points[q], theta);
      const Eigen::VectorXd psi = pieces_.values(i, map(rule_.points[q]), degree_);
      for (std::size_t k = 0; k < theta.size(); ++k)
        for (int c = 0; c < dim; ++c)
          matrix_.row(row + static_cast<int>(k)).segment(column(c, i), pieces_.n()) +=
              sign * rule_.weights[q] * theta[k] * normal[c] * psi;
    }
  }

  /// The rows (div tau, psi_il) of the stress in piece i.
  void add_divergence(int row, int i)
  {
    const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * degree_);
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> x = fem::point_in<dim>(pieces_.piece(i), rule.points[q]);
      const Eigen::VectorXd test = pieces_.values(i, x, degree_ - 1);
      const Eigen::MatrixXd gradients = pieces_.gradients(i, x);
      for (int c = 0; c < dim; ++c)
        matrix_.block(row, column(c, i), test.size(), pieces_.n()) +=
            rule.weights[q] / Pieces<dim>::count * test * gradients.row(c);
    }
  }

  const Pieces<dim>& pieces_;
  int degree_;
  fem::Quadrature<dim - 1> rule_;
  Eigen::MatrixXd matrix_;
};

/// (phi_j, psi_il) in piece i, at (j, i * n + l).
template <int dim>
Eigen::MatrixXd restriction_to(const Pieces<dim>& pieces, int degree)
{
  const int n = pieces.n();
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * degree);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, Pieces<dim>::count * n);
  Eigen::VectorXd phi(n);
  for (int i = 0; i <= dim; ++i)
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> x = fem::point_in<dim>(pieces.piece(i), rule.points[q]);
      fem::orthonormal_values<dim>(degree, x, {phi.data(), std::size_t(n)});
      result.middleCols(i * n, n) +=
          rule.weights[q] / Pieces<dim>::count * phi * pieces.values(i, x, degree).transpose();
    }
  return result;
}

/// All rows of a symmetric stress: column (a * (dim + 1) + i) * n + j is component a, psi_ij.
template <int dim>
Eigen::MatrixXd symmetric_constraints(const RowConstraints<dim>& row_constraints)
{
  const Eigen::Index n_rows = row_constraints.matrix().rows();
  const Eigen::Index n = row_constraints.matrix().cols() / dim;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(dim * n_rows, dim * (dim + 1) / 2 * n);
  for (std::size_t a = 0; a < symmetric_pairs<dim>.size(); ++a)
  {
    const auto [r, c] = symmetric_pairs<dim>[a];
    const double entry = r == c ? 0.5 : M_SQRT1_2;
    const auto column = static_cast<Eigen::Index>(a) * n;
    result.block(r * n_rows, column, n_rows, n) += entry * row_constraints.entry(c);
    result.block(c * n_rows, column, n_rows, n) += entry * row_constraints.entry(r);
  }
  return result;
}

/// The traction and the divergence of the skew functions, column by column.
template <int dim>
Eigen::MatrixXd of_skew_functions(const RowConstraints<dim>& row_constraints,
                                  const Eigen::MatrixXd& restriction)
{
  const Eigen::Index n_rows = row_constraints.matrix().rows();
  const Eigen::Index n = restriction.rows() - 1;
  const Eigen::MatrixXd functions = restriction.bottomRows(n).transpose();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(dim * n_rows, dim * (dim - 1) / 2 * n);
  for (std::size_t pair = 0; pair < skew_pairs<dim>.size(); ++pair)
  {
    const auto [r, c] = skew_pairs<dim>[pair];
    const auto column = static_cast<Eigen::Index>(pair) * n;
    result.block(r * n_rows, column, n_rows, n) = row_constraints.entry(c).lazyProduct(functions);
    result.block(c * n_rows, column, n_rows, n) = -row_constraints.entry(r).lazyProduct(functions);
  }
  return result;
}

std::vector<double> column_by_column(const Eigen::MatrixXd& matrix)
{
  return {matrix.data(), matrix.data() + matrix.size()};
}

/// The moments (t . tau t, theta)_F of a symmetric stress on a facet of the cell, t the tangent.
Eigen::MatrixXd along_facet(const Pieces<2>& pieces, int degree, int facet)
{
  const std::array<Point<2>, 2> ends = mesh::facet_vertices(pieces.whole(), facet);
  const Point<2> tangent = (ends[1] - ends[0]).normalized();
  const SymmetricVector<2> entries = symmetric_vector<2>(tangent * tangent.transpose());
  const fem::Quadrature<1> rule = fem::quadrature<1>(2 * degree);
  const int n = pieces.n();
  Eigen::VectorXd theta(fem::polynomial_dimension(1, degree));
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(theta.size(), AlfeldSizes<2, 1>::components * 3 * n);
  for (int q = 0; q < rule.size(); ++q)
  {
    fem::orthonormal_values<1>(degree, rule.points[q], {theta.data(), std::size_t(theta.size())});
    const Point<2> x = mesh::facet_map<2>(ends)(rule.points[q]);
    for (int a = 0; a < entries.size(); ++a)
      result.middleCols((a * 3 + facet) * n, n) +=
          rule.weights[q] * entries[a] * theta * pieces.values(facet, x, degree).transpose();
  }
  return result;
}

/// On the coefficients of P^degree less the first: the orthogonal projection onto the functions of mean 0
/// that vanish on a facet.
Eigen::MatrixXd projection_onto_vanishing(int degree, int facet)
{
  const int n = fem::polynomial_dimension(2, degree);
  const int n_less = fem::polynomial_dimension(2, degree - 1);
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * degree);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n_less);  // of lambda phi_l
  Eigen::VectorXd phi(n);
  for (int q = 0; q < rule.size(); ++q)
  {
    fem::orthonormal_values<2>(degree, rule.points[q], {phi.data(), std::size_t(n)});
    products +=
        rule.weights[q] * fem::barycentric<2>(rule.points[q])[facet] * phi * phi.head(n_less).transpose();
  }
  const Eigen::MatrixXd onto =
      products * CholeskyFactors(products.transpose() * products).solve(products.transpose());
  return (onto - onto.col(0) * onto.row(0) / onto(0, 0)).bottomRightCorner(n - 1, n - 1);
}

// B^T = Q R P^T: the last columns of Q span the kernel of B. With the independent rows of B first, x = Q_1
// R_1^{-T} (P^T c)_1 solves B x = c for the columns of `data`. Large products use vector instructions:
// Eigen's would start threads, and a program compiled without OpenMP has its own version of the functions
// that they call, which the linker may take for both.
AlfeldFactors solve_constraints(const Eigen::MatrixXd& constraints, const Eigen::MatrixXd& given,
                                Eigen::Index n_dependent)
{
  const PivotedQr qr(constraints.transpose());
  const Eigen::Index rank = constraints.rows() - n_dependent;
  const Eigen::Index n = constraints.cols();
  const Eigen::MatrixXd triangle = qr.upper();

  Eigen::MatrixXd data = qr.permuted(given);
  data.conservativeResize(rank, Eigen::NoChange);
  data = solve_lower(triangle.topLeftCorner(rank, rank).transpose(), data);
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(n, n - rank + data.cols());  // of the kernel, of the lifting
  columns.bottomLeftCorner(n - rank, n - rank).setIdentity();
  columns.topRightCorner(rank, data.cols()) = data;
  columns = qr.times_q(columns);

  AlfeldFactors result;
  result.kernel = column_by_column(columns.leftCols(n - rank));
  result.lifting = column_by_column(columns.rightCols(data.cols()));
  result.smallest_pivot = triangle.diagonal().head(rank).cwiseAbs().minCoeff();
  if (n > rank)
    result.largest_rest =
        triangle.bottomRightCorner(n - rank, constraints.rows() - rank).cwiseAbs().maxCoeff();
  return result;
}

}  // namespace

// All rows but the rigid motions are independent.
template <int dim>
AlfeldFactors alfeld_factors(int q)
{
  const Pieces<dim> pieces(q);
  const RowConstraints<dim> row_constraints(pieces, q);
  const Eigen::MatrixXd restriction = restriction_to(pieces, q);
  AlfeldFactors result =
      solve_constraints(symmetric_constraints(row_constraints),
                        of_skew_functions(row_constraints, restriction), dim * (dim + 1) / 2);
  result.restriction = column_by_column(restriction.transpose());
  return result;
}

// Besides the rigid motions one row at each end of the facet depends on the others: Lemma 21.
AlfeldFactors alfeld_factors_without_stress_on(int facet, int q)
{
  const Pieces<2> pieces(q);
  const RowConstraints<2> row_constraints(pieces, q);
  const Eigen::MatrixXd restriction = restriction_to(pieces, q);
  const Eigen::MatrixXd constraints = symmetric_constraints(row_constraints);
  const Eigen::MatrixXd along = along_facet(pieces, q, facet);
  Eigen::MatrixXd all(constraints.rows() + along.rows(), constraints.cols());
  all << constraints, along;
  Eigen::MatrixXd data = Eigen::MatrixXd::Zero(all.rows(), pieces.n() - 1);
  data.topRows(constraints.rows()) =
      of_skew_functions(row_constraints, restriction).lazyProduct(projection_onto_vanishing(q, facet));
  AlfeldFactors result = solve_constraints(all, data, 5);
  result.restriction = column_by_column(restriction.transpose());
  return result;
}

template AlfeldFactors alfeld_factors<2>(int);
template AlfeldFactors alfeld_factors<3>(int);

}  // namespace tribound::certify
