#pragma once

/// @file patch.h
/// The minimisation problems on the patch of one vertex, method section 4: gather, condense, factor, solve.

#include <array>
#include <vector>

#include "certify/block_cholesky.h"
#include "certify/cell_operator.h"
#include "certify/facet_data.h"
#include "certify/rigid.h"

namespace tribound
{

/// A cell with everything its patches share.
template <int dim, int p>
struct PreparedCell
{
  using S = Sizes<dim, p>;
  Frame<dim> frame;
  CellOperator<dim, p> op;
  DiscreteStress<dim, p> sigma;                              ///< sigma(u^k)
  Eigen::Matrix<double, S::u, 1> divergence;                 ///< moments of div sigma(u^k)
  std::array<Eigen::Matrix<double, S::u, 1>, dim + 1> body;  ///< moments of psi_a f
};

/// The discretisation and linearisation problems of a vertex; column 0 is dis, column 1 is lin.
/// An object is the work space of one thread.
template <int dim, int p>
class Patch
{
 public:
  using S = Sizes<dim, p>;
  using FacetColumns = Eigen::Matrix<double, S::block, 2>;

  /// Results for the caller to distribute.
  struct CellPart
  {
    Index cell;
    int vertex;                       ///< the patch's vertex in the frame of the cell
    std::array<int, dim + 1> facets;  ///< place in `facets`, -1 for the outer one
    const PreparedCell<dim, p>* prepared;
    FacetColumns outer;  ///< multipliers of the outer facet
  };

  Patch(const Mesh<dim>& mesh, const FacetData<dim, p>& data) : mesh_(mesh), data_(data) {}

  /// Starts the patch of a vertex.
  void begin(Index vertex);
  void add_cell(Index cell, const PreparedCell<dim, p>& prepared);
  /// Solves both problems. Throws SolveError naming the vertex if the patch is not what section 4 requires.
  void solve();

  [[nodiscard]] const std::vector<CellPart>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<Index>& facets() const { return facets_; }
  /// Multipliers of a facet around the vertex, by place.
  [[nodiscard]] const FacetColumns& multipliers(int place) const { return x_[place]; }
  /// y_a of the dis problem (column 0) and y_lin,a of the lin problem (1).
  [[nodiscard]] RigidField<dim> y(int column) const;
  /// w_a (p = 1), a constant skew tensor.
  [[nodiscard]] const Tensor<dim>& w(int column) const { return w_[column]; }

 private:
  using UVector = Eigen::Matrix<double, S::u, 1>;
  using RotationVector = Eigen::Matrix<double, S::rotation, 1>;
  using BlockMatrix = Block<S::block, S::block>;

  /// L_o^{-1} S(o, f) and L_o of a cell, o its outer facet.
  struct Condensed
  {
    Eigen::LLT<BlockMatrix> outer;
    std::array<BlockMatrix, dim + 1> coupling;
    FacetColumns outer_load;
  };

  void find_rigid_motions();
  void find_multipliers_of_divergence();
  void find_skew_part();
  void assemble();
  void condense(std::size_t k);
  void assemble_loads(std::size_t k);
  void decouple_fixed_components(int place);
  void fix_rigid_motions(int place);
  [[nodiscard]] UVector moments_on_cell(const Frame<dim>& frame, int motion) const;
  [[nodiscard]] Eigen::Matrix<double, S::block, 1> moments_on_facet(Index facet, int motion) const;
  [[nodiscard]] UVector raw_load(const CellPart& part) const;
  [[nodiscard]] int local_vertex(Index facet) const;
  [[nodiscard]] double traction_work(Index facet, int column, int motion) const;

  const Mesh<dim>& mesh_;
  const FacetData<dim, p>& data_;
  Index vertex_ = 0;
  double size_ = 0;  ///< of the patch
  std::vector<CellPart> cells_;
  std::vector<Condensed> condensed_;
  std::vector<Index> facets_;
  std::vector<double> facet_scale_;  ///< |F| / |Fhat|
  std::vector<FixedFacet<dim>> fixed_facets_;
  RigidMotions<dim> motions_{Point<dim>::Zero(), 1.0, {}};
  Eigen::Matrix<double, S::rigid, 2> y_;  ///< coefficients of y_a in the rigid motions
  std::array<Tensor<dim>, 2> w_;
  BlockCholesky<S::block> matrix_;
  std::vector<FacetColumns> x_;
};

}  // namespace tribound
