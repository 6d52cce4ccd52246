#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tribound/algebra/sparse_rows.h"
#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/meridian_cells.h"
#include "tribound/contact/nitsche/springs.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// The block a(phi_j e_b, phi_i e_a) = lambda S_ab + mu S_ba + mu tr(S) delta_ab, where
/// S = (d_a phi_i, d_b phi_j)_T = det J J^{-T} R_ij J^{-1}, R the products of reference gradients.
template <int dim>
Tensor<dim> stiffness_block(const problem::Material& material, const mesh::CellMap<dim>& map,
                            const Tensor<dim>& reference)
{
  const Tensor<dim> s = map.det * (map.inverse_transpose * reference * map.inverse_transpose.transpose());
  Tensor<dim> block = material.lambda * s + material.mu * s.transpose();
  block.diagonal().array() += material.mu * s.trace();
  return block;
}

/// A node in the numbering of a cell.
struct LocalNode
{
  Index cell;
  int local;
};

/// The cells around each node: those of node i are cells[begin[i]] ... cells[begin[i + 1] - 1].
struct NodeCells
{
  std::vector<Index> begin;
  std::vector<LocalNode> cells;

  [[nodiscard]] std::span<const LocalNode> around(Index node) const
  {
    return std::span(cells).subspan(begin[node], begin[node + 1] - begin[node]);
  }
};

template <int dim>
NodeCells cells_around_nodes(const fem::LagrangeSpace<dim>& space)
{
  const Index n_cells = space.mesh().n_cells();
  NodeCells result{std::vector<Index>(space.n_nodes() + 1, 0), {}};
  for (Index c = 0; c < n_cells; ++c)
    for (const Index node : space.cell_nodes(c)) ++result.begin[node + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());

  std::vector<Index> next(result.begin.begin(), result.begin.end() - 1);
  result.cells.resize(result.begin.back());
  for (Index c = 0; c < n_cells; ++c)
  {
    const std::span<const Index> nodes = space.cell_nodes(c);
    for (std::size_t i = 0; i < nodes.size(); ++i) result.cells[next[nodes[i]]++] = {c, static_cast<int>(i)};
  }
  return result;
}

/// The rows of the stiffness matrix for one node, with one block for each node that shares a cell with it.
template <int dim>
class BlockRow
{
 public:
  BlockRow(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
           const Springs<dim>* springs, const MeridianCells* meridian)
      : problem_(&problem),
        space_(&space),
        springs_(springs),
        meridian_(meridian),
        reference_(fem::gradient_products(space.basis())),
        index_(space.n_nodes(), -1)
  {
    if (springs == nullptr) return;
    for (const SpringFacet<dim>& facet : springs->facets()) on_springs_[facet.cell].push_back(&facet);
  }

  void assemble(std::span<const LocalNode> cells)
  {
    find_neighbours(cells);
    const int n = space_->basis().n_nodes();
    for (const auto& [c, i] : cells)
    {
      const mesh::CellMap<dim> map = mesh::cell_map(space_->mesh(), c);
      const problem::Material& material = problem_->material(space_->mesh().region(c));
      const std::span<const Index> nodes = space_->cell_nodes(c);
      if (meridian_ != nullptr)
        add_meridian(c, i);
      else
        for (int j = 0; j < n; ++j)
          blocks_[index_[nodes[j]]] += stiffness_block(material, map, reference_[i * n + j]);
      if (const auto held = on_springs_.find(c); held != on_springs_.end())
        for (const SpringFacet<dim>* facet : held->second)
          for (int j = 0; j < n; ++j) blocks_[index_[nodes[j]]] += springs_->block(*facet, i, j);
    }
    for (const Index j : neighbours_) index_[j] = -1;
  }

  /// The neighbouring nodes in ascending order, and the block of each.
  [[nodiscard]] std::span<const Index> neighbours() const { return neighbours_; }
  [[nodiscard]] std::span<const Tensor<dim>> blocks() const { return blocks_; }

 private:
  void find_neighbours(std::span<const LocalNode> cells)
  {
    neighbours_.clear();
    for (const LocalNode& cell : cells)
      for (const Index j : space_->cell_nodes(cell.cell))
        if (std::exchange(index_[j], 0) < 0) neighbours_.push_back(j);
    std::ranges::sort(neighbours_);
    for (std::size_t k = 0; k < neighbours_.size(); ++k) index_[neighbours_[k]] = static_cast<Index>(k);
    blocks_.assign(neighbours_.size(), Tensor<dim>::Zero());
  }

