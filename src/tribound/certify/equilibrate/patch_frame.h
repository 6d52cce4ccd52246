#pragma once

/// @file patch_frame.h
/// What patches of all kinds have in common: their cells and facets, the elimination of the outer facets.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/certify/equilibrate/block_cholesky.h"
#include "tribound/certify/equilibrate/facet_data.h"
#include "tribound/certify/equilibrate/prepared_cell.h"
#include "tribound/certify/equilibrate/repeated_patches.h"

namespace tribound::certify
{

/// The patch of a vertex with its problems: discretisation, linearisation and, for delta > 0, regularisation,
/// numbers 0, 1 and 2 of everything that all have.
template <class Kind_>
class PatchFrame
{
 public:
  using Kind = Kind_;
  static constexpr int dim = Kind::dim;
  static constexpr int p = Kind::p;
  using S = Sizes<dim, p>;
  using Operator = typename Kind::Operator;
  using Cell = typename Kind::Cell;
  using Share = typename Kind::Share;
  using FacetUnknown = typename Kind::FacetUnknown;

  /// Starts the patch of a vertex.
  void begin(Index vertex);
  /// `shares` takes the results: dis, and on Gamma_C those of the other problems.
  void add_cell(Index cell, const Cell& prepared, std::span<Share> shares);

 protected:
  static constexpr int max_problems = 3;

  struct CellPart
  {
    int vertex;                       ///< the patch's vertex in the sorted cell: also its outer facet
    std::array<int, dim + 1> facets;  ///< index in `facets_`, -1 for the outer one
    const Cell* prepared;
    std::span<Share> shares;
    const OuterElimination<Operator>* outer;  ///< of the cell's shape, or `own_outer`
    OuterElimination<Operator> own_outer;
    std::array<FacetUnknown, max_problems> outer_load;  ///< U(o, o)^{-T} g_o
  };

  struct PatchFacet
  {
    Index number;
    double scale;  ///< |F| / |Fhat|
  };

  PatchFrame(const mesh::Mesh<dim>& mesh, const FacetData<dim, p>& data) : mesh_(mesh), data_(data) {}

  /// What to throw where the patch has no solution.
  [[nodiscard]] SolveError failure() const;
  /// Renames the facets by the order of elimination. Finds the factors of a patch that repeats.
  void order_facets();
  /// Factors the matrix.
  void factor();
  /// Eliminates the multiplier of the outer facet.
  void eliminate_outer(CellPart& part);
  /// Adds what the elimination has left to the matrix, if there are no factors yet.
  void add_to_matrix(const CellPart& part);
  /// Moments of the traction of the dis (0), lin (1) or reg (2) problem, or null where there is none.
  [[nodiscard]] const typename FacetData<dim, p>::FacetVector* traction(Index facet, int problem) const;

  const mesh::Mesh<dim>& mesh_;
  const FacetData<dim, p>& data_;
  Index vertex_ = 0;
  int n_problems_ = 0;  ///< 1 off Gamma_C: there the data of lin and reg vanish
  int n_cells_ = 0;
  std::vector<CellPart> cells_;     ///< the first n_cells_ of them
  std::vector<PatchFacet> facets_;  ///< around the vertex, in the order of elimination
  std::vector<PatchFacet> found_;   ///< the same as they were found
  BlockCholesky<Operator::block> matrix_;
  const BlockCholesky<Operator::block>* factors_ = nullptr;  ///< null: matrix_ has none yet
  std::array<std::vector<FacetUnknown>, max_problems> x_;    ///< loads, then multipliers

 private:
  /// Where cells have repeated shapes and no facet fixes anything the matrix depends on nothing else.
  [[nodiscard]] bool is_comparable() const;
  void make_key();

