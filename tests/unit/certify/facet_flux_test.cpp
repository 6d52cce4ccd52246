/// @file facet_flux_test.cpp
/// The triangulation of a facet below contact segments, and the fields on it.

#include "tribound/certify/bound/facet_flux.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "unit/certify/transfer_testing.h"

namespace tribound::test
{

namespace
{

using certify::FacetCover;

double double_area(const Point<2>& a, const Point<2>& b, const Point<2>& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

std::vector<fem::Part<2>> random_parts(int n_cuts, int left_out, std::mt19937& random)
{
  std::vector<fem::Part<2>> parts;
  for (const auto& piece : random_pieces<3>(1, n_cuts, left_out, random)) parts.push_back(piece.part);
  return parts;
}

/// Every edge belongs to two triangles, gone both ways, or lies on the rim; every triangle in its part.
void expect_conforming(const FacetCover& cover, const std::vector<fem::Part<2>>& parts)
{
  std::map<std::pair<int, int>, int> edges;
  std::vector<double> areas(parts.size());
  double sum = 0;
  for (const auto& [corners, part] : cover.triangles)
  {
    const auto [a, b, c] = corners;
    const double area = double_area(cover.vertices[a], cover.vertices[b], cover.vertices[c]);
    EXPECT_GT(area, 0);
    sum += area;
    for (const auto& edge : {std::pair(a, b), {b, c}, {c, a}}) EXPECT_EQ(++edges[edge], 1);
    const Point<2> centre = (cover.vertices[a] + cover.vertices[b] + cover.vertices[c]) / 3;
    if (part >= 0) areas[part] += area;
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
      const auto& [x, y, z] = parts[k];
      const double all = double_area(x, y, z);
      const bool is_inside = double_area(x, y, centre) / all > 0 && double_area(y, z, centre) / all > 0 &&
                             double_area(z, x, centre) / all > 0;
      EXPECT_EQ(is_inside, part == static_cast<int>(k));
    }
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  for (std::size_t k = 0; k < parts.size(); ++k) EXPECT_NEAR(areas[k], fem::fraction<2>(parts[k]), 1e-12);
  for (const auto& [edge, count] : edges)
  {
    if (edges.contains({edge.second, edge.first})) continue;
    const Point<2>& a = cover.vertices[edge.first];
    const Point<2>& b = cover.vertices[edge.second];
    const auto length = [](double x, double y) { return std::max(std::abs(x), std::abs(y)); };
    EXPECT_LE(std::min({length(a[0], b[0]), length(a[1], b[1]), length(a.sum() - 1, b.sum() - 1)}), 1e-11);
  }
}

TEST(FacetCover, Conforms)
{
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round)
  {
    SCOPED_TRACE(round);
    const int n_cuts = round % 12;
    const std::vector<fem::Part<2>> parts =
        random_parts(n_cuts, std::min(n_cuts, round % 4), random);  // some not covered, hanging vertices
    const auto cover = certify::conforming_cover(parts);
    ASSERT_TRUE(cover);
    expect_conforming(*cover, parts);
  }
}

/// The centre of what two parts cover lies on the edge between them.
TEST(FacetCover, ConformsBesideAParallelogram)
{
  const double third = 1.0 / 3;
  for (const double noise : {-1e-16, 0.0, 1e-16})
  {
    const Point<2> a(0.3, noise);
    const Point<2> b(1, 0);
    const Point<2> c(1 - third / 2, third / 2 + noise);
    const Point<2> d(0.3 - third / 2, third / 2);
    const std::vector<fem::Part<2>> parts = {{b, c, d}, {b, d, a}};
    const auto cover = certify::conforming_cover(parts);
    ASSERT_TRUE(cover);
    expect_conforming(*cover, parts);
  }
}

/// Corners that differ by rounding are one; parts that overlap by more are refused.
TEST(FacetCover, TellsRoundingFromOverlap)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (int round = 0; round < 50; ++round)
  {
    const std::vector<fem::Part<2>> parts = random_parts(1 + round % 8, 0, random);
    std::vector<fem::Part<2>> moved = parts;
    for (fem::Part<2>& part : moved)
      for (Point<2>& corner : part) corner += 1e-13 * Point<2>(noise(random), noise(random));
    const auto cover = certify::conforming_cover(moved);
    ASSERT_TRUE(cover);
    EXPECT_EQ(cover->triangles.size(), certify::conforming_cover(parts)->triangles.size());
    moved = parts;
    moved.push_back(parts[0]);
    EXPECT_FALSE(certify::conforming_cover(moved));
  }
}

/// Fields of degree p + 1 on the triangles of a random cover of a random triangle.
class Fields
{
 public:
  Fields(int degree, std::mt19937& random) : degree_(degree), n_(fem::polynomial_dimension(2, degree + 1))
  {
    std::uniform_real_distribution<double> shift(-0.2, 0.2);
    Eigen::Matrix2d map = 3 * Eigen::Matrix2d::Identity();
    for (double& entry : map.reshaped()) entry += shift(random);
    cover = *certify::conforming_cover(random_parts(5, degree % 2, random));
    for (const Point<2>& s : cover.vertices) vertices.emplace_back(map * s);
  }

