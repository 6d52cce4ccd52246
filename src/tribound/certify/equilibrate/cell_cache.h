#pragma once

/// @file cell_cache.h
/// The cells that a part of the vertices needs, with their data.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/initial_moments.h"
#include "tribound/certify/equilibrate/prepared_cell.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

/// Moments of psi_a f on U for every vertex of every cell, or nothing where f = 0.
template <int dim, int p>
class BodyMoments
{
 public:
  using Vector = DenseVector<Sizes<dim, p>::u>;

  explicit BodyMoments(const contact::NitscheForm<dim>& form)
  {
    const mesh::Mesh<dim>& mesh = form.space().mesh();
    const fem::Quadrature<dim>& rule = form.data().cell_rule();
    std::vector<Point<dim>> f(rule.size());
    std::vector<Table> tables;  // by permutation_number(sorted.local), filled when first needed
    for (Index c = 0; c < mesh.n_cells(); ++c)
    {
      if (!form.data().has_body_force(c)) continue;
      if (moments_.empty()) moments_.resize(static_cast<std::size_t>(mesh.n_cells()) * (dim + 1));
      const SortedCell<dim> sorted = make_sorted_cell(mesh, c);
      const auto number = static_cast<std::size_t>(permutation_number(sorted.local));
      if (number >= tables.size()) tables.resize(number + 1);
      if (tables[number].points.empty()) tables[number] = Table(rule, sorted.local);
      const auto& [points, chi] = tables[number];
      form.data().body_force(c, f);
      for (int q = 0; q < rule.size(); ++q)
        add(&moments_[static_cast<std::size_t>(c) * (dim + 1)], points[q],
            rule.weights[q] * std::sqrt(sorted.det) * f[q], &chi[m * q]);
    }
  }

  [[nodiscard]] Vector operator()(Index cell, int vertex) const
  {
    return moments_.empty() ? Vector{} : moments_[static_cast<std::size_t>(cell) * (dim + 1) + vertex];
  }

 private:
  static constexpr int m = Sizes<dim, p>::multiplier;

  /// The points of the rule in sorted coordinates, numbered as in the cell's own, in which f is given; and
  /// the basis of P^{p-1} there.
  struct Table
  {
    Table() = default;
    Table(const fem::Quadrature<dim>& rule, const std::array<int, dim + 1>& local) : chi(m * rule.size())
    {
      for (int q = 0; q < rule.size(); ++q)
      {
        points.push_back(to_sorted_cell<dim>(local, rule.points[q]));
        fem::orthonormal_values<dim>(p - 1, points[q], std::span(chi).subspan(m * q, m));
      }
    }
    std::vector<Point<dim>> points;
    std::vector<double> chi;  ///< [q * m + i]
  };

  /// The share of one point in the moments of all vertices.
  static void add(Vector* moments, const Point<dim>& xhat, const Point<dim>& weighted_f, const double* chi)
  {
    const std::array<double, dim + 1> hat = fem::barycentric<dim>(xhat);
    for (int a = 0; a <= dim; ++a)
      for (int r = 0; r < dim; ++r)
        for (int i = 0; i < m; ++i) moments[a][r * m + i] += hat[a] * weighted_f[r] * chi[i];
  }

  std::vector<Vector> moments_;
};

/// What a patch in the Arnold-Falk-Winther spaces needs of cell c beside its operator. `turning`: K_{T,a} at
/// its vertices, or empty.
template <int dim, int p>
void fill(PreparedCell<dim, p>& cell, Index c, const BodyMoments<dim, p>& body,
          std::span<const Tensor<dim>> turning)
{
  cell.divergence = discrete_divergence<dim, p>(cell.sorted, cell.sigma);
  for (int a = 0; a <= dim; ++a) cell.body[a] = body(c, a);
  find_coordinates(cell);
  if (turning.empty()) return;
  const Point<dim> to_centre = cell.sorted.jacobian.rowwise().sum() / (dim + 1);
  for (int a = 0; a <= dim; ++a)  // K_{T,a} (x - x_T) beside -psi_a f
    add_moments(cell.body[a], cell, 0, RigidField<dim>{-turning[a] * to_centre, turning[a]}, -1);
}

