#pragma once

/// @file meridian_rules.h
/// Rules for integrals over the radius on the cells of a meridian mesh, whose points are (r, z) with r >= 0.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tribound/fem/quadrature.h"
#include "tribound/mesh/mesh.h"

namespace tribound::fem
{

/// Upper bound of the relative error of int Q / r by a rule with positive weights that is exact for degree
/// deg Q + `extra`, for Q >= 0 on a set with 0 < `least` <= r <= `largest`: 2 `largest` times the best
/// approximation of 1 / r by polynomials of degree `extra`.
[[nodiscard]] double inverse_radius_error(double least, double largest, int extra);

/// For each cell a rule for the integrals of Q / r, of Q and of r Q, Q a polynomial of degree <= `degree`
/// that is a multiple of r on cells with an edge on the axis. If one vertex lies on the axis (r = 0), r is s
/// times a function of t in coordinates collapsed there, and 1 / r has the singularity that the determinant s
/// takes away. No point of a rule lies on the axis.
class MeridianRules
{
 public:
  MeridianRules(const mesh::Mesh<2>& mesh, int degree);
  /// For any triangles in place of the cells, with these radii of their vertices.
  MeridianRules(std::span<const std::array<double, 3>> radii, int degree);

  [[nodiscard]] int size() const { return static_cast<int>(rules_.size()); }
  [[nodiscard]] const Quadrature<2>& operator[](int number) const { return rules_[number]; }
  /// The number of the rule of a cell.
  [[nodiscard]] int number(Index cell) const { return numbers_[cell]; }
  [[nodiscard]] const Quadrature<2>& of_cell(Index cell) const { return rules_[numbers_[cell]]; }
  /// Of int Q / r, Q >= 0: at most 1e-13, unless the cell is far longer than its distance from the axis.
  [[nodiscard]] double relative_error(Index cell) const { return errors_[cell]; }

 private:
  std::vector<Quadrature<2>> rules_;
  std::vector<std::uint8_t> numbers_;
  std::vector<double> errors_;
};

}  // namespace tribound::fem
