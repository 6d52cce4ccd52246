#pragma once

/// @file patch.h
/// The minimisation problems on the patch of one vertex, method section 4: gather, condense, factor, solve.

#include <array>
#include <span>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/certify/equilibrate/block_cholesky.h"
#include "tribound/certify/equilibrate/facet_data.h"
#include "tribound/certify/equilibrate/prepared_cell.h"

namespace tribound::certify
{

/// The problems of a vertex: discretisation, linearisation and, for delta > 0, regularisation, numbers 0, 1
/// and 2 of everything that all have. An object is the work space of one thread.
template <int dim, int p>
class Patch
{
 public:
  using S = Sizes<dim, p>;

  Patch(const mesh::Mesh<dim>& mesh, const FacetData<dim, p>& data) : mesh_(mesh), data_(data) {}

  /// Starts the patch of a vertex.
  void begin(Index vertex);
  /// `shares` takes the results: dis, and on Gamma_C those of the other problems.
  void add_cell(Index cell, const PreparedCell<dim, p>& prepared, std::span<CellShare<dim, p>> shares);
  /// Solves the problems. Throws SolveError naming the place if the patch is not what method section 4
  /// requires.
  void solve();

 private:
  static constexpr int max_problems = 3;

  using Operator = CellOperator<dim, p>;
  using UVector = typename Operator::UVector;
  using FacetVector = DenseVector<S::block>;
  using FacetVectors = typename Operator::FacetVectors;
  using RigidVector = std::array<double, S::rigid>;

  struct CellPart
  {
    int vertex;                       ///< the patch's vertex in the sorted cell: also its outer facet
    std::array<int, dim + 1> facets;  ///< index in `facets_`, -1 for the outer one
    const PreparedCell<dim, p>* prepared;
    std::span<CellShare<dim, p>> shares;
    const OuterElimination<dim, p>* outer;  ///< of the cell's shape, or `own_outer`
    OuterElimination<dim, p> own_outer;
    std::array<FacetVector, max_problems> outer_load;  ///< U(o, o)^{-T} g_o
  };

  struct PatchFacet
  {
    Index number;
    double scale;  ///< |F| / |Fhat|
  };

  /// Integrals over the patch that y_a and w_a need; b without y_a, x relative to the vertex.
  struct Moments
  {
    Point<dim> load;            ///< (b, 1)
    Tensor<dim> load_position;  ///< (b_c, x_d)
    double volume;
    Point<dim> position;            ///< (x, 1)
    Tensor<dim> position_position;  ///< (x_d, x_e)
  };

  /// What to throw where the patch has no solution.
  [[nodiscard]] SolveError failure() const;
  void order_facets();
  /// In patch_compatibility.templates.h, as what it calls: Z_a, y_a and w_a.
  void make_compatible();
  void find_rigid_motions();
  [[nodiscard]] Moments integrate() const;
  [[nodiscard]] Dense<S::rigid, S::rigid> motion_gram(const Moments& moments, int n) const;
  void find_divergence_part(const Moments& moments);
  void find_skew_part(const Moments& moments);
  void assemble();
  void condense(CellPart& part);
  void assemble_load(CellPart& part, int problem);
  void decouple_fixed_components(int facet);
  void fix_rigid_motions();
  void recover(CellPart& part, int problem);
  [[nodiscard]] UVector raw_load(const CellPart& part) const;
  /// In patch_almost_rigid.templates.h: motions that Gamma_D hardly stops.
  void load_almost_rigid();
  void balance_almost_rigid();
  [[nodiscard]] FacetVector trace(int facet, int motion, bool fixed) const;
  [[nodiscard]] int holding_facet(int motion) const;
  [[nodiscard]] FacetVector moments_on_facet(int facet, int motion) const;
  [[nodiscard]] int local_vertex(Index facet) const;
  [[nodiscard]] double traction_work(int problem, int motion) const;
  [[nodiscard]] double reaction_work(int motion) const;
  [[nodiscard]] const typename FacetData<dim, p>::FacetVector* traction(Index facet, int problem) const;

  const mesh::Mesh<dim>& mesh_;
  const FacetData<dim, p>& data_;
  Index vertex_ = 0;
  int n_problems_ = 0;  ///< 1 off Gamma_C: there the data of lin and reg vanish
  double size_ = 0;     ///< of the patch
  int n_cells_ = 0;
  std::vector<CellPart> cells_;     ///< the first n_cells_ of them
  std::vector<PatchFacet> facets_;  ///< around the vertex, in the order of elimination
  std::vector<PatchFacet> found_;   ///< the same as they were found
  std::vector<FixedFacet<dim>> fixed_facets_;
  RigidMotions<dim> motions_{Point<dim>::Zero(), 1.0, {}};
  std::array<RigidField<dim>, max_problems> y_;
  std::array<Tensor<dim>, max_problems> w_;
  BlockCholesky<S::block> matrix_;
  std::array<std::vector<FacetVector>, max_problems> x_;
  std::array<std::vector<FacetVector>, S::pairs> fixed_trace_;  ///< of the almost admissible rotations
  std::array<std::vector<FacetVector>, S::pairs> almost_rigid_;
};

}  // namespace tribound::certify
