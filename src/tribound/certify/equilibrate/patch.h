#pragma once

/// @file patch.h
/// The minimisation problems on the patch of one vertex in the Arnold-Falk-Winther spaces, method section 4.

#include <array>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/patch_frame.h"

namespace tribound::certify
{

/// An object is the work space of one thread.
template <int dim, int p>
class Patch : public PatchFrame<AfwPatches<dim, p>>
{
  using Frame = PatchFrame<AfwPatches<dim, p>>;

 public:
  using S = Sizes<dim, p>;

  Patch(const mesh::Mesh<dim>& mesh, const FacetData<dim, p>& data) : Frame(mesh, data) {}

  /// Solves the problems. Throws SolveError naming the place if the patch is not what method section 4
  /// requires.
  void solve();
  /// The stress in a cell from the shares of all its patches, part by part.
  [[nodiscard]] static StressCoefficients<dim, p> stress(const PreparedCell<dim, p>& cell,
                                                         const CellShares<CellShare<dim, p>, dim>& shares,
                                                         int problem, const FacetData<dim, p>& data);

 private:
  using Operator = CellOperator<dim, p>;
  using UVector = typename Operator::UVector;
  using FacetVector = DenseVector<S::block>;
  using FacetVectors = typename Operator::FacetVectors;
  using RigidVector = std::array<double, S::rigid>;
  using Frame::cells_;
  using Frame::data_;
  using Frame::facets_;
  using Frame::factors_;
  using Frame::failure;
  using Frame::matrix_;
  using Frame::max_problems;
  using Frame::mesh_;
  using Frame::n_cells_;
  using Frame::n_problems_;
  using Frame::traction;
  using Frame::vertex_;
  using Frame::x_;
  using typename Frame::CellPart;

  /// Integrals over the patch that y_a and w_a need; b without y_a, x relative to the vertex.
  struct Moments
  {
    Point<dim> load;            ///< (b, 1)
    Tensor<dim> load_position;  ///< (b_c, x_d)
    double volume;
    Point<dim> position;            ///< (x, 1)
    Tensor<dim> position_position;  ///< (x_d, x_e)
  };

  /// In patch_compatibility.templates.h, as what it calls: Z_a, y_a and w_a.
  void make_compatible();
  void find_rigid_motions();
  [[nodiscard]] Moments integrate() const;
  [[nodiscard]] Dense<S::rigid, S::rigid> motion_gram(const Moments& moments, int n) const;
  void find_divergence_part(const Moments& moments);
  void find_skew_part(const Moments& moments);
  void assemble();
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
  [[nodiscard]] double traction_work(int problem, int motion) const;
  [[nodiscard]] double reaction_work(int motion) const;

  std::vector<FixedFacet<dim>> fixed_facets_;
  RigidMotions<dim> motions_{Point<dim>::Zero(), 1.0, {}};
  std::array<RigidField<dim>, max_problems> y_;
  std::array<Tensor<dim>, max_problems> w_;
  std::array<std::vector<FacetVector>, S::pairs> fixed_trace_;  ///< of the almost admissible rotations
  std::array<std::vector<FacetVector>, S::pairs> almost_rigid_;
};

}  // namespace tribound::certify
