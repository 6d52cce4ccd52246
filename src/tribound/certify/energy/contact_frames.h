#pragma once

/// @file contact_frames.h
/// Directions of contact that vary, as polynomials (method section 13.6).

#include <cstddef>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/lagrange.h"

namespace tribound::certify
{

/// On a segment where N varies, M is the quadratic interpolant of the rotation that turns N_0, the direction
/// at the centre, to N. M N_0 and M e for tangents e at the centre take the place of N and the tangents:
/// fields are turned to M^T v, whose parts along and across N_0 obey the law, and tractions are M y.
/// Elsewhere M is the identity and N_0 is N. Keeps a reference to the form.
template <int dim>
class ContactFrames
{
 public:
  static constexpr int degree = 2;

  explicit ContactFrames(const contact::NitscheForm<dim>& form);

  [[nodiscard]] bool turns(std::size_t k) const { return begin_[k] >= 0; }
  /// N_0.
  [[nodiscard]] const Point<dim>& normal(std::size_t k) const { return normals_[k]; }
  /// M at the point with coordinates s on segment k.
  [[nodiscard]] Tensor<dim> at(std::size_t k, const Point<dim - 1>& s) const;
  /// M at contact point q of the segment.
  [[nodiscard]] Tensor<dim> at_point(std::size_t k, int q) const
  {
    return turns(k) ? interpolated(k, at_points_.values_at(q)) : Tensor<dim>(Tensor<dim>::Identity());
  }
  /// The largest |N - M N_0| at the contact points of this rank.
  [[nodiscard]] double remainder() const;

 private:
  [[nodiscard]] Tensor<dim> interpolated(std::size_t k, std::span<const double> basis) const;

  const contact::NitscheForm<dim>& form_;
  fem::LagrangeBasis<dim - 1> basis_{degree};
  fem::Tabulation<dim - 1> at_points_;
  std::vector<Point<dim>> normals_;
  std::vector<std::ptrdiff_t> begin_;  ///< of the segment in nodal_; -1: it does not turn
  std::vector<Tensor<dim>> nodal_;
};

}  // namespace tribound::certify
