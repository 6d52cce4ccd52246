#pragma once

/// @file dense_meridian_patch.h
/// The stress on a patch of an axisymmetric problem by an independent dense solution.

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "unit/certify/constrained_minimiser.h"
#include "unit/certify/meridian_testing.h"

namespace tribound::test
{

/// The problem of the rows from first_row on up to end_row, weakly symmetric if there are two, on the patch
/// of one vertex in monomials about it, set down point by point. `turning`: K of each cell of the mesh.
class DenseMeridianPatch
{
 public:
  DenseMeridianPatch(const MeridianProblem& c, std::span<const double> u, std::span<const Point<2>> t,
                     Index vertex, int first_row, int end_row, std::span<const double> turning = {})
      : c_(c),
        u_(u),
        t_(t),
        vertex_(vertex),
        first_row_(first_row),
        n_rows_(end_row - first_row),
        turning_(turning),
        q_(c.space.degree() + 1)
  {
    const mesh::Topology<2>& topology = c.mesh.topology();
    for (Index k = topology.vertex_cells_begin[vertex]; k < topology.vertex_cells_begin[vertex + 1]; ++k)
    {
      cells_.push_back(topology.vertex_cells[k]);
      begin_.push_back(begin_.back() + 2 * n_rows_ * n_monomials(degree(cells_.back())));
    }
    for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
      if (has_vertex(facet.cell, facet.local) && !on_axis(facet.cell, facet.local) && fixes(facet.tag, 1))
        is_fixed_ = true;
    n_unknowns_ = begin_.back() + (end_row == 2 && !is_fixed_ ? 1 : 0);
    for (std::size_t k = 0; k < cells_.size(); ++k) add_cell(k);
    x_ = constrained_minimiser(squares_, constraints_);
  }

  [[nodiscard]] std::span<const Index> cells() const { return cells_; }
  /// A row of tau in the k-th of them.
  [[nodiscard]] Point<2> operator()(std::size_t k, int row, const Point<2>& x) const
  {
    return {component(k, row, 0, x).dot(x_), component(k, row, 1, x).dot(x_)};
  }

 private:
  static int n_monomials(int degree) { return (degree + 1) * (degree + 2) / 2; }
  [[nodiscard]] bool fixes(int tag, int row) const { return c_.problem.boundary(tag).fixes(row); }
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
  [[nodiscard]] Eigen::VectorXd component(std::size_t k, int row, int component, const Point<2>& x,
                                          int derivative = -1) const
  {
    Eigen::VectorXd form = Eigen::VectorXd::Zero(n_unknowns_);
    const bool times_r = has_edge_on_axis(cells_[k]);
    const int degree = this->degree(cells_[k]);
    const Point<2> z = (x - c_.mesh.vertex(vertex_)) / size();
    int index = begin_[k] + (2 * (row - first_row_) + component) * n_monomials(degree);
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
  [[nodiscard]] Eigen::VectorXd divergence(std::size_t k, int row, const Point<2>& x) const
  {
    return component(k, row, 0, x, 0) + component(k, row, 1, x, 1);
  }
  [[nodiscard]] Eigen::VectorXd normal_trace(std::size_t k, int row, const Point<2>& normal,
                                             const Point<2>& x) const
  {
    return normal[0] * component(k, row, 0, x) + normal[1] * component(k, row, 1, x);
  }
  [[nodiscard]] double size() const { return mesh::cell_diameter(c_.mesh, cells_[0]); }

  /// psi_a and its gradient, sigma and sigma_tt at a point of a cell.
  struct State
  {
    double hat;
    Point<2> hat_gradient;
    Tensor<2> sigma;
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
    return {fem::barycentric<2>(xhat)[a], map.barycentric_gradients()[a], sigma,
            material.lambda * trace + 2 * material.mu * hoop};
  }

  void add_cell(std::size_t k)
  {
    const Index cell = cells_[k];
    const fem::MeridianRules rules(c_.mesh, 2 * q_ + 8);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(c_.mesh, cell), rules.of_cell(cell)))
    {
      const State s = state(cell, rules.of_cell(cell).points[q]);
      if (n_rows_ == 2)
        add_compliance(k, s, x, dx);
      else
        add_row_squares(k, s, x, dx);
    }
    if (first_row_ + n_rows_ == 2) prescribe_divergence(k);
    if (n_rows_ == 2) prescribe_symmetry(k);
    for (int local = 0; local < 3; ++local)
      for (int row = first_row_; row < first_row_ + n_rows_; ++row) add_facet(k, local, row);
  }

