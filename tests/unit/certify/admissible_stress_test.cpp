/// @file admissible_stress_test.cpp
/// The admissible stress of a cell: its properties at points of space, and the nearest one by dense algebra.

#include "tribound/certify/energy/admissible_stress.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <memory>
#include <random>

#include "tribound/certify/energy/alfeld_reference.h"
#include "unit/certify/admissible_stress_testing.h"

namespace tribound::test
{

namespace
{

template <int d, int degree>
struct Case
{
  static constexpr int dim = d;
  static constexpr int q = degree;
};

template <class T>
class AdmissibleStress : public ::testing::Test
{
 protected:
  static constexpr int dim = T::dim;
  static constexpr int q = T::q;

  /// The reference cell with its vertices moved, in any order, and pressed to `height`, then turned.
  fem::Part<dim> cell(double height)
  {
    fem::Part<dim> corners = fem::reference_simplex<dim>();
    std::uniform_real_distribution<double> shift(-0.25, 0.25);
    const Tensor<dim> any = Tensor<dim>::NullaryExpr([&] { return shift(random); });
    const Tensor<dim> rotation = any.householderQr().householderQ();
    for (Point<dim>& x : corners)
    {
      x += Point<dim>::NullaryExpr([&] { return shift(random); });
      x[dim - 1] *= height;
      x = rotation * x + Point<dim>::Constant(2);
    }
    std::ranges::shuffle(corners, random);
    return corners;
  }
  CellData<dim> data(double height, bool balanced = true)
  {
    return CellData<dim>(cell(height), q, std::max(q - 1, 1), balanced, random);
  }
  [[nodiscard]] certify::AdmissibleStress<dim, q> solve(const CellData<dim>& data,
                                                        const problem::Material& material)
  {
    return solver->solve(data.cell(), material, data.sigma_h, data.sigma_v);
  }
  Point<dim> point_of(const fem::Part<dim>& part)
  {
    std::array<double, dim + 1> lambda;
    std::uniform_real_distribution<double> weight(0, 1);
    double sum = 0;
    for (double& l : lambda) sum += l = weight(random);
    Point<dim> x = Point<dim>::Zero();
    for (int i = 0; i <= dim; ++i) x += lambda[i] / sum * part[i];
    return x;
  }

