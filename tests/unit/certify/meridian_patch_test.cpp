/// @file meridian_patch_test.cpp
/// The stress on patches of axisymmetric problems against an independent dense solution.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/meridian_patch.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "unit/certify/meridian_testing.h"

namespace tribound::test
{

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A linear form in the unknowns of a patch, and the value that it should have.
struct Row
{
  VectorXd form;
  double value;
};

MatrixXd stacked(const std::vector<Row>& rows)
{
  MatrixXd matrix(rows.size(), rows[0].form.size());
  for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(i) = rows[i].form.transpose();
  return matrix;
}

VectorXd stacked_values(const std::vector<Row>& rows)
{
  VectorXd values(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = rows[i].value;
  return values;
}

/// x with |A x - b| -> min under C x = d, C of any rank.
VectorXd constrained_minimiser(const std::vector<Row>& squares, const std::vector<Row>& constraints)
{
  const Eigen::JacobiSVD<MatrixXd> svd(stacked(constraints), Eigen::ComputeThinU | Eigen::ComputeFullV);
  const VectorXd s = svd.singularValues();
  const Eigen::Index rank = (s.array() > 1e-10 * s[0]).count();
  const VectorXd d = svd.matrixU().leftCols(rank).transpose() * stacked_values(constraints);
  const VectorXd x = svd.matrixV().leftCols(rank) * (d.array() / s.head(rank).array()).matrix();
  EXPECT_LE((stacked(constraints) * x - stacked_values(constraints)).norm(),
            1e-10 * (1 + stacked_values(constraints).norm()));
  const MatrixXd free = svd.matrixV().rightCols(svd.matrixV().cols() - rank);
  const MatrixXd a = stacked(squares) * free;
  const VectorXd rest = stacked_values(squares) - stacked(squares) * x;
  return free.cols() == 0 ? x : x + free * a.colPivHouseholderQr().solve(rest);
}

/// The problem of one row on the patch of one vertex in monomials about it, set down point by point.
class DensePatch
{
 public:
  DensePatch(const MeridianProblem& c, std::span<const double> u, std::span<const Point<2>> t, Index vertex,
             int row)
      : c_(c), u_(u), t_(t), vertex_(vertex), row_(row), q_(c.space.degree() + 1)
  {
    const mesh::Topology<2>& topology = c.mesh.topology();
    for (Index k = topology.vertex_cells_begin[vertex]; k < topology.vertex_cells_begin[vertex + 1]; ++k)
    {
      cells_.push_back(topology.vertex_cells[k]);
      begin_.push_back(begin_.back() + 2 * n_monomials(degree(cells_.back())));
    }
    for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
      if (has_vertex(facet.cell, facet.local) && !on_axis(facet.cell, facet.local) && fixes(facet.tag))
        is_fixed_ = true;
    n_unknowns_ = begin_.back() + (row == 1 && !is_fixed_ ? 1 : 0);
    for (std::size_t k = 0; k < cells_.size(); ++k) add_cell(k);
    x_ = constrained_minimiser(squares_, constraints_);
  }

  [[nodiscard]] std::span<const Index> cells() const { return cells_; }
  /// tau in the k-th of them.
  [[nodiscard]] Point<2> operator()(std::size_t k, const Point<2>& x) const
  {
    return {component(k, 0, x).dot(x_), component(k, 1, x).dot(x_)};
  }

 private:
  static int n_monomials(int degree) { return (degree + 1) * (degree + 2) / 2; }
  [[nodiscard]] bool fixes(int tag) const { return c_.problem.boundary(tag).fixes(row_); }
  [[nodiscard]] bool on_axis(Index cell, int local) const
  {
    const auto ends = mesh::facet_vertices(c_.mesh.cell(cell), local);
    return c_.mesh.vertex(ends[0])[0] == 0 && c_.mesh.vertex(ends[1])[0] == 0;
  }
  [[nodiscard]] bool has_edge_on_axis(Index cell) const
  {
    return on_axis(cell, 0) || on_axis(cell, 1) || on_axis(cell, 2);
  }
  /// Of tau, on cells with an edge on the axis of tau / r.
  [[nodiscard]] int degree(Index cell) const { return has_edge_on_axis(cell) ? q_ - 1 : q_; }
  [[nodiscard]] bool has_vertex(Index cell, int local) const
  {
    const auto ends = mesh::facet_vertices(c_.mesh.cell(cell), local);
    return ends[0] == vertex_ || ends[1] == vertex_;
  }
  /// The form of a component of tau (derivative < 0) or of its derivative at x: sum of (x - a)^i (y - b)^j,
  /// on cells with an edge on the axis times r.
  [[nodiscard]] VectorXd component(std::size_t k, int component, const Point<2>& x, int derivative = -1) const
  {
    VectorXd form = VectorXd::Zero(n_unknowns_);
    const bool times_r = has_edge_on_axis(cells_[k]);
    const int degree = this->degree(cells_[k]);
    const Point<2> z = (x - c_.mesh.vertex(vertex_)) / size();
    int index = begin_[k] + component * n_monomials(degree);
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j, ++index)
      {
        const double value = std::pow(z[0], i) * std::pow(z[1], j);
        double slope = 0;
        if (derivative == 0 && i > 0) slope = i * std::pow(z[0], i - 1) * std::pow(z[1], j) / size();
        if (derivative == 1 && j > 0) slope = j * std::pow(z[0], i) * std::pow(z[1], j - 1) / size();
        if (derivative < 0)
          form[index] = times_r ? x[0] * value : value;
        else
          form[index] = times_r ? x[0] * slope + (derivative == 0 ? value : 0) : slope;
      }
    return form;
  }
  [[nodiscard]] VectorXd divergence(std::size_t k, const Point<2>& x) const
  {
    return component(k, 0, x, 0) + component(k, 1, x, 1);
  }
  [[nodiscard]] VectorXd normal_trace(std::size_t k, const Point<2>& normal, const Point<2>& x) const
  {
    return normal[0] * component(k, 0, x) + normal[1] * component(k, 1, x);
  }
  [[nodiscard]] double size() const { return mesh::cell_diameter(c_.mesh, cells_[0]); }

  /// psi_a and its gradient, the row of sigma and sigma_tt at a point of a cell.
  struct State
  {
    double hat;
    Point<2> hat_gradient;
    Point<2> sigma;
    double hoop;
  };
  [[nodiscard]] State state(Index cell, const Point<2>& xhat) const
  {
    const mesh::CellMap<2> map = mesh::cell_map(c_.mesh, cell);
    const fem::Tabulation<2> table = c_.space.basis().tabulate(std::span(&xhat, 1));
    const Tensor<2> gradient =
        fem::gradient_at<2>(c_.space.cell_nodes(cell), u_, table.gradients_at(0), map.inverse_transpose);
    const double hoop = fem::value_at<2>(c_.space.cell_nodes(cell), u_, table.values_at(0))[0] / map(xhat)[0];
    const problem::Material& material = c_.problem.material(c_.mesh.region(cell));
    const double trace = gradient.trace() + hoop;
    const Tensor<2> sigma =
        material.lambda * trace * Tensor<2>::Identity() + material.mu * (gradient + gradient.transpose());
    const auto a = std::ranges::find(c_.mesh.cell(cell), vertex_) - c_.mesh.cell(cell).begin();
    return {fem::barycentric<2>(xhat)[a], map.barycentric_gradients()[a], sigma.row(row_).transpose(),
            material.lambda * trace + 2 * material.mu * hoop};
  }

  void add_cell(std::size_t k)
  {
    const Index cell = cells_[k];
    const mesh::CellMap<2> map = mesh::cell_map(c_.mesh, cell);
    const fem::MeridianRules rules(c_.mesh, 2 * q_ + 8);
    for (const auto& [q, x, dx] : fem::cell_points(map, rules.of_cell(cell)))
    {
      const State s = state(cell, rules.of_cell(cell).points[q]);
      const double weight = std::sqrt(dx / x[0]);
      for (int i = 0; i < 2; ++i)
        squares_.push_back({weight * component(k, i, x), weight * s.hat * x[0] * s.sigma[i]});
      if (row_ == 1) continue;
      const double load = s.hat * x[0] * c_.problem.body_force(c_.mesh.region(cell), x)[0];
      squares_.push_back(
          {std::sqrt(dx * x[0]) * divergence(k, x),
           std::sqrt(dx * x[0]) * (s.hat * s.hoop - load + x[0] * s.sigma.dot(s.hat_gradient))});
    }
    if (row_ == 1) prescribe_divergence(k);
    for (int local = 0; local < 3; ++local) add_facet(k, local);
  }

  /// div tau + Pi (psi_a r f_z) - r sigma_z . grad psi_a - r y = 0, tested with P^p.
  void prescribe_divergence(std::size_t k)
  {
    const Index cell = cells_[k];
    const mesh::CellMap<2> map = mesh::cell_map(c_.mesh, cell);
    const int p = c_.space.degree();
    const int less = has_edge_on_axis(cell) ? p - 1 : p;
    const fem::Quadrature<2> rule = fem::quadrature<2>(20);
    const int n = n_monomials(less);
    MatrixXd products = MatrixXd::Zero(n, n);
    VectorXd moments = VectorXd::Zero(n);
    std::vector<double> chi(n_monomials(p));
    const auto projected_weight = [&](double r) { return less < p ? r : 1.0; };
    for (const auto& [q, x, dx] : fem::cell_points(map, rule))
    {
      fem::orthonormal_values<2>(p, rule.points[q], chi);
      const Eigen::Map<const VectorXd> theta(chi.data(), n);
      const double f = c_.problem.body_force(c_.mesh.region(cell), x)[1];
      products += dx * projected_weight(x[0]) * theta * theta.transpose();
      moments += dx * x[0] * f * state(cell, rule.points[q]).hat * theta;
    }
    const VectorXd load = products.llt().solve(moments);
    std::vector<Row> rows(n_monomials(p), {VectorXd::Zero(n_unknowns_), 0.0});
    for (const auto& [q, x, dx] : fem::cell_points(map, rule))
    {
      fem::orthonormal_values<2>(p, rule.points[q], chi);
      const State s = state(cell, rule.points[q]);
      const double projected = projected_weight(x[0]) * Eigen::Map<const VectorXd>(chi.data(), n).dot(load);
      VectorXd form = divergence(k, x);
      if (!is_fixed_) form[n_unknowns_ - 1] -= x[0];
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        rows[i].form += dx * chi[i] * form;
        rows[i].value += dx * chi[i] * (x[0] * s.sigma.dot(s.hat_gradient) - projected);
      }
    }
    constraints_.insert(constraints_.end(), rows.begin(), rows.end());
  }