  void add_meridian(Index cell, int i)
  {
    if constexpr (dim == 2)
    {
      const std::vector<Tensor<2>> row = meridian_->stiffness_row(cell, i);
      for (std::size_t j = 0; j < row.size(); ++j) blocks_[index_[space_->cell_nodes(cell)[j]]] += row[j];
    }
  }

  const problem::Problem<dim>* problem_;
  const fem::LagrangeSpace<dim>* space_;
  const Springs<dim>* springs_;                                                 ///< or null
  const MeridianCells* meridian_;                                               ///< or null
  std::unordered_map<Index, std::vector<const SpringFacet<dim>*>> on_springs_;  ///< by cell
  std::vector<Tensor<dim>> reference_;
  std::vector<Index> index_;  ///< per node: its index among the neighbours, or -1
  std::vector<Index> neighbours_;
  std::vector<Tensor<dim>> blocks_;
};

/// The rows of the own nodes number first, ..., last - 1. A node is coupled with another by a whole block,
/// with zeros where a component is fixed: PETSc then reads the graph of the nodes off the first row of each,
/// in a third of the time.
template <int dim>
algebra::SparseRows stiffness_rows(BlockRow<dim> row, const fem::LagrangeSpace<dim>& space,
                                   const NodeCells& cells, const fem::Constraints& constraints, Index first,
                                   Index last)
{
  algebra::SparseRows rows;
  std::vector<std::size_t> coupled;  // neighbours
  const auto is_free = [&](Index node)
  { return !std::ranges::all_of(std::span(constraints.fixed).subspan(dim * node, dim), std::identity()); };
  for (Index k_row = first; k_row < last; ++k_row)
  {
    const Index i = space.owned_node(k_row);
    row.assemble(cells.around(i));
    coupled.clear();
    for (std::size_t k = 0; k < row.neighbours().size(); ++k)
      if (const Index j = row.neighbours()[k]; i == j || (is_free(i) && is_free(j))) coupled.push_back(k);
    for (int a = 0; a < dim; ++a)
    {
      const Index row_dof = dim * i + a;
      for (const std::size_t k : coupled)
        for (int b = 0; b < dim; ++b)
        {
          const Index col_dof = dim * row.neighbours()[k] + b;
          const bool couples =
              row_dof == col_dof || !(constraints.fixed[row_dof] || constraints.fixed[col_dof]);
          rows.add(col_dof, couples ? row.blocks()[k](a, b) : 0);
        }
      rows.end_row();
    }
  }
  return rows;
}

}  // namespace

template <int dim>
algebra::SparseRows stiffness(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                              const fem::Constraints& constraints, const Springs<dim>* springs,
                              const std::shared_ptr<const MeridianCells>& known)
{
  constexpr Index worth_a_thread = 5000;
  const NodeCells cells = cells_around_nodes(space);
  const Index n = space.n_owned_nodes();
  const int n_parts = std::clamp<int>(n / worth_a_thread, 1, max_threads());
  std::vector<algebra::SparseRows> parts(n_parts);
  const std::shared_ptr<const MeridianCells> meridian = known ? known : meridian_cells(problem, space);
  const auto begin = [&](int part) { return static_cast<Index>(static_cast<long>(n) * part / n_parts); };
  in_threads(n_parts,
             [&](int part)
             {
               parts[part] = stiffness_rows<dim>(BlockRow<dim>(problem, space, springs, meridian.get()),
                                                 space, cells, constraints, begin(part), begin(part + 1));
             });
  algebra::require_countable(std::accumulate(parts.begin(), parts.end(), std::size_t{0},
                                             [](std::size_t n, const algebra::SparseRows& part)
                                             { return n + part.columns.size(); }));
  algebra::SparseRows rows = std::move(parts.front());
  for (int part = 1; part < n_parts; ++part) rows.append(std::exchange(parts[part], {}));
  return rows;
}

template algebra::SparseRows stiffness(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                       const fem::Constraints&, const Springs<2>*,
                                       const std::shared_ptr<const MeridianCells>&);
template algebra::SparseRows stiffness(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                       const fem::Constraints&, const Springs<3>*,
                                       const std::shared_ptr<const MeridianCells>&);

}  // namespace tribound::contact
