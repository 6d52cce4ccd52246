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
using Eigen::VectorXd;

/// The problem of one row, or of both if they are weakly symmetric.
class MeridianSystem
{
 public:
  MeridianSystem(const mesh::Mesh<2>& mesh, const MeridianReference& reference, const MeridianFacets& facets,
                 Index vertex, int first_part, int end_part, std::span<const MeridianPatchCell> cells,
                 int first_row, int end_row)
      : mesh_(mesh),
        reference_(reference),
        facets_(facets),
        vertex_(vertex),
        first_part_(first_part),
        n_parts_(end_part - first_part),
        cells_(cells),
        first_row_(first_row),
        n_rows_(end_row - first_row)
  {
  }

  void solve();

 private:
  /// A facet at the vertex where the normal trace of a row is prescribed.
  struct Facet
  {
    Index number;
    int row;
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
    MatrixXd data;                 ///< (k, 0), a column for each part
    MatrixXd d;                    ///< L^T d, the same
    std::vector<int> multipliers;  ///< of the facets at the vertex
  };

  void number_facets();
  void number_facet(const MeridianPatchCell& cell, int f, int row);
  void make_compatible();
  [[nodiscard]] Eliminated eliminate(const MeridianPatchCell& cell) const;
  [[nodiscard]] MatrixXd condition_data(const MeridianCell& cell, int vertex) const;
  void add_to_system(const MeridianPatchCell& cell, const Eliminated& eliminated);
  void add_tractions();
  void improve(std::vector<Eliminated>& cells, const CholeskyFactors& factors) const;
  void recover(const MeridianPatchCell& cell, const Eliminated& eliminated) const;

  /// Calls visit(f, facet) for the facets f of a cell that have multipliers, row by row.
  template <class Visit>
  void for_each_facet(const MeridianPatchCell& cell, const Visit& visit) const
  {
    for (int f = 0; f < 3; ++f)
      for (const Facet& at_vertex : at_vertex_)
        if (at_vertex.number == facet(cell, f)) visit(f, at_vertex);
  }
  /// Moments of a normal trace of the cell.
  [[nodiscard]] int trace_size(const MeridianCell& cell) const
  {
    return reference_.n_facet - (cell.has_edge_on_axis ? 1 : 0);
  }
  /// The facet opposite to a vertex of a cell.
  [[nodiscard]] Index facet(const MeridianPatchCell& cell, int opposite) const
  {
    return mesh_.topology().cell_facets[cell.cell][cell.prepared->sorted.local[opposite]];
  }
  /// A row of psi_a r sigma(u) in P^q, by component.
  [[nodiscard]] MatrixXd target(const MeridianCell& cell, int vertex, int row) const
  {
    MatrixXd result(reference_.n_stress, 2);
    for (int k = 0; k < 2; ++k) result.col(k) = reference_.hat[vertex] * cell.sigma[row][k];
    return result;
  }
  [[nodiscard]] bool is_by_rows() const { return n_rows_ == 1; }
  /// Whether the divergence of the axial row is prescribed and its component fixed nowhere.
  [[nodiscard]] bool must_balance() const { return first_row_ + n_rows_ == 2 && !is_fixed_; }
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
  const int first_row_;
  const int n_rows_;
  std::vector<Facet> at_vertex_;
  bool is_fixed_ = false;  ///< whether a facet at the vertex fixes the axial component
  int n_multipliers_ = 0;
  Eigen::RowVectorXd y_;
  MatrixXd matrix_;
  MatrixXd traces_;  ///< N d, as it should be
};

void MeridianSystem::solve()
{
  number_facets();
  make_compatible();
  matrix_ = MatrixXd::Zero(n_multipliers_, n_multipliers_);
  traces_ = MatrixXd::Zero(n_multipliers_, n_parts_);
  std::vector<Eliminated> eliminated;
  for (const MeridianPatchCell& cell : cells_)
  {
    eliminated.push_back(eliminate(cell));
    add_to_system(cell, eliminated.back());
  }
  add_tractions();
  // Multipliers that are the trace of a constant change nothing in the axial row: a term on one facet, which
  // the solution, the data being compatible, does not feel.
  if (const auto axial = std::ranges::find(at_vertex_, 1, &Facet::row);
      must_balance() && axial != at_vertex_.end())
    matrix_(axial->first, axial->first) += matrix_.trace() / n_multipliers_;
  CholeskyFactors factors;
  if (n_multipliers_ > 0) factors = CholeskyFactors(matrix_);
  if (n_multipliers_ > 0 && !factors.is_definite())
  {
    double worst = 0;
    for (const MeridianPatchCell& cell : cells_) worst = std::max(worst, slenderness(cell.prepared->sorted));
    throw no_equilibrated_stress<2>(mesh_.vertex(vertex_), worst);
  }
  // Far from the axis hoop stresses hardly resist motions of the cells: a second pass takes away the
  // rounding.
  for (int pass = 0; pass < (is_by_rows() ? 1 : 2); ++pass) improve(eliminated, factors);
  for (std::size_t i = 0; i < cells_.size(); ++i) recover(cells_[i], eliminated[i]);
}

