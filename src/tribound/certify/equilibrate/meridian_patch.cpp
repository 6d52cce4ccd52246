#include "tribound/certify/equilibrate/meridian_patch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tribound/certify/equilibrate/too_flat.h"

namespace tribound::certify
{

namespace
{

using Eigen::MatrixXd;

/// The problem of one row.
class MeridianRow
{
 public:
  MeridianRow(const mesh::Mesh<2>& mesh, const MeridianReference& reference, const MeridianFacets& facets,
              Index vertex, int first_part, int end_part, std::span<const MeridianPatchCell> cells, int row)
      : mesh_(mesh),
        reference_(reference),
        facets_(facets),
        vertex_(vertex),
        first_part_(first_part),
        n_parts_(end_part - first_part),
        cells_(cells),
        row_(row)
  {
  }

  void solve();

 private:
  /// A facet at the vertex whose normal trace is prescribed.
  struct Facet
  {
    Index number;
    double scale;  ///< |F|
    int first;     ///< of its multipliers
    int size;
  };
  /// A cell without d, eta and the multiplier of the rim. Products with M^{-1} are those of columns times
  /// L^{-1}.
  struct Eliminated
  {
    MatrixXd local;                ///< L^{-1} (B^T, N^T) with the N of the rim
    MatrixXd outer;                ///< L^{-1} N^T of the facets at the vertex
    CholeskyFactors factors;       ///< of (B, N) M^{-1} (B, N)^T + C
    MatrixXd coupling;             ///< their L^{-1} (B, N) M^{-1} N^T
    MatrixXd load;                 ///< their L^{-1} (k, 0), a column for each part
    std::vector<int> multipliers;  ///< of the facets at the vertex
  };

  void number_facets();
  void make_compatible();
  [[nodiscard]] Eliminated eliminate(const MeridianPatchCell& cell) const;
  [[nodiscard]] MatrixXd divergence_data(const MeridianCell& cell, int vertex) const;
  void add_to_system(const MeridianPatchCell& cell, const Eliminated& eliminated);
  void add_tractions();
  void recover(const MeridianPatchCell& cell, const Eliminated& eliminated, const MatrixXd& mu) const;

  [[nodiscard]] const Facet* find(Index facet) const
  {
    const auto found = std::ranges::find(at_vertex_, facet, &Facet::number);
    return found == at_vertex_.end() ? nullptr : &*found;
  }
  /// The facet opposite to a vertex of a cell.
  [[nodiscard]] Index facet(const MeridianPatchCell& cell, int opposite) const
  {
    return mesh_.topology().cell_facets[cell.cell][cell.prepared->sorted.local[opposite]];
  }
  /// psi_a r sigma(u) in P^q, by component.
  [[nodiscard]] MatrixXd target(const MeridianCell& cell, int vertex) const
  {
    MatrixXd result(reference_.n_stress, 2);
    for (int k = 0; k < 2; ++k) result.col(k) = reference_.hat[vertex] * cell.sigma[row_][k];
    return result;
  }
  /// Whether there is a part with u and f; it is the first one.
  [[nodiscard]] bool has_dis() const { return first_part_ == 0; }
  [[nodiscard]] const MatrixXd* traction(const Facet& facet, int column) const
  {
    const int end = mesh_.topology().facets[facet.number][0] == vertex_ ? 0 : 1;
    return facets_.trace(facet.number, first_part_ + column, end);
  }

