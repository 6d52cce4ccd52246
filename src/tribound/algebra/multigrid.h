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

/// V-cycles over a hierarchy of spaces. A step smooths by two Chebyshev iterations with the diagonal before
/// and after, and leads to the matrix P^T A P of the coarser space, P the inclusion. On the coarsest space
/// stands a factorisation where it is small, otherwise smoothed aggregation with rigid body modes (PETSc's
/// GAMG): all there is if the hierarchy has no steps. Degrees of freedom whose row is 0 beside the diagonal,
/// those that Gamma_D fixes, stay decoupled on all levels.
class Multigrid
{
 public:
  explicit Multigrid(NodeHierarchy hierarchy) : hierarchy_(std::move(hierarchy)) {}

  /// Makes `pc` this preconditioner, before its options are read.
  void configure(_p_PC* pc) const;
  /// Gives `pc` the coarse matrices of `a`, before its set-up; products with them are in single precision.
  /// Interpolations and patterns are made for the first `a`; later ones must have its pattern.
  void renew(_p_PC* pc, const SparseMatrix& a);
  /// After its set-up: products on the levels of aggregation, too, are in single precision from
  /// now on. If `changing` is not null, the next matrices will differ from this one in that part alone, whose
  /// entries are among theirs: renewing the levels then costs what it costs for the part.
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
