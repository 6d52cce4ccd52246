#pragma once

/// @file free_motions.h
/// The rigid motions of bodies that displacement conditions do not stop.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/rigid_modes.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// The rigid motions of each body whose fixed components vanish on Gamma_D, as an orthonormal basis of their
/// coefficients (contact::RigidModes): up to d(d+1)/2 for each body, one for a body of revolution, none for
/// bodies that conditions hold. All ranks construct it and call its members together, and each has the
/// motions of all bodies.
template <int dim>
class FreeMotions
{
 public:
  FreeMotions(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh);

  /// Whether for some motion it is unclear if conditions stop it, because they hardly do.
  [[nodiscard]] bool is_unclear() const { return is_unclear_; }
  /// The number of motions of all bodies.
  [[nodiscard]] std::size_t size() const { return motions_.size(); }
  [[nodiscard]] int n_bodies() const { return bodies_.n; }
  [[nodiscard]] int body_of(Index cell) const { return bodies_.of_cell[cell]; }

  /// A range of numbers of motions.
  struct Range
  {
    int begin;
    int end;
    [[nodiscard]] int size() const { return end - begin; }
  };
  [[nodiscard]] Range of_body(int body) const { return {begin_[body], begin_[body + 1]}; }
  [[nodiscard]] Range of_cell(Index cell) const { return of_body(body_of(cell)); }

  /// z_i(x).
  [[nodiscard]] Point<dim> operator()(int i, const Point<dim>& x) const
  {
    return modes_[i].at(x) * motions_[i];
  }

  /// As many degrees of freedom as motions, none of them `fixed`, far from each other; no motion of a body
  /// except 0 leaves all of its own at rest. Returns those that this rank owns: dim * k + component for the
  /// own node k.
  [[nodiscard]] std::vector<Index> supports(const fem::LagrangeSpace<dim>& space,
                                            std::span<const char> fixed) const;

 private:
  using Modes = contact::RigidModes<dim>;

  mesh::Bodies bodies_;
  std::vector<int> begin_;                             ///< per body: its first motion
  std::vector<Modes> modes_;                           ///< per motion: those of its body
  std::vector<typename Modes::Coefficients> motions_;  ///< z_i
  bool is_unclear_ = false;
};

}  // namespace tribound::certify