  void add_facet(std::size_t k, int local)
  {
    const Index cell = cells_[k];
    if (on_axis(cell, local)) return;
    const mesh::Topology<2>& topology = c_.mesh.topology();
    const auto& [first, second] = topology.facet_cells[topology.cell_facets[cell][local]];
    const Point<2> normal = mesh::facet_geometry(c_.mesh, cell, local).normal;
    const bool is_rim = !has_vertex(cell, local);
    const auto other = std::ranges::find(cells_, first == cell ? second : first) - cells_.begin();
    if (!is_rim && second >= 0 && static_cast<std::size_t>(other) < k) return;
    std::optional<std::size_t> boundary;
    for (std::size_t i = 0; i < c_.mesh.boundary().size(); ++i)
      if (c_.mesh.boundary()[i].cell == cell && c_.mesh.boundary()[i].local == local) boundary = i;
    if (!is_rim && boundary && fixes(c_.mesh.boundary()[*boundary].tag)) return;
    const VectorXd traction = is_rim || !boundary ? VectorXd() : projected_traction(*boundary);
    const mesh::FacetMap<2> map = mesh::facet_map(c_.mesh, cell, local);
    for (int i = 0; i <= q_; ++i)
    {
      const double s = (i + 0.5) / (q_ + 1);
      const Point<2> x = map(Point<1>(s));
      Row row{normal_trace(k, normal, x), 0.0};
      if (!is_rim && second >= 0) row.form -= normal_trace(other, normal, x);
      for (Eigen::Index j = 0; j < traction.size(); ++j) row.value += x[0] * traction[j] * std::pow(s, j);
      constraints_.push_back(row);
    }
  }

