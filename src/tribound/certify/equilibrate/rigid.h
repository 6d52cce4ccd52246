#pragma once

/// @file rigid.h
/// The rigid motions that the Dirichlet conditions around a vertex admit, method section 4 (Z_a).

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/certify/equilibrate/cell_operator.h"

namespace tribound::certify
{

/// Of a basis of the skew tensors.
template <int dim>
inline constexpr int n_spins = dim*(dim - 1) / 2;

/// A Dirichlet facet at the vertex: its vertices and the components fixed there.
template <int dim>
struct FixedFacet
{
  std::array<Point<dim>, dim> vertices;
  std::array<bool, dim> fixed;
};

/// The rigid motion translation + gradient (x - a) about a vertex a, gradient skew.
template <int dim>
struct RigidField
{
  Point<dim> translation;
  Tensor<dim> gradient;
};

/// Rigid motions z(x) = translation + spin (x - centre) / size with a skew spin about a vertex, the centre.
///
/// They are admissible if their fixed components vanish on every fixed facet around it. How far a rotation is
/// from that is the fixed part of its values at the vertices of these facets, s = |z_fixed| / |z|, such as
/// the sine of the angle between a facet in 2D and the component that is fixed on it.
template <int dim>
class RigidMotions
{
 public:
  static constexpr int n_all = dim + n_spins<dim>;

  /// First the admissible translations, then the admissible rotations (s <= 1e-8, an angle that rounding
  /// explains), then those that are almost admissible (s < 0.35). (A motion that vanishes at the centre in
  /// the fixed components has a translation and a rotation that do so one by one.)
  RigidMotions(const Point<dim>& centre, double size, std::span<const FixedFacet<dim>> facets);

  [[nodiscard]] int n_translations() const { return n_translations_; }
  [[nodiscard]] int n_rotations() const { return n_rotations_; }
  /// How many are admissible.
  [[nodiscard]] int size() const { return n_translations_ + n_rotations_; }
  /// How many are almost admissible, from size() on.
  [[nodiscard]] int n_almost() const { return n_almost_; }
  /// Motion i < size() + n_almost(); its gradient is skew.
  [[nodiscard]] const RigidField<dim>& operator[](int i) const { return motions_[i]; }
  /// Motion i at the point x.
  [[nodiscard]] Point<dim> operator()(int i, const Point<dim>& x) const
  {
    return motions_[i].translation + motions_[i].gradient * (x - centre_);
  }

 private:
  Point<dim> centre_;
  int n_translations_ = 0;
  int n_rotations_ = 0;
  int n_almost_ = 0;
  std::array<RigidField<dim>, n_all> motions_;
};

}  // namespace tribound::certify
