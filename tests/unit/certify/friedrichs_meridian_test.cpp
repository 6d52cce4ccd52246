/// @file friedrichs_meridian_test.cpp
/// The constants of bodies of revolution against the largest quotients of polynomials.

#include "tribound/certify/bound/friedrichs_meridian.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "support/generalized_eigen.h"
#include "support/meridian_problem.h"
#include "tribound/certify/bound/constants.h"
#include "tribound/certify/truth/cell_products.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/refine.h"

namespace tribound::test
{

namespace
{

using Triangle = std::array<Point<2>, 3>;

/// One edge or one vertex on the axis, or none.
Triangle random_triangle(int n_on_axis, std::mt19937& random)
{
  std::uniform_real_distribution<double> unit(0, 1);
  Triangle triangle;
  for (int i = 0; i < 3; ++i) triangle[i] = {i < n_on_axis ? 0 : unit(random), unit(random)};
  return triangle;
}

double area(const Triangle& x)
{
  const Point<2> a = x[1] - x[0];
  const Point<2> b = x[2] - x[0];
  return std::abs(a[0] * b[1] - a[1] * b[0]) / 2;
}

/// Integrals of polynomials of degree 6, without constants: r grad phi_i . grad phi_j, and r phi_i phi_j with
/// the mean over the triangle taken away, over the triangle and over the facet opposite to vertex 0.
struct Products
{
  Eigen::MatrixXd gradients;
  Eigen::MatrixXd cell;
  Eigen::MatrixXd facet;
};

Products products(const Triangle& x)
{
  constexpr int degree = 6;
  const int n = fem::polynomial_dimension(2, degree);
  Tensor<2> jacobian;
  jacobian << x[1] - x[0], x[2] - x[0];
  const Tensor<2> inverse_transpose = jacobian.inverse().transpose();
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd cell = gradients;
  Eigen::MatrixXd facet = gradients;
  Eigen::VectorXd means = Eigen::VectorXd::Zero(n);
  double volume = 0;
  double length = 0;
  Eigen::VectorXd on_facet = Eigen::VectorXd::Zero(n);
  std::vector<double> phi(n);
  std::vector<Point<2>> grad(n);
  const auto rule = fem::quadrature<2>(2 * degree + 1);
  for (int q = 0; q < rule.size(); ++q)
  {
    fem::orthonormal_gradients<2>(degree, rule.points[q], phi, grad);
    const double weight = rule.weights[q] * 2 * area(x) * (x[0] + jacobian * rule.points[q])[0];
    Eigen::Matrix2Xd at(2, n);
    for (int i = 0; i < n; ++i) at.col(i) = inverse_transpose * grad[i];
    const Eigen::Map<const Eigen::VectorXd> values(phi.data(), n);
    gradients += weight * at.transpose() * at;
    cell += weight * values * values.transpose();
    means += weight * values;
    volume += weight;
  }
  const auto along = fem::quadrature<1>(2 * degree + 1);
  for (int q = 0; q < along.size(); ++q)
  {
    const double s = along.points[q][0];
    fem::orthonormal_values<2>(degree, {1 - s, s}, phi);
    const double weight = along.weights[q] * (x[2] - x[1]).norm() * ((1 - s) * x[1][0] + s * x[2][0]);
    const Eigen::Map<const Eigen::VectorXd> values(phi.data(), n);
    facet += weight * values * values.transpose();
    on_facet += weight * values;
    length += weight;
  }
  means /= volume;
  facet += length * means * means.transpose() - means * on_facet.transpose() - on_facet * means.transpose();
  cell -= volume * means * means.transpose();
  const auto rest = Eigen::seqN(1, n - 1);  // the first of the basis is constant
  return {gradients(rest, rest), cell(rest, rest), facet(rest, rest)};
}

double largest(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  return std::sqrt(generalized_eigen(a, b).values.maxCoeff());
}

TEST(MeridianConstants, BoundThoseOfTriangles)
{
  std::mt19937 random(47);
  double closest = 0;
  for (int i = 0; i < 400; ++i)
  {
    const Triangle x = random_triangle(i % 3, random);
    if (area(x) < 1e-3) continue;
    const double h = mesh::diameter(x);
    const Products of = products(x);
    EXPECT_LE(largest(of.cell, of.gradients), certify::poincare_constant(h)) << i;
    const double bound = certify::meridian_trace_constant(h, (x[2] - x[1]).norm(), area(x));
    const double found = largest(of.facet, of.gradients);
    EXPECT_LE(found, bound) << i;
    closest = std::max(closest, found / bound);
  }
  EXPECT_GT(closest, 0.5);
}

/// The largest ||v_r|| / ||v||_{C,h} or ||v_z|| / ||v||_{C,h} in P^2, h_F of the mesh times 2^refinements.
double largest_quotient(const problem::Problem<2>& problem, const mesh::Mesh<2>& mesh, int component,
                        double scale)
{
  const fem::LagrangeSpace<2> space(mesh, 2);
  const fem::Constraints constraints = fem::dirichlet(problem, space);
  const certify::CellProducts<2> cells(problem, space);
  const auto n_cell = static_cast<std::size_t>(space.basis().n_nodes());
  Eigen::MatrixXd norm = Eigen::MatrixXd::Zero(space.n_nodes(), space.n_nodes());
  Eigen::MatrixXd mass = norm;
  const auto rule = fem::quadrature<2>(5);
  const auto table = space.basis().tabulate(rule.points);
  std::vector<double> block(n_cell * n_cell);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    cells(c, component, block);
    const std::span<const Index> nodes = space.cell_nodes(c);
    for (std::size_t i = 0; i < n_cell; ++i)
      for (std::size_t j = 0; j < n_cell; ++j) norm(nodes[i], nodes[j]) += block[i * n_cell + j];
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, c), rule))
      for (std::size_t i = 0; i < n_cell; ++i)
        for (std::size_t j = 0; j < n_cell; ++j)
          mass(nodes[i], nodes[j]) += dx * x[0] * table.values_at(q)[i] * table.values_at(q)[j];
  }
  const auto on_facets = fem::quadrature<1>(5);
  const auto tables = fem::tabulate_on_facets<2>(space.basis(), on_facets.points);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (!problem.boundary(facet.tag).contact) continue;
    const double h = scale * mesh::facet_geometry(mesh, facet.cell, facet.local).diameter;
    const std::span<const Index> nodes = space.cell_nodes(facet.cell);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, on_facets))
    {
      const std::span<const double> phi = tables.on_facet[facet.local].values_at(q);
      for (std::size_t i = 0; i < n_cell; ++i)
        for (std::size_t j = 0; j < n_cell; ++j) norm(nodes[i], nodes[j]) += dx / h * x[0] * phi[i] * phi[j];
    }
  }
  std::vector<Index> free;
  for (Index i = 0; i < space.n_nodes(); ++i)
    if (!constraints.fixed[2 * i + component]) free.push_back(i);
  return largest(mass(free, free), norm(free, free));
}