  /// The projection with the weight r of psi_a t onto P^p, in powers of s.
  [[nodiscard]] VectorXd projected_traction(std::size_t number) const
  {
    const mesh::BoundaryFacet& facet = c_.mesh.boundary()[number];
    const fem::Quadrature<1>& rule = c_.form.facet_rule();
    std::vector<Point<2>> g(rule.size(), Point<2>::Zero());
    if (c_.form.data().has_traction(number)) c_.form.data().traction(number, g);
    for (std::size_t k = 0; k < c_.form.segments().size(); ++k)
      for (int q = 0; c_.form.segments()[k].slave.number == number && q < rule.size(); ++q)
        g[q] = t_[k * rule.size() + q];
    const auto ends = mesh::facet_vertices(c_.mesh.cell(facet.cell), facet.local);
    const int n = c_.space.degree() + 1;
    MatrixXd products = MatrixXd::Zero(n, n);
    VectorXd moments = VectorXd::Zero(n);
    for (const auto& [q, x, dx] : fem::facet_points(c_.mesh, facet.cell, facet.local, rule))
    {
      const double s = rule.points[q][0];
      VectorXd powers(n);
      for (int j = 0; j < n; ++j) powers[j] = std::pow(s, j);
      products += dx * x[0] * powers * powers.transpose();
      moments += dx * x[0] * (ends[0] == vertex_ ? 1 - s : s) * g[q][row_] * powers;
    }
    return products.llt().solve(moments);
  }

