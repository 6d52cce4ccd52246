#pragma once

/// @file row_patch.h
/// The minimisation problems on the patch of one vertex without symmetry, row by row, method section 4.6.

#include <array>
#include <vector>

#include "tribound/certify/equilibrate/patch_frame.h"

namespace tribound::certify
{

/// An object is the work space of one thread. Rows whose component is fixed on the same facets share a
/// matrix.
template <int dim, int p>
class RowPatch : public PatchFrame<RowPatches<dim, p>>
{
  using Frame = PatchFrame<RowPatches<dim, p>>;

 public:
  using S = Sizes<dim, p>;

  RowPatch(const mesh::Mesh<dim>& mesh, const FacetData<dim, p>& data) : Frame(mesh, data) {}

  /// Solves the problems. Throws SolveError naming the place if the patch is not what method section 4
  /// requires.
  void solve();
  /// The stress in a cell from the shares of all its patches, part by part.
  [[nodiscard]] static StressCoefficients<dim, p> stress(const RowCell<dim, p>& cell,
                                                         const CellShares<RowShare<dim, p>, dim>& shares,
                                                         int problem, const FacetData<dim, p>& data);

 private:
  using Operator = RowOperator<dim, p>;
  using CellRows = typename Operator::CellRows;
  using FacetRows = typename Operator::FacetRows;
  using Frame::cells_;
  using Frame::data_;
  using Frame::facets_;
  using Frame::factors_;
  using Frame::matrix_;
  using Frame::max_problems;
  using Frame::n_cells_;
  using Frame::n_problems_;
  using Frame::traction;
  using Frame::x_;
  using typename Frame::CellPart;

  static constexpr int width = FacetRows::stride;

  [[nodiscard]] bool fixes(int facet, int component) const
  {
    return data_.is_boundary(facets_[facet].number) && data_.fixes(facets_[facet].number, component);
  }
  [[nodiscard]] bool is_fixed(int component) const;
  [[nodiscard]] bool fixed_alike(int component, int other) const;
  void make_compatible();
  [[nodiscard]] double traction_work(int problem, int component) const;
  void assemble_load(CellPart& part, int problem);
  void solve_rows_like(int component);
  void fix_constant();
  void recover(CellPart& part, int problem);

  std::array<Point<dim>, max_problems> y_;
  std::vector<FacetRows> rows_;  ///< what is solved for rows that are fixed alike
};

}  // namespace tribound::certify