  [[nodiscard]] std::array<Point<2>, 3> corners(std::size_t k) const
  {
    const auto [a, b, c] = cover.triangles[k].corners;
    return {vertices[a], vertices[b], vertices[c]};
  }
  [[nodiscard]] Point<2> value(const Eigen::VectorXd& field, std::size_t k, const Point<2>& x) const
  {
    const auto [a, b, c] = corners(k);
    Eigen::Matrix2d edges;
    edges << b - a, c - a;
    std::vector<double> theta(n_);
    fem::orthonormal_values<2>(degree_ + 1, edges.inverse() * (x - a), theta);
    Point<2> sum = Point<2>::Zero();
    for (int i = 0; i < n_; ++i)
      for (int c2 = 0; c2 < 2; ++c2) sum[c2] += field[(2 * static_cast<int>(k) + c2) * n_ + i] * theta[i];
    return sum / std::sqrt(edges.determinant());
  }
  [[nodiscard]] double divergence(const Eigen::VectorXd& field, std::size_t k, const Point<2>& x) const
  {
    constexpr double step = 1e-4;
    double sum = 0;
    for (int c = 0; c < 2; ++c)
    {
      const Point<2> shift = step * Point<2>::Unit(c);
      sum += (8 * (value(field, k, x + shift) - value(field, k, x - shift))[c] -
              (value(field, k, x + 2 * shift) - value(field, k, x - 2 * shift))[c]) /
             (12 * step);  // of fourth order
    }
    return sum;
  }
  /// The largest jump of the normal component over an edge, and normal component on the rim.
  [[nodiscard]] double largest_jump(const Eigen::VectorXd& field) const
  {
    std::map<std::pair<int, int>, std::vector<double>> jumps;
    for (std::size_t k = 0; k < cover.triangles.size(); ++k)
      for (int e = 0; e < 3; ++e)
      {
        const auto [a, b] =
            std::minmax(cover.triangles[k].corners[e], cover.triangles[k].corners[(e + 1) % 3]);
        const Point<2> edge = vertices[b] - vertices[a];
        std::vector<double>& jump = jumps.try_emplace({a, b}, 6).first->second;
        const double sign = a == cover.triangles[k].corners[e] ? 1 : -1;
        for (int i = 0; i < 6; ++i)
        {
          const Point<2> flux = value(field, k, vertices[a] + i / 5.0 * edge);
          jump[i] += sign * (flux[0] * edge[1] - flux[1] * edge[0]) / edge.norm();
        }
      }
    double largest = 0;
    for (const auto& [edge, jump] : jumps)
      for (const double x : jump) largest = std::max(largest, std::abs(x));
    return largest;
  }
  [[nodiscard]] int n() const { return n_; }

  FacetCover cover;
  std::vector<Point<2>> vertices;

 private:
  int degree_;
  int n_;
};

TEST(FacetFlux, HasDivergenceAndNoFluxThroughTheRim)
{
  std::mt19937 random(3);
  for (int round = 0; round < 12; ++round)
  {
    SCOPED_TRACE(round);
    const int degree = 1 + round % 4;
    const Fields fields(degree, random);
    const auto n_triangles = fields.cover.triangles.size();
    const int n_moments = fem::polynomial_dimension(2, degree);
    // r with integral 0: by its values, and by its moments
    Eigen::MatrixXd moments = Eigen::MatrixXd::Random(static_cast<int>(n_triangles) * n_moments, 1);
    std::vector<double> det(n_triangles);
    double integral = 0;
    double area = 0;
    for (std::size_t k = 0; k < n_triangles; ++k)
    {
      const auto [a, b, c] = fields.corners(k);
      det[k] = double_area(a, b, c);
      integral += moments(static_cast<int>(k) * n_moments, 0) * std::sqrt(det[k] / 2);
      area += det[k] / 2;
    }
    for (std::size_t k = 0; k < n_triangles; ++k)
      moments(static_cast<int>(k) * n_moments, 0) -= integral / area * std::sqrt(det[k] / 2);
    const certify::FacetFlux flux(fields.cover, fields.vertices, degree);
    const auto rho = flux.with_divergence(moments);
    ASSERT_TRUE(rho);
    EXPECT_LE(fields.largest_jump(rho->col(0)), 1e-10);
    std::vector<double> theta(n_moments);
    for (std::size_t k = 0; k < n_triangles; ++k)
    {
      const auto [a, b, c] = fields.corners(k);
      for (const Point<2>& s : {Point<2>(0.2, 0.3), Point<2>(0.5, 0.1)})
      {
        fem::orthonormal_values<2>(degree, s, theta);
        double r = 0;
        for (int j = 0; j < n_moments; ++j)
          r += theta[j] * moments(static_cast<int>(k) * n_moments + j, 0) / std::sqrt(det[k]);
        const Point<2> x = a + s[0] * (b - a) + s[1] * (c - a);
        EXPECT_NEAR(fields.divergence(rho->col(0), k, x), r, 1e-5 * (1 + std::abs(r)));
      }
    }
    // what is left of a random field has its divergence and jumps and is orthogonal to the rest
    const Eigen::MatrixXd field = Eigen::MatrixXd::Random(rho->rows(), 1);
    const Eigen::MatrixXd rest = field - *flux.without_circulation(field, 1);
    EXPECT_GT(rest.norm(), 0.1);
    EXPECT_LE(fields.largest_jump(rest.col(0)), 1e-10);
    EXPECT_LE(std::abs((rest.transpose() * *rho)(0, 0)), 1e-10 * rest.norm() * rho->norm());
    EXPECT_LE((*flux.without_circulation(*rho, 1) - *rho).norm(), 1e-10 * rho->norm());
  }
}

}  // namespace

}  // namespace tribound::test
