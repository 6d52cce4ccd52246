/// @file transfer_oscillation_test.cpp
/// What contact tractions lose between meshes that do not match, against test functions of high degree.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/load_oscillation.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

constexpr double rounding = 1e-10;

/// A cell above another one; their facets in the plane x_d = 0 overlap in a part.
template <int dim>
mesh::MeshData<dim> two_cells(std::mt19937& random)
{
  const auto between = [&](double low, double high)
  { return std::uniform_real_distribution<double>(low, high)(random); };
  mesh::MeshData<dim> data;
  data.region_names = {"upper", "lower"};
  data.boundary_names = {"slave", "master", "rest", "rest_below"};
  data.interfaces = {{{{{"slave"}, {"master"}}}}};
  for (const int body : {0, 1})
  {
    const auto first = static_cast<Index>(data.vertices.size());
    for (int i = 0; i < dim; ++i)
    {
      Point<dim> x = Point<dim>::Zero();
      if (i > 0) x[i - 1] = 1;
      for (int a = 0; a + 1 < dim; ++a) x[a] += between(-0.2, 0.2);
      data.vertices.push_back(x);
    }
    Point<dim> apex = Point<dim>::Constant(between(0, 0.5));
    apex[dim - 1] = (body == 0 ? 1 : -1) * between(0.4, 1.2);
    data.vertices.push_back(apex);
    mesh::Cell<dim> cell;
    std::iota(cell.begin(), cell.end(), first);
    if (body == 1) std::swap(cell[0], cell[1]);
    data.cells.push_back(cell);
    data.regions.push_back(body);
    for (int local = 0; local <= dim; ++local)
      data.facets.push_back({mesh::facet_vertices(cell, local), local == dim ? body : 2 + body});
  }
  return data;
}