  PatchKey key_;
  RepeatedPatches<BlockCholesky<Operator::block>> repeated_;
};

template <class Kind>
void PatchFrame<Kind>::begin(Index vertex)
{
  vertex_ = vertex;
  n_problems_ = data_.on_contact(vertex) ? data_.n_parts() : 1;
  n_cells_ = 0;
  found_.clear();
}

template <class Kind>
void PatchFrame<Kind>::add_cell(Index cell, const Cell& prepared, std::span<Share> shares)
{
  const SortedCell<dim>& sorted = prepared.sorted;
  if (n_cells_ == static_cast<int>(cells_.size()))
    cells_.push_back({0, {}, nullptr, shares, nullptr, {}, {}});
  CellPart& part = cells_[n_cells_++];
  part.vertex = sorted.find(vertex_);
  part.prepared = &prepared;
  part.shares = shares;
  const auto& numbers = mesh_.topology().cell_facets[cell];
  for (int f = 0; f <= dim; ++f)
  {
    part.facets[f] = -1;
    if (f == part.vertex) continue;
    const Index facet = numbers[sorted.local[f]];
    const auto known = std::ranges::find(found_, facet, &PatchFacet::number);
    part.facets[f] = static_cast<int>(known - found_.begin());
    if (known == found_.end()) found_.push_back({facet, sorted.facet_scale(f)});
  }
}

template <class Kind>
SolveError PatchFrame<Kind>::failure() const
{
  double flattest = 0;
  for (int k = 0; k < n_cells_; ++k) flattest = std::max(flattest, slenderness(cells_[k].prepared->sorted));
  return no_equilibrated_stress<dim>(mesh_.vertex(vertex_), flattest);
}

template <class Kind>
bool PatchFrame<Kind>::is_comparable() const
{
  const bool fixes = std::ranges::any_of(found_,
                                         [&](const PatchFacet& facet)
                                         {
                                           bool any = false;
                                           for (int c = 0; c < dim && data_.is_boundary(facet.number); ++c)
                                             any = any || data_.fixes(facet.number, c);
                                           return any;
                                         });
  return !fixes && std::all_of(cells_.begin(), cells_.begin() + n_cells_,
                               [](const CellPart& part) { return part.prepared->shape != nullptr; });
}

template <class Kind>
void PatchFrame<Kind>::make_key()
{
  key_.clear();
  if (!is_comparable()) return;
  key_.push_back(found_.size());
  for (int k = 0; k < n_cells_; ++k)
  {
    const CellPart& part = cells_[k];
    std::uintptr_t facets = part.vertex;
    for (int f = 0; f <= dim; ++f)
      if (f != part.vertex) facets = facets * found_.size() + part.facets[f];
    key_.push_back(reinterpret_cast<std::uintptr_t>(part.prepared->shape));
    key_.push_back(facets);
  }
}

template <class Kind>
void PatchFrame<Kind>::factor()
{
  if (!matrix_.factor()) throw failure();
  factors_ = repeated_.keep(key_, matrix_);
}

template <class Kind>
void PatchFrame<Kind>::order_facets()
{
  make_key();
  factors_ = repeated_.find(key_);
  std::span<const int> rank;
  if (factors_ != nullptr)
    rank = factors_->rank();
  else
  {
    matrix_.reset(static_cast<int>(found_.size()));
    for (int k = 0; k < n_cells_; ++k)
      for (int f = 0; f <= dim; ++f)
        for (int g = f + 1; g <= dim; ++g)
          if (f != cells_[k].vertex && g != cells_[k].vertex)
            matrix_.connect(cells_[k].facets[f], cells_[k].facets[g]);
    rank = matrix_.order();
  }
  for (int k = 0; k < n_cells_; ++k)
    for (int& facet : cells_[k].facets)
      if (facet >= 0) facet = rank[facet];
  facets_.resize(found_.size());
  for (std::size_t i = 0; i < found_.size(); ++i) facets_[rank[i]] = found_[i];
}

template <class Kind>
void PatchFrame<Kind>::eliminate_outer(CellPart& part)
{
  const Cell& cell = *part.prepared;
  part.outer = cell.shape ? &cell.shape->outer[part.vertex] : &part.own_outer;
  if (!cell.shape) part.own_outer.factor(*cell.op, cell.sorted, part.vertex);
}

template <class Kind>
void PatchFrame<Kind>::add_to_matrix(const CellPart& part)
{
  if (factors_ != nullptr) return;
  const Cell& cell = *part.prepared;
  const int o = part.vertex;
  for (int f = 0; f <= dim; ++f)
    for (int g = 0; g <= dim; ++g)
    {
      if (f == o || g == o || part.facets[f] > part.facets[g]) continue;
      auto& block = matrix_.block(part.facets[f], part.facets[g]);
      if (cell.shape)
        add_multiple(block, 1, cell.shape->reduced[o][f][g]);
      else
        part.own_outer.add_block(*cell.op, f, g, block);
    }
}

template <class Kind>
auto PatchFrame<Kind>::traction(Index facet, int problem) const -> const
    typename FacetData<dim, p>::FacetVector*
{
  if (!data_.is_boundary(facet)) return nullptr;
  const auto* moments = problem == 0   ? data_.discretisation(facet)
                        : problem == 1 ? data_.linearisation(facet)
                                       : data_.regularisation(facet);
  if (!moments) return nullptr;
  const auto& vertices = mesh_.topology().facets[facet];
  return &(*moments)[std::ranges::find(vertices, vertex_) - vertices.begin()];
}

}  // namespace tribound::certify