  void add_row_squares(std::size_t k, const State& s, const Point<2>& x, double dx)
  {
    const int row = first_row_;
    const double weight = std::sqrt(dx / x[0]);
    for (int i = 0; i < 2; ++i)
      squares_.push_back({weight * component(k, row, i, x), weight * s.hat * x[0] * s.sigma(row, i)});
    if (row == 0)
      squares_.push_back(
          {std::sqrt(dx * x[0]) * divergence(k, 0, x), std::sqrt(dx * x[0]) * hoop_target(k, s, x)});
  }

  /// div tau_r where the hoop stress is psi_a sigma_tt.
  [[nodiscard]] double hoop_target(std::size_t k, const State& s, const Point<2>& x) const
  {
    const double load = s.hat * x[0] * c_.problem.body_force(c_.mesh.region(cells_[k]), x)[0];
    return s.hat * s.hoop - load + x[0] * s.sigma.row(0).dot(s.hat_gradient) + turn(k, x)[0];
  }

  /// K (x - x_T).
  [[nodiscard]] Point<2> turn(std::size_t k, const Point<2>& x) const
  {
    if (turning_.empty()) return Point<2>::Zero();
    Point<2> arm = x;
    for (const Index v : c_.mesh.cell(cells_[k])) arm -= c_.mesh.vertex(v) / 3;
    return turning_[cells_[k]] * Point<2>(-arm[1], arm[0]);
  }

  /// 1/(2 mu) (|d|^2 + s^2 - kappa (tr d + s)^2) / r: the part of (d_rr, d_zz, s) along (1, 1, 1) has the
  /// factor 1 - 3 kappa.
  void add_compliance(std::size_t k, const State& s, const Point<2>& x, double dx)
  {
    const problem::Material& material = c_.problem.material(c_.mesh.region(cells_[k]));
    const double kappa = material.lambda / (2 * material.mu + 3 * material.lambda);
    const double weight = std::sqrt(dx / (2 * material.mu * x[0]));
    const auto entry = [&](int row, int i) {
      return Row{weight * component(k, row, i, x), weight * s.hat * x[0] * s.sigma(row, i)};
    };
    squares_.push_back(entry(0, 1));
    squares_.push_back(entry(1, 0));
    std::array<Row, 3> normal = {
        entry(0, 0), entry(1, 1),
        Row{weight * x[0] * divergence(k, 0, x), weight * x[0] * hoop_target(k, s, x)}};
    const Row sum{normal[0].form + normal[1].form + normal[2].form,
                  normal[0].value + normal[1].value + normal[2].value};
    const double share = (1 - std::sqrt(1 - 3 * kappa)) / 3;
    for (Row& row : normal) squares_.push_back({row.form - share * sum.form, row.value - share * sum.value});
  }