/// What a patch row by row needs.
template <int dim, int p>
void fill(RowCell<dim, p>& cell, Index c, const BodyMoments<dim, p>& body,
          [[maybe_unused]] std::span<const Tensor<dim>> turning)
{
  assert(turning.empty());  // constants of the rows do not feel it
  constexpr int m = Sizes<dim, p>::multiplier;
  const auto by_rows = [](const DenseVector<dim * m>& moments)
  {
    typename RowCell<dim, p>::CellRows rows{};
    add_by_rows<dim, p>(rows, moments);
    return rows;
  };
  cell.divergence = by_rows(discrete_divergence<dim, p>(cell.sorted, cell.sigma));
  for (int a = 0; a <= dim; ++a) cell.body[a] = by_rows(body(c, a));
  for (int f = 0; f <= dim; ++f)
  {
    cell.normal[f] = {};
    const Point<dim> direction = -1 / std::sqrt(cell.sorted.grad_norm[f]) * cell.sorted.grad[f];
    for (int r = 0; r < dim; ++r)
      for (int k = 0; k < dim; ++k)
        for (int j = 0; j < m; ++j) cell.normal[f](j, r) += direction[k] * cell.sigma[(dim * r + k) * m + j];
  }
}

/// Where prepared cells come from.
template <class Kind>
struct CellSource
{
  static constexpr int dim = Kind::dim;
  static constexpr int p = Kind::p;
  using Cell = typename Kind::Cell;
  using Operator = typename Kind::Operator;

  const contact::NitscheForm<dim>& form;
  std::span<const double> u;
  const BodyMoments<dim, p>& body;
  const InitialMoments<dim, p>& initial;
  const RepeatedShapes<Operator>& shapes;
  std::span<const StressMetric> metrics = {};  ///< of the regions; empty: L2 everywhere
  std::span<const Tensor<dim>> turning = {};   ///< K_{T,a}, see Equilibrator::balanced(); empty: 0

  /// The Schur complement is only made if `for_patches`.
  void prepare(Index c, Cell& cell, bool for_patches) const
  {
    const fem::LagrangeSpace<dim>& space = form.space();
    cell.sorted = make_sorted_cell(space.mesh(), c);
    find_operator(c, cell, for_patches);
    cell.one = moment_of_one<dim, p>(cell.sorted);
    cell.sigma = discrete_stress<dim, p>(cell.sorted, form.problem().material(space.mesh().region(c)),
                                         space.cell_nodes(c), u);
    initial.add(c, cell.sorted, cell.sigma);
    initial.find_rest(c, cell.sorted, cell.rest);
    const std::size_t first = turning.empty() ? 0 : static_cast<std::size_t>(c) * (dim + 1);
    fill(cell, c, body, turning.subspan(first, turning.empty() ? 0 : dim + 1));
  }

  void find_operator(Index c, Cell& cell, bool for_patches) const
  {
    cell.shape = shapes.find(c);
    cell.op = cell.shape ? &cell.shape->op : nullptr;
    if (cell.shape) return;
    if (!cell.own) cell.own = std::make_unique<Operator>();
    cell.own->build(cell.sorted, metrics.empty() ? StressMetric{} : metrics[form.space().mesh().region(c)]);
    if (for_patches) cell.own->condense(cell.sorted);
    cell.op = cell.own.get();
  }
};

/// The cells that a part of the vertices needs: prepared when first asked for, forgotten when the caller has
/// done with them.
template <class Kind>
class CellCache
{
 public:
  struct Slot
  {
    explicit Slot(int n_parts) : shares(n_parts) {}

    typename Kind::Cell cell;
    CellShares<typename Kind::Share, Kind::dim> shares;
    int waiting = 0;  ///< vertices of the part that still need the cell; 0 when it is new
  };

  /// For stresses of n_parts parts.
  CellCache(const CellSource<Kind>& source, int n_parts)
      : source_(source), n_parts_(n_parts), slot_(source.form.space().mesh().n_cells(), -1)
  {
  }

  Slot& get(Index cell)
  {
    if (slot_[cell] >= 0) return *pool_[slot_[cell]];
    if (free_.empty())
    {
      free_.push_back(static_cast<int>(pool_.size()));
      pool_.push_back(std::make_unique<Slot>(n_parts_));
    }
    slot_[cell] = free_.back();
    free_.pop_back();
    Slot& slot = *pool_[slot_[cell]];
    source_.prepare(cell, slot.cell, true);
    slot.waiting = 0;
    return slot;
  }

  void forget(Index cell)
  {
    free_.push_back(slot_[cell]);
    slot_[cell] = -1;
  }

 private:
  const CellSource<Kind>& source_;
  int n_parts_;
  std::vector<int> slot_;  ///< per cell: index in pool_, or -1
  std::vector<std::unique_ptr<Slot>> pool_;
  std::vector<int> free_;
};

}  // namespace tribound::certify
