/// @file meridian_admissible_test.cpp
/// Admissible stresses of single cells of bodies of revolution: their properties at points of space, that no
/// admissible one is nearer, and integrals over 1/r by long Gauss rules.

#include "tribound/certify/energy/meridian_admissible.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <memory>
#include <random>

#include "tribound/certify/energy/alfeld_reference.h"
#include "unit/certify/admissible_stress_testing.h"

namespace tribound::test
{

namespace
{

using certify::MeridianStress;
using Corners = fem::Part<2>;

/// Cells with an edge on the axis, opposite to each of the vertices, with a vertex there, and off the axis.
const std::vector<Corners> cells = {
    {Point<2>(0.9, 0.4), Point<2>(0, 0.1), Point<2>(0, 1.2)},
    {Point<2>(0, -0.3), Point<2>(0.4, 0.9), Point<2>(0, 0.5)},
    {Point<2>(0, 1), Point<2>(0, 0), Point<2>(1.1, -0.2)},
    {Point<2>(0, 0.2), Point<2>(1, 0), Point<2>(0.7, 1.1)},
    {Point<2>(0.6, 0), Point<2>(1.2, 0.9), Point<2>(0, 0.1)},
    {Point<2>(0.5, 0), Point<2>(1.2, 0.3), Point<2>(0.4, 0.8)},
    {Point<2>(0.02, 0), Point<2>(1.2, 0.3), Point<2>(0.6, 0.8)},
    {Point<2>(100, 0), Point<2>(100.8, 0.2), Point<2>(100.3, 0.9)},
};

bool has_edge_on_axis(const Corners& corners)
{
  return std::ranges::count_if(corners, [](const Point<2>& x) { return x[0] == 0; }) == 2;
}

/// The integral of f over a triangle by a Gauss rule of n x n points, collapsed at the vertex that is nearest
/// to the axis.
double integral(Corners corners, int n, const std::function<double(const Point<2>&)>& f)
{
  std::ranges::sort(corners, {}, [](const Point<2>& x) { return x[0]; });
  const fem::Quadrature<1> rule = fem::quadrature<1>(2 * n - 1);
  const Point<2> one = corners[1] - corners[0];
  const Point<2> other = corners[2] - corners[0];
  const double det = std::abs(one[0] * other[1] - one[1] * other[0]);
  double sum = 0;
  for (int i = 0; i < rule.size(); ++i)
    for (int j = 0; j < rule.size(); ++j)
    {
      const double s = rule.points[i][0];
      const double t = rule.points[j][0];
      sum += rule.weights[i] * rule.weights[j] * s * f(corners[0] + s * ((1 - t) * one + t * other));
    }
  return det * sum;
}

/// A cell with tau_h, r vartheta_h and a target, whose entries are random numbers; on cells with an edge on
/// the axis all are multiples of r.
template <int q>
struct MeridianCase
{
  static constexpr int n = fem::polynomial_dimension(2, q);

  MeridianCase(const Corners& corners, double nu, std::mt19937& random)
      : cell(corners, q, q, true, random),
        sorted(cell.cell()),
        solver({{corners[0][0], corners[1][0], corners[2][0]}}, q),
        metric(solver.metric(0, problem::lame(1, nu)))
  {
    target = polynomial(4, q - 1, random);
    const Eigen::MatrixXd given = polynomial(5, q, random);
    Eigen::Map<Eigen::MatrixXd> tau_h(cell.sigma_h.data(), n, 4);
    tau_h = given.leftCols(4);
    r_vartheta_h = given.col(4);
    // the skew part of tau_h gets the mean 0 by a multiple of a function that vanishes where it does
    const Eigen::VectorXd bump = polynomial(1, q, random);
    tau_h.col(1) -= (tau_h(0, 1) - tau_h(0, 2)) / bump[0] * bump;
    result = solver.solve(0, sorted, metric, cell.sigma_h, r_vartheta_h, target);
  }