/// Adds to d = -h + B^T eta + N^T mu what its conditions lack; row by row it starts from 0.
void MeridianSystem::improve(std::vector<Eliminated>& cells, const CholeskyFactors& factors) const
{
  MatrixXd load = -traces_;
  std::vector<MatrixXd> lacking;
  for (const Eliminated& cell : cells)
  {
    lacking.push_back(solve_lower(cell.factors.lower(), cell.data - cell.local.transpose() * cell.d));
    load(cell.multipliers, Eigen::all) +=
        cell.outer.transpose() * cell.d + cell.coupling.transpose() * lacking.back();
  }
  const MatrixXd mu = n_multipliers_ > 0 ? factors.solve(load) : load;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    Eliminated& cell = cells[i];
    const MatrixXd at_cell = mu(cell.multipliers, Eigen::all);
    const MatrixXd eta = solve_lower_transposed(cell.factors.lower(), lacking[i] + cell.coupling * at_cell);
    cell.d += cell.local * eta - cell.outer * at_cell;
  }
}

/// Where all cells of a facet have an edge on the axis, normal traces are r P^p: their moments on P^p
/// suffice.
void MeridianSystem::number_facets()
{
  for (const MeridianPatchCell& cell : cells_)
    for (int f = 0; f < 3; ++f)
    {
      const MeridianCell& prepared = *cell.prepared;
      if (prepared.sorted.vertices[f] == vertex_ || prepared.is_on_axis(f)) continue;
      for (int row = first_row_; row < first_row_ + n_rows_; ++row) number_facet(cell, f, row);
    }
  for (Facet& facet : at_vertex_)
  {
    facet.first = n_multipliers_;
    n_multipliers_ += facet.size;
  }
}

void MeridianSystem::number_facet(const MeridianPatchCell& cell, int f, int row)
{
  const Index number = facet(cell, f);
  if (facets_.fixes(number, row))
  {
    is_fixed_ = is_fixed_ || row == 1;
    return;
  }
  const MeridianCell& prepared = *cell.prepared;
  const auto found = std::ranges::find_if(
      at_vertex_, [&](const Facet& facet) { return facet.number == number && facet.row == row; });
  if (found == at_vertex_.end())
    at_vertex_.push_back({number, row, prepared.sorted.facet_scale(f), 0, trace_size(prepared)});
  else
    found->size = std::max(found->size, trace_size(prepared));
}

void MeridianSystem::make_compatible()
{
  y_ = Eigen::RowVectorXd::Zero(n_parts_);
  if (!must_balance()) return;
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
      if (const MatrixXd* t = facet.row == 1 ? traction(facet, part) : nullptr)
        y_[part] += std::sqrt(facet.scale) * (*t)(0, 1);
  y_ /= integral;
}

/// k, a column for each part.
MatrixXd MeridianSystem::condition_data(const MeridianCell& cell, int vertex) const
{
  const int m = reference_.n_divergence;
  const int row = first_row_ + n_rows_ - 1;  // whose divergence is prescribed, or the radial one
  MatrixXd k = MatrixXd::Zero(cell.conditions.cols(), n_parts_);
  k.topRows(m) = cell.radius_moment * y_;
  if (!has_dis()) return k;
  const VectorXd moments = reference_.hat[vertex].topRows(m) * cell.residual[row] + cell.body[row][vertex];
  if (row == 0)
    k.col(0) -= cell.compliance * moments;
  else
    k.col(0).head(m) -= moments;
  return k;
}

