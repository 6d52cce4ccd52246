#include "tribound/certify/bound/poincare_korn.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/constants.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// |A|, the largest singular value.
template <int dim>
double spectral_norm(const Tensor<dim>& a)
{
  Eigen::SelfAdjointEigenSolver<Tensor<dim>> eigen;
  eigen.computeDirect(a.transpose() * a, Eigen::EigenvaluesOnly);
  return std::sqrt(eigen.eigenvalues()[dim - 1]);
}

/// The squares of |grad lambda_i| = |F_i| / (dim |T|) for a simplex whose path of edges has these columns:
/// lambda_i grows by 1 along edge i - 1 and falls by 1 along edge i.
template <int dim>
std::array<double, dim + 1> squared_gradients(const Tensor<dim>& inverse)
{
  std::array<double, dim + 1> result;
  result[0] = inverse.row(0).squaredNorm();
  for (int i = 1; i < dim; ++i) result[i] = (inverse.row(i - 1) - inverse.row(i)).squaredNorm();
  result[dim] = inverse.row(dim - 1).squaredNorm();
  return result;
}

/// A simplex on which constants are known, as the path of its edges v_1, v_2, ...
template <int dim>
struct HillSimplex
{
  explicit HillSimplex(const KornConstants<dim>& known) : constants(known)
  {
    Tensor<dim> gram = Tensor<dim>::Constant(known.gram);
    gram.diagonal().setOnes();
    edges = CholeskyFactors(gram).lower().transpose();
    gradients = squared_gradients<dim>(edges.inverse());
  }

  KornConstants<dim> constants;
  Tensor<dim> edges;
  std::array<double, dim + 1> gradients;
};

/// With x = F xhat and w = F^{-T} what, eps(w) = F^{-T} eps(what) F^{-1}, and rigid motions are those of the
/// reference simplex: both constants grow by |F|^2 |F^{-1}|, those of facets also by the square root of the
/// ratio of |F_i| / |T|.
template <int dim>
void improve(PoincareKorn<dim>& best, const HillSimplex<dim>& reference, const Tensor<dim>& edges,
             const std::array<int, dim + 1>& order)
{
  const Tensor<dim> inverse = edges.inverse();
  const double stretch = spectral_norm<dim>(edges * reference.edges.inverse());
  const double factor = stretch * stretch * spectral_norm<dim>(reference.edges * inverse);
  best.cell = std::min(best.cell, factor * reference.constants.cell);
  const std::array<double, dim + 1> gradients = squared_gradients<dim>(inverse);
  for (int i = 0; i <= dim; ++i)
  {
    const double ratio = std::sqrt(gradients[i] / reference.gradients[i]);
    double& facet = best.facets[order[i]];
    facet = std::min(facet, factor * std::sqrt(ratio) * reference.constants.facets[i]);
    double& trace = best.traces[order[i]];
    trace = std::min(trace, factor * std::sqrt(ratio) * reference.constants.trace);
  }
}

/// ||grad w||_T <= K_T ||eps(w)||_T for w without mean rotation, K_T = 2^{1/2} / sin(theta_min / 4), times
/// Poincare's constants.
PoincareKorn<2> by_angles(const std::array<Point<2>, 3>& vertices)
{
  double smallest = std::numbers::pi;
  for (int i = 0; i < 3; ++i)
  {
    const Point<2> a = vertices[(i + 1) % 3] - vertices[i];
    const Point<2> b = vertices[(i + 2) % 3] - vertices[i];
    smallest = std::min(smallest, std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0)));
  }
  const double korn = std::numbers::sqrt2 / std::sin(smallest / 4);
  const double h = mesh::diameter(vertices);
  const double area = std::abs(mesh::determinant<2>(vertices)) / 2;
  PoincareKorn<2> result{.cell = korn * poincare_constant_of_triangle(h), .facets = {}, .traces = {}};
  for (int i = 0; i < 3; ++i)
    result.facets[i] =
        korn * trace_constant<2>(h, (vertices[(i + 1) % 3] - vertices[(i + 2) % 3]).norm(), area);
  return result;
}

template <int dim>
const std::array<HillSimplex<dim>, 2>& hill_simplices()
{
  if constexpr (dim == 2)
  {
    static const std::array<HillSimplex<2>, 2> triangles{HillSimplex<2>(right_triangle),
                                                         HillSimplex<2>(equilateral_triangle)};
    return triangles;
  }
  else
  {
    static const std::array<HillSimplex<3>, 2> tetrahedra{HillSimplex<3>(path_tetrahedron),
                                                          HillSimplex<3>(disphenoid)};
    return tetrahedra;
  }
}

}  // namespace

template <int dim>
PoincareKorn<dim> poincare_korn(const std::array<Point<dim>, dim + 1>& vertices)
{
  PoincareKorn<dim> best{.cell = HUGE_VAL, .facets = {}, .traces = {}};
  best.facets.fill(HUGE_VAL);
  if constexpr (dim == 2) best = by_angles(vertices);
  best.traces.fill(HUGE_VAL);
  std::array<int, dim + 1> order;
  std::iota(order.begin(), order.end(), 0);
  do
  {
    if (order[0] > order[dim]) continue;  // a path and its reverse are congruent on Hill's simplices
    Tensor<dim> edges;
    for (int i = 0; i < dim; ++i) edges.col(i) = vertices[order[i + 1]] - vertices[order[i]];
    for (const HillSimplex<dim>& reference : hill_simplices<dim>())
      improve<dim>(best, reference, edges, order);
  } while (std::ranges::next_permutation(order).found);
  return best;
}

template PoincareKorn<2> poincare_korn(const std::array<Point<2>, 3>&);
template PoincareKorn<3> poincare_korn(const std::array<Point<3>, 4>&);

}  // namespace tribound::certify