  /// Coefficients of any polynomials of this degree.
  Eigen::MatrixXd polynomial(int n_columns, int degree, std::mt19937& random) const
  {
    std::uniform_real_distribution<double> entry(-1, 1);
    const bool on_axis = has_edge_on_axis(cell.corners);
    const Eigen::MatrixXd any = Eigen::MatrixXd::NullaryExpr(
        fem::polynomial_dimension(2, degree - (on_axis ? 1 : 0)), n_columns, [&] { return entry(random); });
    if (!on_axis) return any;
    const fem::Quadrature<2> rule = fem::quadrature<2>(2 * degree);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(fem::polynomial_dimension(2, degree), n_columns);
    for (int k = 0; k < rule.size(); ++k)
    {
      const Point<2> x = fem::point_in<2>(cell.corners, rule.points[k]);
      const Eigen::VectorXd phi = BasisAt<2>(cell.corners, degree, x).values;
      result += rule.weights[k] * sorted.det * x[0] * phi * (phi.head(any.rows()).transpose() * any);
    }
    return result;
  }

  [[nodiscard]] StressAt<2> on_cell(const MeridianStress& stress, const Point<2>& x) const
  {
    const BasisAt<2> basis(cell.corners, q, x);
    return evaluate<2>(basis,
                       [&](int r, int c, int j)
                       {
                         if (j >= stress.rows()) return 0.0;
                         return r == c ? stress(j, r) : M_SQRT1_2 * stress(j, 2);
                       });
  }
  [[nodiscard]] StressAt<2> on_piece(const MeridianStress& stress, int i, const Point<2>& x) const
  {
    return evaluate<2>(BasisAt<2>(cell.piece(i), q, x), [&](int r, int c, int j)
                       { return r == c ? stress(i * n + j, r) : M_SQRT1_2 * stress(i * n + j, 2); });
  }
  [[nodiscard]] StressAt<2> tau(int i, const Point<2>& x) const
  {
    StressAt<2> stress = on_piece(result.difference, i, x);
    const StressAt<2> rest = on_cell(target, x);
    stress.value += rest.value;
    stress.divergence += rest.divergence;
    return stress;
  }
  [[nodiscard]] double hoop(const MeridianStress& stress, int i, const Point<2>& x) const
  {
    return BasisAt<2>(cell.piece(i), q, x).values.dot(stress.col(3).segment(i * n, n));
  }
  /// The product of two stresses by long Gauss rules.
  [[nodiscard]] double exact_product(const MeridianStress& a, const MeridianStress& b) const
  {
    const problem::Material& material = metric.material;
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += integral(cell.piece(i), 50,
                      [&](const Point<2>& x)
                      {
                        Tensor<3> values_a = Tensor<3>::Zero();
                        Tensor<3> values_b = Tensor<3>::Zero();
                        values_a.topLeftCorner<2, 2>() = on_piece(a, i, x).value;
                        values_b.topLeftCorner<2, 2>() = on_piece(b, i, x).value;
                        values_a(2, 2) = hoop(a, i, x);
                        values_b(2, 2) = hoop(b, i, x);
                        return compliance_of<3>(material, values_a, values_b) / x[0];
                      });
    return sum;
  }
  /// An orthonormal basis of the stresses in the plane, rows i * n + j of three columns one below another,
  /// without jumps, traction, divergence, and stress on an edge on the axis.
  [[nodiscard]] Eigen::MatrixXd kernel() const
  {
    Eigen::MatrixXd rows = DenseAdmissible<2>(cell, metric.material).constraints();
    // its columns are sigma_rr, sigma_rz, sigma_zz
    Eigen::MatrixXd constraints(rows.rows(), rows.cols());
    constraints << rows.leftCols(3 * n), rows.rightCols(3 * n), M_SQRT1_2 * rows.middleCols(3 * n, 3 * n);
    for (int f = 0; f < 3; ++f)
    {
      const auto ends = mesh::facet_vertices(cell.corners, f);
      if (ends[0][0] != 0 || ends[1][0] != 0) continue;
      for (int k = 0; k <= q; ++k)
      {
        const Point<2> x = ends[0] + k / static_cast<double>(q) * (ends[1] - ends[0]);
        for (int column = 0; column < 3; ++column)
        {
          constraints.conservativeResize(constraints.rows() + 1, Eigen::NoChange);
          constraints.bottomRows(1).setZero();
          constraints.bottomRows(1).middleCols((3 * column + f) * n, n) =
              BasisAt<2>(cell.piece(f), q, x).values.transpose();
        }
      }
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(constraints, Eigen::ComputeFullV);
    const Eigen::ArrayXd values = svd.singularValues().array();
    return svd.matrixV().rightCols(constraints.cols() - (values > 1e-10 * values[0]).count());
  }

  CellData<2> cell;
  certify::SortedCell<2> sorted;
  certify::MeridianStressSolver solver;
  certify::MeridianMetric metric;
  MeridianStress target;
  Eigen::VectorXd r_vartheta_h;
  certify::AdmissibleMeridianStress result;
};

template <class T>
class MeridianAdmissible : public ::testing::Test
{
 protected:
  static constexpr int q = T::value;