MeridianSystem::Eliminated MeridianSystem::eliminate(const MeridianPatchCell& cell) const
{
  const MeridianCell& prepared = *cell.prepared;
  const int o = prepared.sorted.find(vertex_);
  const Eigen::Index n = prepared.conditions.rows();
  const Eigen::Index m = prepared.conditions.cols();
  const int n_rim = prepared.is_on_axis(o) ? 0 : trace_size(prepared);
  Eliminated result;
  result.local.resize(n, m + n_rows_ * n_rim);
  result.local.leftCols(m) = prepared.conditions;
  for (int i = 0; i < n_rows_ && n_rim > 0; ++i)
    result.local.middleCols(m + i * n_rim, n_rim) = prepared.trace[i][o].leftCols(n_rim);
  for_each_facet(cell,
                 [&](int f, const Facet& at_vertex)
                 {
                   result.outer.conservativeResize(n, result.outer.cols() + at_vertex.size);
                   result.outer.rightCols(at_vertex.size) =
                       prepared.trace[at_vertex.row - first_row_][f].leftCols(at_vertex.size);
                   for (int i = 0; i < at_vertex.size; ++i) result.multipliers.push_back(at_vertex.first + i);
                 });
  if (result.outer.size() == 0) result.outer.resize(n, 0);
  MatrixXd matrix = result.local.transpose() * result.local;
  if (is_by_rows() && first_row_ == 0) matrix.topLeftCorner(m, m) += prepared.compliance;
  result.factors = CholeskyFactors(matrix);
  if (!result.factors.is_definite())
    throw no_equilibrated_stress<2>(prepared.sorted.origin, slenderness(prepared.sorted));
  const MatrixXd products = result.local.transpose() * result.outer;
  result.coupling = solve_lower(result.factors.lower(), products);
  result.data = MatrixXd::Zero(result.local.cols(), n_parts_);
  result.data.topRows(m) = condition_data(prepared, o);
  result.d = MatrixXd::Zero(n, n_parts_);
  if (has_dis() && !is_by_rows()) result.d.col(0) = -prepared.load[o];
  return result;
}

void MeridianSystem::add_to_system(const MeridianPatchCell& cell, const Eliminated& eliminated)
{
  matrix_(eliminated.multipliers, eliminated.multipliers) +=
      eliminated.outer.transpose() * eliminated.outer - eliminated.coupling.transpose() * eliminated.coupling;
  if (!has_dis()) return;
  const SortedCell<2>& sorted = cell.prepared->sorted;
  const int o = sorted.find(vertex_);
  for_each_facet(cell,
                 [&](int f, const Facet& at_vertex)
                 {
                   const VectorXd trace =
                       reference_.trace[f] * (target(*cell.prepared, o, at_vertex.row) *
                                              (-1 / std::sqrt(sorted.grad_norm[f]) * sorted.grad[f]));
                   traces_.col(0).segment(at_vertex.first, at_vertex.size) -= trace.head(at_vertex.size);
                 });
}

void MeridianSystem::add_tractions()
{
  for (const Facet& facet : at_vertex_)
    for (int part = 0; part < n_parts_; ++part)
      if (const MatrixXd* t = traction(facet, part))
        traces_.col(part).segment(facet.first, facet.size) += t->col(facet.row).head(facet.size);
}

void MeridianSystem::recover(const MeridianPatchCell& cell, const Eliminated& eliminated) const
{
  if (cell.stress[first_part_].empty()) return;
  const MeridianCell& prepared = *cell.prepared;
  const MatrixXd& d = eliminated.d;
  const int o = prepared.sorted.find(vertex_);
  const Eigen::Index n_fields = prepared.mass.lower().rows();  // of all components, or one
  for (int part = 0; part < n_parts_; ++part)
  {
    const MatrixXd x =
        solve_lower_transposed(prepared.mass.lower(), d.col(part).reshaped(n_fields, d.rows() / n_fields));
    MatrixXd tau = x.reshaped(d.rows() / (2 * n_rows_), 2 * n_rows_);  // component by component
    if (prepared.has_edge_on_axis) tau = prepared.basis * tau;
    for (int i = 0; i < n_rows_ && has_dis() && part == 0; ++i)
      tau.middleCols(2 * i, 2) += target(prepared, o, first_row_ + i);
    std::ranges::copy(tau.reshaped(), &cell.stress[first_part_ + part][2 * first_row_ * reference_.n_stress]);
  }
}

}  // namespace

void solve_meridian_patch(const mesh::Mesh<2>& mesh, const MeridianReference& reference,
                          const MeridianFacets& facets, Index vertex, int first_part, int end_part,
                          std::span<const MeridianPatchCell> cells, bool by_rows)
{
  if (!by_rows)
  {
    MeridianSystem(mesh, reference, facets, vertex, first_part, end_part, cells, 0, 2).solve();
    return;
  }
  for (int row = 0; row < 2; ++row)
    MeridianSystem(mesh, reference, facets, vertex, first_part, end_part, cells, row, row + 1).solve();
}

}  // namespace tribound::certify