/// (t, [w])_C - (Pi_F t, w)_S + (Pi_G t, w)_M for the basis functions w of a cell: Pi is formed with
/// monomials.
template <int dim>
std::vector<double> lost(const contact::NitscheForm<dim>& rich, std::span<const double> b, Index cell,
                         int degree)
{
  const mesh::Mesh<dim>& mesh = rich.space().mesh();
  const fem::LagrangeBasis<dim>& basis = rich.space().basis();
  const auto map = mesh::cell_map(mesh, cell);
  const int local = dim;  // the facet in contact
  std::vector<std::array<int, 2>> powers;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree && (dim == 3 || j == 0); ++j) powers.push_back({i, j});
  const auto monomial = [&](std::size_t k, const Point<dim>& x)
  { return std::pow(x[0], powers[k][0]) * (dim == 3 ? std::pow(x[1], powers[k][1]) : 1); };
  const auto n = static_cast<Eigen::Index>(powers.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(basis.n_nodes(), n);
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(degree + basis.degree());
  for (int q = 0; q < rule.size(); ++q)
  {
    const std::vector<Point<dim>> at = {mesh::facet_to_cell<dim>(local, rule.points[q])};
    const fem::Tabulation<dim> table = basis.tabulate(at);
    const Point<dim> x = map(at[0]);
    for (Eigen::Index k = 0; k < n; ++k)
    {
      const double weighted = rule.weights[q] * monomial(k, x);
      for (Eigen::Index l = 0; l < n; ++l) gram(l, k) += weighted * monomial(l, x);
      for (int i = 0; i < basis.n_nodes(); ++i) mixed(i, k) += weighted * table.values_at(0)[i];
    }
  }
  const std::span<const Index> nodes = rich.space().cell_nodes(cell);
  const std::vector<Point<dim>> points = basis.node_points();
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(n, dim);  // b of the monomials
  for (int i = 0; i < basis.n_nodes(); ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      for (int a = 0; a < dim; ++a) moments(k, a) += monomial(k, map(points[i])) * b[dim * nodes[i] + a];
  const Eigen::MatrixXd projected = mixed * CholeskyFactors(gram).solve(moments);
  std::vector<double> result;
  for (int i = 0; i < basis.n_nodes(); ++i)
    for (int a = 0; a < dim; ++a) result.push_back(b[dim * nodes[i] + a] - projected(i, a));
  return result;
}

/// sup of the functional over ||w||_en <= 1 on the cell.
template <int dim>
double dual_norm(const DiscreteProblem<dim>& rich, std::span<const double> functional, Index cell)
{
  const std::span<const Index> nodes = rich.space.cell_nodes(cell);
  const auto n = static_cast<Eigen::Index>(functional.size());
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
  {
    std::vector<double> unit(rich.space.n_dofs(), 0.0);
    unit[dim * nodes[j / dim] + j % dim] = 1;
    const std::vector<double> column = contact::apply_stiffness<dim>(rich.problem, rich.space, unit);
    for (Eigen::Index i = 0; i < n; ++i) k(i, j) = column[dim * nodes[i / dim] + i % dim];
  }
  const SymmetricEigen eigen = symmetric_eigen(k);
  const Eigen::VectorXd parts =
      eigen.vectors.transpose() * Eigen::Map<const Eigen::VectorXd>(functional.data(), n);
  constexpr int n_rigid = dim * (dim + 1) / 2;
  EXPECT_LE(parts.head(n_rigid).norm(), rounding);  // it does no work in rigid motions
  return std::sqrt((parts.tail(n - n_rigid).array().square() / eigen.values.tail(n - n_rigid).array()).sum());
}

template <int dim>
void expect_bound(int degree)
{
  std::mt19937 random(static_cast<unsigned>(10 * dim + degree));
  double smallest = HUGE_VAL;
  double largest = 0;
  for (int trial = 0; trial < 20; ++trial)
  {
    ProblemData<dim> data{.boundaries = {clamped<dim>("rest"), clamped<dim>("rest_below")},
                          .material = problem::lame(1, 0.3),
                          .regions = {{.name = "lower", .material = problem::lame(1, 0.1 * (trial % 5))}},
                          .pairs = {pair<dim>("slave", "master")}};
    const mesh::MeshData<dim> mesh = two_cells<dim>(random);
    const DiscreteProblem<dim> c(mesh, data, {.degree = degree});
    const DiscreteProblem<dim> rich(mesh, data, {.degree = degree + 3});
    const auto traction = [&](const contact::NitscheForm<dim>& form)
    {
      std::vector<Point<dim>> t;
      for (const contact::ContactPoint<dim>& point : form.contact_points())
        t.push_back(Point<dim>::LinSpaced(0.3 + 0.2 * trial * point.x[0], -1 + point.x[0]));
      return t;
    };
    const certify::ContactTerms<dim> terms(c.form, certify::ContactRule::reference);
    const std::vector<double> bound = certify::transfer_oscillation<dim>(c.form, terms, traction(c.form));
    std::vector<double> b(rich.space.n_dofs(), 0.0);
    rich.form.add_contact_load(traction(rich.form), b);
    for (const Index cell : {0, 1})
    {
      const double truth = dual_norm<dim>(rich, lost<dim>(rich.form, b, cell, degree), cell);
      if (truth < rounding) continue;  // the facet is covered by one segment
      smallest = std::min(smallest, bound[cell] / truth);
      largest = std::max(largest, bound[cell] / truth);
    }
  }
  fmt::print("{}D p = {}: bound of the transfer {:.3f} to {:.3f} times a lower one\n", dim, degree, smallest,
             largest);
  EXPECT_GE(smallest, 1);
  EXPECT_LE(smallest, 10);  // so that a bound that is five times halved fails
}

TEST(TransferOscillation, IsAboveWhatTestFunctionsSee)
{
  for (const int degree : {1, 2})
  {
    expect_bound<2>(degree);
    expect_bound<3>(degree);
  }
}

}  // namespace

}  // namespace tribound::test