  /// check(case) for all cells and materials.
  template <class Check>
  void check_all(const Check& check)
  {
    for (std::size_t k = 0; k < cells.size(); ++k)
      for (const double nu : {0.0, 0.3, 0.49})
      {
        SCOPED_TRACE(::testing::Message() << "cell " << k << ", nu " << nu);
        check(MeridianCase<q>(cells[k], nu, random));
      }
  }
  Point<2> between(const Point<2>& a, const Point<2>& b)
  {
    return a + std::uniform_real_distribution<double>(0, 1)(random) * (b - a);
  }

  std::mt19937 random{11};
};

using Degrees = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                 std::integral_constant<int, 4>, std::integral_constant<int, 5>>;
TYPED_TEST_SUITE(MeridianAdmissible, Degrees);

TYPED_TEST(MeridianAdmissible, IsAdmissible)
{
  constexpr int q = TestFixture::q;
  this->check_all(
      [&](const MeridianCase<q>& c)
      {
        const Corners& corners = c.cell.corners;
        const double size = c.cell.root_mean_square();
        const double zero = 1e-13 * (10 + corners[0].norm()) * size;  // points are rounded, too
        EXPECT_LE(c.result.unbalanced, zero);
        for (int round = 0; round < 10; ++round)
          for (int f = 0; f < 3; ++f)
          {
            const auto ends = mesh::facet_vertices(corners, f);
            const Point<2> x = this->between(ends[0], ends[1]);
            const Point<2> normal = mesh::facet_geometry<2>(ends, 0).normal;
            const Tensor<2> on_facet = c.tau(f, x).value;
            EXPECT_LE(((on_facet - c.cell.sigma_h_at(x).value) * normal).norm(), zero);
            EXPECT_EQ(on_facet(0, 1), on_facet(1, 0));
            if (ends[0][0] == 0 && ends[1][0] == 0)
            {
              EXPECT_LE(on_facet.norm(), zero);
              EXPECT_LE(std::abs(c.hoop(c.result.difference, f, x)), zero);
            }
            for (int g = f + 1; g < 3; ++g)
            {
              const auto inner = mesh::facet_vertices(c.cell.piece(f), g);
              const Point<2> across = mesh::facet_geometry<2>(inner, 0).normal;
              const Point<2> y = this->between(inner[0], inner[1]);
              EXPECT_LE(((c.tau(f, y).value - c.tau(g, y).value) * across).norm(), zero);
            }
            const Corners piece = c.cell.piece(f);
            const Point<2> inside = this->between(piece[0], this->between(piece[1], piece[2]));
            EXPECT_LE((c.tau(f, inside).divergence - c.cell.sigma_h_at(inside).divergence).norm(),
                      50 * q * q * zero);
            MeridianStress hoop = MeridianStress::Zero(c.n, 4);
            hoop.col(3) = c.r_vartheta_h;
            hoop.col(3).head(c.target.rows()) -= c.target.col(3);
            EXPECT_NEAR(c.hoop(c.result.difference, f, inside), c.hoop(c.solver.on_pieces(hoop), f, inside),
                        zero);
          }
      });
}

/// Against the kernel of constraints by dense algebra.
TYPED_TEST(MeridianAdmissible, NoVariationIsNearer)
{
  constexpr int q = TestFixture::q;
  this->check_all(
      [&](const MeridianCase<q>& c)
      {
        const Eigen::MatrixXd kernel = c.kernel();
        constexpr std::array on_axis = {2, 7, 15, 26};
        constexpr std::array off_axis = {3, 9, 18, 30};
        ASSERT_EQ(kernel.cols(), (has_edge_on_axis(c.cell.corners) ? on_axis : off_axis)[q - 2]);
        const double square = c.metric.square(c.result.difference);
        for (int k = 0; k < kernel.cols(); ++k)
        {
          MeridianStress variation = MeridianStress::Zero(3 * c.n, 4);
          variation.leftCols(3) = Eigen::Map<const Eigen::MatrixXd>(kernel.col(k).data(), 3 * c.n, 3);
          const double own = c.metric.square(variation);
          EXPECT_LE(std::abs(c.metric.product(variation, c.result.difference)),
                    1e-9 * std::sqrt(own * square));
          for (const double factor : {-1e-3, 1e-3, 1.0})
            EXPECT_GT(c.metric.square(c.result.difference + factor * std::sqrt(square / own) * variation),
                      square);
        }
      });
}

TYPED_TEST(MeridianAdmissible, ProductsAreNeverTooSmall)
{
  constexpr int q = TestFixture::q;
  constexpr double rounding = 1e-13;
  this->check_all(
      [&](const MeridianCase<q>& c)
      {
        const MeridianStress& a = c.result.difference;
        const MeridianStress b = c.solver.on_pieces(c.target);
        const double aa = c.exact_product(a, a);
        const double bb = c.exact_product(b, b);
        EXPECT_GE(c.metric.square(a), (1 - rounding) * aa);
        EXPECT_GE(c.metric.square(b), (1 - rounding) * bb);
        EXPECT_LE(c.metric.square(a), (1 + 1e-10 + 2 * c.metric.error) * aa);
        EXPECT_LE(c.metric.square(b), (1 + 1e-10 + 2 * c.metric.error) * bb);
        EXPECT_NEAR(c.metric.product(a, b), c.exact_product(a, b),
                    c.metric.doubt(a, b) + rounding * std::sqrt(aa * bb));
        EXPECT_LE(c.metric.doubt(a, b), (1 + 1e-10) * c.metric.error * std::sqrt(aa * bb));
        // only the cell that is long compared with its distance from the axis has a rule that errs
        if (c.cell.corners[0][0] != 0.02)
          EXPECT_LE(c.metric.error, 1e-13);
        else
          EXPECT_LE(c.metric.error, 1e-2);
      });
}

TYPED_TEST(MeridianAdmissible, IsNoFartherThanASymmetricStress)
{
  constexpr int q = TestFixture::q;
  this->check_all(
      [&](MeridianCase<q> c)
      {
        Eigen::Map<Eigen::MatrixXd> tau_h(c.cell.sigma_h.data(), c.n, 4);
        tau_h.col(2) = tau_h.col(1);
        MeridianStress given(c.n, 4);
        given << tau_h.col(0), tau_h.col(3), M_SQRT2 * tau_h.col(1), c.r_vartheta_h;
        MeridianStress rest = given;
        rest.topRows(c.target.rows()) -= c.target;
        const auto nearest = c.solver.solve(0, c.sorted, c.metric, c.cell.sigma_h, c.r_vartheta_h, c.target);
        EXPECT_LE(c.metric.square(nearest.difference),
                  (1 + 1e-13) * c.metric.square(c.solver.on_pieces(rest)));
        const auto same = c.solver.solve(0, c.sorted, c.metric, c.cell.sigma_h, c.r_vartheta_h, given);
        EXPECT_LE(c.metric.square(same.difference), 1e-25 * c.metric.square(c.solver.on_pieces(given)));
      });
}

TYPED_TEST(MeridianAdmissible, ConstraintsHaveAClearRank)
{
  constexpr int q = TestFixture::q;
  constexpr std::array kernels = {2, 7, 15, 26};
  for (int facet = 0; facet < 3; ++facet)
  {
    const certify::AlfeldFactors factors = certify::alfeld_factors_without_stress_on(facet, q);
    EXPECT_LE(factors.largest_rest, 1e-13);
    EXPECT_GE(factors.smallest_pivot, 0.05);
    EXPECT_EQ(factors.kernel.size(), kernels[q - 2] * (certify::AlfeldSizes<2, q>::unknowns));
  }
}

}  // namespace

}  // namespace tribound::test
