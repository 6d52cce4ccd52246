#pragma once

/// @file multigrid.h
/// Multigrid as a preconditioner: down through degrees and meshes, algebraic from there on.

#include <utility>
#include <vector>

#include "tribound/algebra/node_hierarchy.h"
#include "tribound/algebra/petsc.h"

struct _p_PC;

namespace tribound::algebra
{

/// V-cycles over a hierarchy of spaces. Each step smooths by two Chebyshev iterations with the diagonal
/// before and after, and passes to the matrix P^T A P of the coarser space, where P is the inclusion. The
/// coarsest space is solved by a factorisation if it is small, otherwise by smoothed aggregation with rigid
/// body modes (PETSc's GAMG); that is all there is if the hierarchy has no steps. Degrees of freedom whose
/// row is 0 off the diagonal, those fixed on Gamma_D, stay decoupled on all levels.
class Multigrid
{
 public:
  explicit Multigrid(NodeHierarchy hierarchy) : hierarchy_(std::move(hierarchy)) {}

  /// Makes `pc` this preconditioner; to be called before its options are read.
  void configure(_p_PC* pc) const;
  /// Gives `pc` the coarse matrices of `a`, before its set-up; products with them are in single precision.
  /// Interpolations and patterns are made for the first `a`; later ones must have the same pattern.
  void renew(_p_PC* pc, const SparseMatrix& a);
  /// To be called after its set-up. From now on products on the levels of aggregation are in single
  /// precision, too. If `changing` is not null, the next matrices will differ from this one in that part
  /// alone, whose entries are among theirs: renewing the levels then costs only what the part costs.
  void settle(_p_PC* pc, _p_Mat* changing) const;

 private:
  struct Level
  {
    MatHandle interpolation;  ///< P
    MatHandle matrix;         ///< P^T A P
  };

  void make_levels(_p_PC* pc, const SparseMatrix& finest);
  void set_rigid_body_modes(_p_Mat* coarsest);

  NodeHierarchy hierarchy_;
  std::vector<Level> levels_;  ///< as hierarchy_.steps
  Sharing sharing_;            ///< of the finest matrix
  bool made_ = false;
};

}  // namespace tribound::algebra