  /// (tau, W) = 0 for skew W in P^p, on cells with an edge on the axis in P^{p-1}.
  void prescribe_symmetry(std::size_t k)
  {
    const int degree = has_edge_on_axis(cells_[k]) ? q_ - 2 : q_ - 1;
    std::vector<Row> rows(n_monomials(degree), {Eigen::VectorXd::Zero(n_unknowns_), 0.0});
    std::vector<double> chi(rows.size());
    const fem::Quadrature<2> rule = fem::quadrature<2>(20);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(c_.mesh, cells_[k]), rule))
    {
      fem::orthonormal_values<2>(degree, rule.points[q], chi);
      for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].form += dx * chi[i] * (component(k, 0, 1, x) - component(k, 1, 0, x));
    }
    constraints_.insert(constraints_.end(), rows.begin(), rows.end());
  }

  /// div tau + Pi (psi_a r f_z) - r sigma_z . grad psi_a - r y - K (x - x_T) = 0, tested with P^p.
  void prescribe_divergence(std::size_t k)
  {
    const Index cell = cells_[k];
    const mesh::CellMap<2> map = mesh::cell_map(c_.mesh, cell);
    const int p = c_.space.degree();
    const int less = has_edge_on_axis(cell) ? p - 1 : p;
    const fem::Quadrature<2> rule = fem::quadrature<2>(20);
    const int n = n_monomials(less);
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd moments = Eigen::VectorXd::Zero(n);
    std::vector<double> chi(n_monomials(p));
    const auto projected_weight = [&](double r) { return less < p ? r : 1.0; };
    for (const auto& [q, x, dx] : fem::cell_points(map, rule))
    {
      fem::orthonormal_values<2>(p, rule.points[q], chi);
      const Eigen::Map<const Eigen::VectorXd> theta(chi.data(), n);
      const double f = c_.problem.body_force(c_.mesh.region(cell), x)[1];
      products += dx * projected_weight(x[0]) * theta * theta.transpose();
      moments += dx * x[0] * f * state(cell, rule.points[q]).hat * theta;
    }
    const Eigen::VectorXd load = products.llt().solve(moments);
    std::vector<Row> rows(n_monomials(p), {Eigen::VectorXd::Zero(n_unknowns_), 0.0});
    for (const auto& [q, x, dx] : fem::cell_points(map, rule))
    {
      fem::orthonormal_values<2>(p, rule.points[q], chi);
      const State s = state(cell, rule.points[q]);
      const double projected =
          projected_weight(x[0]) * Eigen::Map<const Eigen::VectorXd>(chi.data(), n).dot(load);
      Eigen::VectorXd form = divergence(k, 1, x);
      if (!is_fixed_) form[n_unknowns_ - 1] -= x[0];
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        rows[i].form += dx * chi[i] * form;
        rows[i].value +=
            dx * chi[i] * (x[0] * s.sigma.row(1).dot(s.hat_gradient) - projected + turn(k, x)[1]);
      }
    }
    constraints_.insert(constraints_.end(), rows.begin(), rows.end());
  }

  void add_facet(std::size_t k, int local, int row)
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
    if (!is_rim && boundary && fixes(c_.mesh.boundary()[*boundary].tag, row)) return;
    const Eigen::VectorXd traction =
        is_rim || !boundary ? Eigen::VectorXd() : projected_traction(*boundary, row);
    const mesh::FacetMap<2> map = mesh::facet_map(c_.mesh, cell, local);
    for (int i = 0; i <= q_; ++i)
    {
      const double s = (i + 0.5) / (q_ + 1);
      const Point<2> x = map(Point<1>(s));
      Row condition{normal_trace(k, row, normal, x), 0.0};
      if (!is_rim && second >= 0) condition.form -= normal_trace(other, row, normal, x);
      for (Eigen::Index j = 0; j < traction.size(); ++j)
        condition.value += x[0] * traction[j] * std::pow(s, j);
      constraints_.push_back(condition);
    }
  }

  /// The projection with the weight r of psi_a t onto P^p, in powers of s.
  [[nodiscard]] Eigen::VectorXd projected_traction(std::size_t number, int row) const
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
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd moments = Eigen::VectorXd::Zero(n);
    for (const auto& [q, x, dx] : fem::facet_points(c_.mesh, facet.cell, facet.local, rule))
    {
      const double s = rule.points[q][0];
      Eigen::VectorXd powers(n);
      for (int j = 0; j < n; ++j) powers[j] = std::pow(s, j);
      products += dx * x[0] * powers * powers.transpose();
      moments += dx * x[0] * (ends[0] == vertex_ ? 1 - s : s) * g[q][row] * powers;
    }
    return products.llt().solve(moments);
  }

  const MeridianProblem& c_;
  std::span<const double> u_;
  std::span<const Point<2>> t_;
  Index vertex_;
  int first_row_;
  int n_rows_;
  std::span<const double> turning_;
  int q_;
  std::vector<Index> cells_;
  std::vector<int> begin_ = {0};  ///< of the unknowns of each cell
  bool is_fixed_ = false;         ///< the axial component on a facet at the vertex
  int n_unknowns_;
  std::vector<Row> squares_;
  std::vector<Row> constraints_;
  Eigen::VectorXd x_;
};

}  // namespace tribound::test