  std::mt19937 random{7};
  std::unique_ptr<certify::AdmissibleStressSolver<dim, q>> solver =
      std::make_unique<certify::AdmissibleStressSolver<dim, q>>();
  std::vector<problem::Material> materials = {
      problem::lame(1, 0.3), problem::lame(210e9, 0.4999), problem::lame(0.1, -0.3),
      problem::lame(1, 0.3, dim == 2 ? problem::PlaneModel::stress : problem::PlaneModel::strain)};
};

using Cases = ::testing::Types<Case<2, 1>, Case<2, 2>, Case<2, 3>, Case<2, 4>, Case<3, 1>, Case<3, 2>,
                               Case<3, 3>, Case<3, 4>>;
TYPED_TEST_SUITE(AdmissibleStress, Cases);

/// tau n on both sides of the facets inside, on the facets of the cell, and div tau; where sigma_h is not
/// balanced, all but its mean skew part.
TYPED_TEST(AdmissibleStress, IsAdmissible)
{
  constexpr int dim = TestFixture::dim;
  constexpr int q = TestFixture::q;
  for (const double height : {1.0, 1.0, 0.1, 0.01})
    for (const bool balanced : {true, false})
    {
      SCOPED_TRACE(height);
      const CellData<dim> data = this->data(height, balanced);
      const auto result = this->solve(data, this->materials[0]);
      const Tensor<dim> mean = data.mean_skew();
      const auto tau = [&](int i, const Point<dim>& x)
      {
        StressAt<dim> stress = in_piece<dim, q>(data, result.difference, i, x);
        const StressAt<dim> of_v = data.sigma_v_at(x);
        stress.value += of_v.value;
        stress.divergence += of_v.divergence;
        return stress;
      };
      // rounding in J tau^ J^T; a derivative is an inverse height
      const double size = data.root_mean_square();
      const double zero = 1e-13 * size / (height * height);
      for (int round = 0; round < 20; ++round)
        for (int f = 0; f <= dim; ++f)
        {
          fem::Part<dim> facet = data.corners;
          facet[f] = facet[(f + 1) % (dim + 1)];
          const Point<dim> x = this->point_of(facet);
          const Point<dim> normal =
              mesh::facet_geometry<dim>(mesh::facet_vertices(data.corners, f), 0).normal;
          EXPECT_LE((tau(f, x).value * normal - (data.sigma_h_at(x).value - mean) * normal).norm(), zero);
          for (int g = f + 1; g <= dim; ++g)
          {
            fem::Part<dim> between = data.piece(f);
            const Point<dim> across = mesh::facet_geometry<dim>(mesh::facet_vertices(between, g), 0).normal;
            between[g] = between[f];
            const Point<dim> y = this->point_of(between);
            EXPECT_LE(((tau(f, y).value - tau(g, y).value) * across).norm(), zero);
          }
          const Point<dim> inside = this->point_of(data.piece(f));
          EXPECT_LE((tau(f, inside).divergence - data.sigma_h_at(inside).divergence).norm(),
                    q * q * zero / height);
        }
      const double root = std::sqrt(data.cell().det / mesh::factorial<dim>);
      EXPECT_NEAR(result.unbalanced, root * mean.norm(), 1e-14 / height * root * size);
      EXPECT_EQ(result.unbalanced > 1e-8 * root * size, !balanced);
    }
}

/// By dense algebra that knows nothing of the reference cell.
TYPED_TEST(AdmissibleStress, IsTheNearest)
{
  constexpr int dim = TestFixture::dim;
  constexpr int q = TestFixture::q;
  for (const problem::Material& material : this->materials)
  {
    const double height = &material == &this->materials[3] ? 0.1 : 1;
    SCOPED_TRACE(height);
    const CellData<dim> data = this->data(height);
    const auto result = this->solve(data, material);
    const DenseAdmissible<dim> dense(data, material);
    EXPECT_EQ(dense.kernel(), (certify::AlfeldSizes<dim, q>::kernel));
    EXPECT_LE(dense.residual(), 1e-9);
    EXPECT_NEAR(result.square, dense.square(), 1e-9 * dense.square());
    double square = 0;
    for (int i = 0; i <= dim; ++i)
    {
      square += data.integral(i, 2 * q,
                              [&](const Point<dim>& x)
                              {
                                const auto difference = in_piece<dim, q>(data, result.difference, i, x).value;
                                return compliance_of<dim>(material, difference, difference);
                              });
      const Point<dim> x = this->point_of(data.piece(i));
      const Tensor<dim> tau =
          in_piece<dim, q>(data, result.difference, i, x).value + data.sigma_v_at(x).value;
      EXPECT_LE((tau - dense.tau(i, x).value).norm(), 1e-7 * tau.norm());
    }
    EXPECT_NEAR(result.square, square, 1e-11 * square);
  }
}

TYPED_TEST(AdmissibleStress, IsNoFartherThanASymmetricStress)
{
  constexpr int dim = TestFixture::dim;
  constexpr int q = TestFixture::q;
  for (const problem::Material& material : this->materials)
  {
    CellData<dim> data = this->data(0.5);
    const int n = fem::polynomial_dimension(dim, q);
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < r; ++c)
        std::copy_n(&data.sigma_h[(dim * r + c) * n], n, &data.sigma_h[(dim * c + r) * n]);
    auto rest = certify::on_pieces<dim, q>(data.sigma_h);
    certify::add_multiple(rest, -1.0, certify::on_pieces<dim, q>(data.sigma_v));
    const double square = certify::compliance_product(material, rest, rest);
    EXPECT_LE(this->solve(data, material).square, (1 + 1e-13) * square);
    data.sigma_v = data.sigma_h;
    EXPECT_LE(this->solve(data, material).square, 1e-26 * square);
  }
}

/// ||(tau - sigma(v))/2 - sigma(c)||^2 and (s, tau)_{C^{-1}} by integrals of values at points.
TYPED_TEST(AdmissibleStress, ProductsAreThoseOfValues)
{
  constexpr int dim = TestFixture::dim;
  constexpr int q = TestFixture::q;
  for (const problem::Material& material : this->materials)
  {
    const CellData<dim> data = this->data(0.7);
    const CellData<dim> other(data.corners, q, std::max(q - 1, 1), true, this->random);
    const auto result = this->solve(data, material);
    auto rest = certify::on_pieces<dim, q>(other.sigma_v);
    certify::add_multiple(rest, -0.5, result.difference);
    double product = 0;
    for (int i = 0; i <= dim; ++i)
      product += data.integral(i, 2 * q,
                               [&](const Point<dim>& x)
                               {
                                 const Tensor<dim> half =
                                     in_piece<dim, q>(data, result.difference, i, x).value / 2;
                                 const Tensor<dim> sum = other.sigma_v_at(x).value;
                                 return compliance_of<dim>(material, half - sum, half);
                               });
    const double expected = -0.5 * certify::compliance_product(material, rest, result.difference);
    EXPECT_NEAR(product, expected, 1e-11 * result.square);

    const Point<dim> x = this->point_of(data.piece(1));
    const certify::SortedCell<dim> cell = data.cell();
    const Tensor<dim> value =
        certify::value_in_piece<dim, q>(cell, result.difference, 1, cell.inverse * (x - cell.origin));
    EXPECT_LE((value - in_piece<dim, q>(data, result.difference, 1, x).value).norm(), 1e-12 * value.norm());
  }
}

/// Whatever the constraints are, rigid motions are all that is redundant in them.
TYPED_TEST(AdmissibleStress, ConstraintsHaveAClearRank)
{
  constexpr int dim = TestFixture::dim;
  constexpr int q = TestFixture::q;
  const certify::AlfeldFactors factors = certify::alfeld_factors<dim>(q);
  EXPECT_LE(factors.largest_rest, 1e-13);
  EXPECT_GE(factors.smallest_pivot, 0.1);
  constexpr std::array<std::array<int, 4>, 2> kernels = {{{0, 3, 9, 18}, {0, 18, 66, 156}}};
  EXPECT_EQ((certify::AlfeldSizes<dim, q>::kernel), kernels[dim - 2][q - 1]);
}

}  // namespace

}  // namespace tribound::test