TEST(MeridianConstants, FriedrichsBoundsQuotients)
{
  const std::vector<std::vector<problem::BoundaryCondition<2>>> supports = {
      {obstacle<2>("bottom")},
      {obstacle<2>("right")},
      {fixed<2>("top", free, 0.0)},
      {fixed<2>("right", 0.0, 0.0), obstacle<2>("bottom")},
      {fixed<2>("bottom", free, 0.0), obstacle<2>("top")}};
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const double inner = seed % 2 == 0 ? 0 : 0.02 * seed;
    const mesh::Mesh<2> mesh(random_meridian(inner, 3, seed));
    const problem::Problem<2> problem =
        ProblemData<2>{.boundaries = supports[seed % supports.size()]}.on(mesh).axisymmetric();
    const double bound = certify::meridian_friedrichs(problem, mesh);
    const mesh::Refined<2> refined = mesh::refine_uniformly(mesh);
    double found = 0;
    for (const int component : {0, 1})
    {
      found = std::max(found, largest_quotient(problem, mesh, component, 1));
      EXPECT_LE(largest_quotient(problem, refined.mesh, component, 1), bound) << seed;
    }
    EXPECT_LE(found, bound) << seed;
    EXPECT_GT(found, 0.05 * bound) << seed;
  }
}

/// A ring that only contact holds moves along the axis: v_z = 1 on it, and 0 on the ring inside.
TEST(MeridianConstants, FriedrichsBoundsWhatContactHolds)
{
  for (const int n_outer : {3, 4, 7})
  {
    mesh::MeshData<2> data =
        side_by_side(box<2>({0.5, 0}, {1, 1}, {3, 3}), box<2>({1, 0.1}, {2, 1.2}, {2, n_outer}), "_outer");
    data.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
    ProblemData<2> rings{.boundaries = {fixed<2>("bottom", free, 0.0)}};
    rings.pairs = {pair<2>("right", "left_outer")};
    const mesh::Mesh<2> mesh(std::move(data));
    const problem::Problem<2> problem = rings.on(mesh).axisymmetric();
    double jump = 0;
    for (const contact::ContactSegment<2>& segment : contact::contact_segments(problem, mesh, 1.0))
      jump += segment.measure / segment.h;  // r = 1
    const double square = 1.1 * (4 - 1) / 2;
    EXPECT_GE(certify::meridian_friedrichs(problem, mesh), std::sqrt(square / jump)) << n_outer;
    EXPECT_LE(certify::meridian_friedrichs(problem, mesh), 20 * std::sqrt(square / jump)) << n_outer;
  }
}

TEST(MeridianConstants, NoFriedrichsWithoutHold)
{
  const mesh::Mesh<2> mesh(random_meridian(0.5, 2, 1));
  const auto constant = [&](const std::vector<problem::BoundaryCondition<2>>& boundaries)
  {
    return certify::meridian_friedrichs(ProblemData<2>{.boundaries = boundaries}.on(mesh).axisymmetric(),
                                        mesh);
  };
  EXPECT_TRUE(std::isinf(constant({})));
  EXPECT_TRUE(std::isinf(constant({fixed<2>("left", 0.0, free)})));
  EXPECT_TRUE(std::isfinite(constant({fixed<2>("left", free, 0.0)})));
}

}  // namespace

}  // namespace tribound::test