  const MeridianProblem& c_;
  std::span<const double> u_;
  std::span<const Point<2>> t_;
  Index vertex_;
  int row_;
  int q_;
  std::vector<Index> cells_;
  std::vector<int> begin_ = {0};  ///< of the unknowns of each cell
  bool is_fixed_ = false;
  int n_unknowns_;
  std::vector<Row> squares_;
  std::vector<Row> constraints_;
  VectorXd x_;
};

/// tau_a of the program in one cell of the patch.
Point<2> value(const certify::SortedCell<2>& sorted, std::span<const double> stress, int row, int degree,
               const Point<2>& x)
{
  std::vector<double> phi(fem::polynomial_dimension(2, degree));
  fem::orthonormal_values<2>(degree, sorted.inverse * (x - sorted.origin), phi);
  Point<2> result = Point<2>::Zero();
  for (int k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < phi.size(); ++j)
      result[k] += stress[(2 * row + k) * phi.size() + j] * phi[j] / std::sqrt(sorted.det);
  return result;
}

void expect_minimisers(const MeridianProblem& c)
{
  const std::vector<double> u = any_displacement(c, 1);
  const std::vector<Point<2>> t = c.form.traction(u);
  const certify::MeridianCellSource source(c.form);
  const certify::MeridianFacets facets(c.form, source.reference(), {t, {}, {}});
  const int degree = c.space.degree() + 1;
  for (Index v = 0; v < c.mesh.n_vertices(); ++v)
    for (int row = 0; row < 2; ++row)
    {
      const DensePatch dense(c, u, t, v, row);
      std::vector<certify::MeridianCell> prepared;
      for (const Index k : dense.cells()) prepared.push_back(source.prepare(k, u));
      std::vector<std::vector<double>> stress(prepared.size());
      std::vector<certify::MeridianPatchCell> cells;
      for (std::size_t k = 0; k < prepared.size(); ++k)
      {
        stress[k].resize(4 * fem::polynomial_dimension(2, degree));
        cells.push_back({dense.cells()[k], &prepared[k], {stress[k]}});
      }
      certify::solve_meridian_patch(c.mesh, source.reference(), facets, v, 0, 1, cells, true);
      double scale = 0;
      double difference = 0;
      for (std::size_t k = 0; k < prepared.size(); ++k)
        for (const Point<2>& xhat : fem::quadrature<2>(4).points)
        {
          const Point<2> x = mesh::cell_map(c.mesh, dense.cells()[k])(xhat);
          scale = std::max(scale, dense(k, x).norm());
          difference = std::max(difference,
                                (dense(k, x) - value(prepared[k].sorted, stress[k], row, degree, x)).norm());
        }
      EXPECT_GT(scale, 0);
      EXPECT_LE(difference, 1e-9 * scale) << "vertex " << v << ", row " << row;
    }
}

class MeridianPatch : public OnMeridians
{
};

TEST_P(MeridianPatch, HasTheMinimiser)
{
  for (const bool held : {false, true})
    expect_minimisers(MeridianProblem(skew_mesh(axis(), 2), pressed(held), {.degree = degree()}));
}

INSTANTIATE_TEST_SUITE_P(Meshes, MeridianPatch, meridians);

}  // namespace

}  // namespace tribound::test