  const mesh::Mesh<2>& mesh_;
  const MeridianReference& reference_;
  const MeridianFacets& facets_;
  const Index vertex_;
  const int first_part_;
  const int n_parts_;
  const std::span<const MeridianPatchCell> cells_;
  const int row_;
  std::vector<Facet> at_vertex_;
  bool is_fixed_ = false;  ///< whether a facet at the vertex fixes the component
  int n_multipliers_ = 0;
  Eigen::RowVectorXd y_;
  MatrixXd matrix_;
  MatrixXd load_;
};

void MeridianRow::solve()
{
  number_facets();
  make_compatible();
  matrix_ = MatrixXd::Zero(n_multipliers_, n_multipliers_);
  load_ = MatrixXd::Zero(n_multipliers_, n_parts_);
  std::vector<Eliminated> eliminated;
  for (const MeridianPatchCell& cell : cells_)
  {
    eliminated.push_back(eliminate(cell));
    add_to_system(cell, eliminated.back());
  }
  add_tractions();
  // Multipliers that are the trace of a constant change nothing in the axial row: a term on one facet, which
  // the solution, the data being compatible, does not feel.
  if (row_ == 1 && !is_fixed_) matrix_(0, 0) += matrix_.trace() / n_multipliers_;
  MatrixXd mu(n_multipliers_, n_parts_);
  if (n_multipliers_ > 0)
  {
    const CholeskyFactors factors(matrix_);
    if (!factors.is_definite())
    {
      double worst = 0;
      for (const MeridianPatchCell& cell : cells_)
        worst = std::max(worst, slenderness(cell.prepared->sorted));
      throw no_equilibrated_stress<2>(mesh_.vertex(vertex_), worst);
    }
    mu = factors.solve(load_);
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) recover(cells_[i], eliminated[i], mu);
}

/// Where all cells of a facet have an edge on the axis, normal traces are r P^p: their moments on P^p
/// suffice.
void MeridianRow::number_facets()
{
  for (const MeridianPatchCell& cell : cells_)
    for (int f = 0; f < 3; ++f)
    {
      const MeridianCell& prepared = *cell.prepared;
      const Index number = facet(cell, f);
      if (prepared.sorted.vertices[f] == vertex_ || prepared.is_on_axis(f)) continue;
      if (facets_.fixes(number, row_))
      {
        is_fixed_ = true;
        continue;
      }
      const auto found = std::ranges::find(at_vertex_, number, &Facet::number);
      if (found == at_vertex_.end())
        at_vertex_.push_back({number, prepared.sorted.facet_scale(f), 0,
                              reference_.n_facet - (prepared.has_edge_on_axis ? 1 : 0)});
      else if (!prepared.has_edge_on_axis)
        found->size = reference_.n_facet;
    }
  for (Facet& facet : at_vertex_)
  {
    facet.first = n_multipliers_;
    n_multipliers_ += facet.size;
  }
}

void MeridianRow::make_compatible()
{
  y_ = Eigen::RowVectorXd::Zero(n_parts_);
  if (row_ == 0 || is_fixed_) return;
  double integral = 0;
  for (const MeridianPatchCell& cell : cells_)
  {
    const MeridianCell& prepared = *cell.prepared;
    integral += prepared.radius_integral;
    if (!has_dis()) continue;
    const int a = prepared.sorted.find(vertex_);
    double load = -prepared.body[1][a][0];
    for (int k = 0; k < 2; ++k) load += prepared.sorted.grad[a][k] * prepared.sigma[1][k][0];
    y_[0] -= std::sqrt(prepared.sorted.det / 2) * load;
  }
  for (const Facet& facet : at_vertex_)
    for (int part = 0; part < n_parts_; ++part)
      if (const MatrixXd* t = traction(facet, part)) y_[part] += std::sqrt(facet.scale) * (*t)(0, 1);
  y_ /= integral;
}

/// k, a column for each part.
MatrixXd MeridianRow::divergence_data(const MeridianCell& cell, int vertex) const
{
  MatrixXd k = cell.radius_moment * y_;
  if (!has_dis()) return k;
  const Eigen::VectorXd moments =
      reference_.hat[vertex].topRows(reference_.n_divergence) * cell.residual[row_] + cell.body[row_][vertex];
  if (row_ == 0)
    k.col(0) -= cell.compliance * moments;
  else
    k.col(0) -= moments;
  return k;
}

MeridianRow::Eliminated MeridianRow::eliminate(const MeridianPatchCell& cell) const
{
  const MeridianCell& prepared = *cell.prepared;
  const int o = prepared.sorted.find(vertex_);
  const Eigen::Index n = prepared.divergence.rows();
  const Eigen::Index m = prepared.divergence.cols();
  const int n_rim = prepared.is_on_axis(o) ? 0 : reference_.n_facet - (prepared.has_edge_on_axis ? 1 : 0);
  Eliminated result;
  result.local.resize(n, m + n_rim);
  result.local.leftCols(m) = prepared.divergence;
  if (n_rim > 0) result.local.rightCols(n_rim) = prepared.trace[o].leftCols(n_rim);
  for (int f = 0; f < 3; ++f)
  {
    const Facet* const at_vertex = f == o ? nullptr : find(facet(cell, f));
    if (at_vertex == nullptr) continue;
    result.outer.conservativeResize(n, result.outer.cols() + at_vertex->size);
    result.outer.rightCols(at_vertex->size) = prepared.trace[f].leftCols(at_vertex->size);
    for (int i = 0; i < at_vertex->size; ++i) result.multipliers.push_back(at_vertex->first + i);
  }
  if (result.outer.size() == 0) result.outer.resize(n, 0);
  MatrixXd matrix = result.local.transpose() * result.local;
  if (row_ == 0) matrix.topLeftCorner(m, m) += prepared.compliance;
  result.factors = CholeskyFactors(matrix);
  if (!result.factors.is_definite())
    throw no_equilibrated_stress<2>(prepared.sorted.origin, slenderness(prepared.sorted));
  const MatrixXd products = result.local.transpose() * result.outer;
  result.coupling = solve_lower(result.factors.lower(), products);
  MatrixXd data = MatrixXd::Zero(m + n_rim, n_parts_);
  data.topRows(m) = divergence_data(prepared, o);
  result.load = solve_lower(result.factors.lower(), data);
  return result;
}

void MeridianRow::add_to_system(const MeridianPatchCell& cell, const Eliminated& eliminated)
{
  const MatrixXd matrix =
      eliminated.outer.transpose() * eliminated.outer - eliminated.coupling.transpose() * eliminated.coupling;
  const MatrixXd load = eliminated.coupling.transpose() * eliminated.load;
  const std::vector<int>& numbers = eliminated.multipliers;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    for (std::size_t j = 0; j < numbers.size(); ++j) matrix_(numbers[i], numbers[j]) += matrix(i, j);
    load_.row(numbers[i]) += load.row(i);
  }
  if (!has_dis()) return;
  const SortedCell<2>& sorted = cell.prepared->sorted;
  const int o = sorted.find(vertex_);
  const MatrixXd target = this->target(*cell.prepared, o);
  for (int f = 0; f < 3; ++f)
  {
    const Facet* const at_vertex = f == o ? nullptr : find(facet(cell, f));
    if (at_vertex == nullptr) continue;
    const Eigen::VectorXd trace =
        reference_.trace[f] * (target * (-1 / std::sqrt(sorted.grad_norm[f]) * sorted.grad[f]));
    load_.col(0).segment(at_vertex->first, at_vertex->size) += trace.head(at_vertex->size);
  }
}

void MeridianRow::add_tractions()
{
  for (const Facet& facet : at_vertex_)
    for (int part = 0; part < n_parts_; ++part)
      if (const MatrixXd* t = traction(facet, part))
        load_.col(part).segment(facet.first, facet.size) -= t->col(row_).head(facet.size);
}

void MeridianRow::recover(const MeridianPatchCell& cell, const Eliminated& eliminated,
                          const MatrixXd& mu) const
{
  if (cell.stress[first_part_].empty()) return;
  const MeridianCell& prepared = *cell.prepared;
  MatrixXd at_cell(eliminated.multipliers.size(), n_parts_);
  for (std::size_t i = 0; i < eliminated.multipliers.size(); ++i)
    at_cell.row(i) = mu.row(eliminated.multipliers[i]);
  const MatrixXd eta =
      solve_lower_transposed(eliminated.factors.lower(), eliminated.load + eliminated.coupling * at_cell);
  const MatrixXd d = eliminated.local * eta - eliminated.outer * at_cell;
  const Eigen::Index n = prepared.mass.lower().rows();
  const MatrixXd target = this->target(prepared, prepared.sorted.find(vertex_));
  for (int part = 0; part < n_parts_; ++part)
    for (int k = 0; k < 2; ++k)
    {
      Eigen::VectorXd tau = solve_lower_transposed(prepared.mass.lower(), d.col(part).segment(k * n, n));
      if (prepared.has_edge_on_axis) tau = prepared.basis * tau;
      if (has_dis() && part == 0) tau += target.col(k);
      std::ranges::copy(tau, &cell.stress[first_part_ + part][(2 * row_ + k) * reference_.n_stress]);
    }
}

}  // namespace

void solve_meridian_patch(const mesh::Mesh<2>& mesh, const MeridianReference& reference,
                          const MeridianFacets& facets, Index vertex, int first_part, int end_part,
                          std::span<const MeridianPatchCell> cells)
{
  for (int row = 0; row < 2; ++row)
    MeridianRow(mesh, reference, facets, vertex, first_part, end_part, cells, row).solve();
}

}  // namespace tribound::certify
