#include "tribound/certify/bound/facet_flux.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

namespace
{

/// Integrals on the reference triangle.
struct ReferenceMoments
{
  explicit ReferenceMoments(int degree)
  {
    const int n = fem::polynomial_dimension(2, degree + 1);
    std::vector<double> theta(n);
    std::vector<Point<2>> gradients(n);
    derivative.fill(Eigen::MatrixXd::Zero(fem::polynomial_dimension(2, degree), n));
    const fem::Quadrature<2> rule = fem::quadrature<2>(2 * degree);
    for (int q = 0; q < rule.size(); ++q)
    {
      fem::orthonormal_gradients<2>(degree + 1, rule.points[q], theta, gradients);
      for (int c = 0; c < 2; ++c)
        for (int j = 0; j < derivative[c].rows(); ++j)
          for (int i = 0; i < n; ++i) derivative[c](j, i) += rule.weights[q] * theta[j] * gradients[i][c];
    }
    const auto corners = fem::reference_simplex<2>();
    const fem::Quadrature<1> along = fem::quadrature<1>(2 * degree + 2);
    std::vector<double> legendre(degree + 2);
    for (int k = 0; k < 3; ++k)
    {
      edge[k] = Eigen::MatrixXd::Zero(degree + 2, n);
      for (int q = 0; q < along.size(); ++q)
      {
        const double t = along.points[q][0];
        fem::orthonormal_values<1>(degree + 1, along.points[q], legendre);
        fem::orthonormal_values<2>(degree + 1, (1 - t) * corners[k] + t * corners[(k + 1) % 3], theta);
        for (int j = 0; j < degree + 2; ++j)
          for (int i = 0; i < n; ++i) edge[k](j, i) += along.weights[q] * legendre[j] * theta[i];
      }
    }
  }

  std::array<Eigen::MatrixXd, 2> derivative;  ///< int theta_j d_c theta_i
  std::array<Eigen::MatrixXd, 3> edge;        ///< int l_j theta_i from corner k to the next, l_j of Legendre
};

/// Numbers of the edges, independent of their direction.
class EdgeNumbers
{
 public:
  int operator()(int a, int b)
  {
    return numbers_.try_emplace(std::minmax(a, b), static_cast<int>(numbers_.size())).first->second;
  }
  [[nodiscard]] int size() const { return static_cast<int>(numbers_.size()); }

 private:
  std::map<std::pair<int, int>, int> numbers_;
};

}  // namespace

FacetFlux::FacetFlux(const FacetCover& cover, std::span<const Point<2>> vertices, int degree)
{
  const ReferenceMoments reference(degree);
  const int n = fem::polynomial_dimension(2, degree + 1);
  const int n_div = fem::polynomial_dimension(2, degree);
  const int n_triangles = static_cast<int>(cover.triangles.size());
  n_moments_ = n_triangles * n_div;
  EdgeNumbers edges;
  std::vector<Eigen::Triplet<double>> entries;
  int largest = 0;
  double largest_det = 0;
  for (int k = 0; k < n_triangles; ++k)
  {
    const std::array<int, 3>& corners = cover.triangles[k].corners;
    Eigen::Matrix2d jacobian;
    jacobian << vertices[corners[1]] - vertices[corners[0]], vertices[corners[2]] - vertices[corners[0]];
    const Eigen::Matrix2d inverse = jacobian.inverse();
    const double det = jacobian.determinant();
    const double scale = 1 / std::sqrt(det);
    if (det > largest_det)
    {
      largest = k;
      largest_det = det;
    }
    for (int c = 0; c < 2; ++c)
      for (int i = 0; i < n; ++i)
      {
        const int column = (2 * k + c) * n + i;
        for (int j = 0; j < n_div; ++j)
          entries.emplace_back(
              k * n_div + j, column,
              inverse(0, c) * reference.derivative[0](j, i) + inverse(1, c) * reference.derivative[1](j, i));
        for (int e = 0; e < 3; ++e)
        {
          const int a = corners[e];
          const int b = corners[(e + 1) % 3];
          const Point<2> along = (vertices[b] - vertices[a]).normalized();
          const double normal = c == 0 ? along[1] : -along[0];  // outward
          const int first = n_moments_ + edges(a, b) * (degree + 2);
          for (int j = 0; j < degree + 2; ++j)
          {
            const double turned = a > b && j % 2 == 1 ? -1 : 1;
            entries.emplace_back(first + j, column, turned * normal * scale * reference.edge[e](j, i));
          }
        }
      }
  }
  conditions_.resize(n_moments_ + edges.size() * (degree + 2), 2 * n * n_triangles);
  conditions_.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseMatrix<double> square = conditions_ * conditions_.transpose();
  // The integral of a divergence is the flux through the rim, so one condition follows from the others. With
  // a larger diagonal entry its multiplier is 0, and the solution the same. The largest triangle is the best
  // choice.
  square.coeffRef(largest * n_div, largest * n_div) *= 2;
  factors_.compute(square);
}

std::optional<Eigen::MatrixXd> FacetFlux::with_divergence(const Eigen::MatrixXd& moments) const
{
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(conditions_.rows(), moments.cols());
  conditions.topRows(n_moments_) = moments;
  return smallest(conditions, moments.norm());
}

std::optional<Eigen::MatrixXd> FacetFlux::without_circulation(const Eigen::MatrixXd& field, double size) const
{
  return smallest(conditions_ * field, size);
}

/// Uses iterative refinement: narrow triangles spoil the factors.
std::optional<Eigen::MatrixXd> FacetFlux::smallest(const Eigen::MatrixXd& conditions, double size) const
{
  constexpr double rounding = 1e-10;
  constexpr int max_refinements = 5;
  if (factors_.info() != Eigen::Success) return {};
  Eigen::MatrixXd field = Eigen::MatrixXd::Zero(conditions_.cols(), conditions.cols());
  Eigen::MatrixXd rest = conditions;
  for (int i = 0; i <= max_refinements; ++i)
  {
    field += conditions_.transpose() * factors_.solve(rest);
    rest = conditions - conditions_ * field;
    if (rest.norm() <= rounding * size) return field;
  }
  return {};
}

}  // namespace tribound::certify
