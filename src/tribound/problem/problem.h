#pragma once

/// @file problem.h
/// The continuous problem of method section 1: material, loads, and what holds on each part of the boundary.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/case/config.h"

namespace tribound::problem
{

/// Lame coefficients as used by sigma(u) = lambda tr eps(u) I + 2 mu eps(u); stress units.
struct Material
{
  double lambda = 0.0;
  double mu = 0.0;
  case_file::PlaneModel plane = case_file::PlaneModel::strain;  ///< 2D: whether eps_zz or sigma_zz vanishes
};

/// lambda = E nu / ((1+nu)(1-2nu)), mu = E / (2(1+nu)); plane stress: lambda replaced by
/// 2 lambda mu / (lambda + 2 mu).
[[nodiscard]] Material lame(double E, double nu, case_file::PlaneModel plane);

/// What holds on one named part of the boundary.
template <int dim>
struct BoundaryCondition
{
  std::string name;
  std::array<std::optional<Expression>, dim> displacement;  ///< fixed components (Gamma_D)
  std::array<Expression, dim> traction;                     ///< g_N on the free components
  std::optional<Expression> pressure;                       ///< adds -pressure n to g_N
  std::optional<case_file::Contact> contact;                ///< Gamma_C
  Where where;

  [[nodiscard]] bool fixes(int component) const { return displacement[component].has_value(); }
  [[nodiscard]] bool fixes_any() const;
  /// Whether g_N can be non-zero.
  [[nodiscard]] bool is_loaded() const;
  /// g_N at x with outward unit normal n; components that are fixed are 0.
  [[nodiscard]] Point<dim> load(const Point<dim>& x, const Point<dim>& n) const;
};

/// Gap g(x) >= 0 and Tresca's threshold s(x) >= 0. Values that may be 0 within the rounding of x are: "y" on
/// a floor y = 0 whose points have rounded coordinates. Throw InputError naming the point where the value is
/// negative.
template <int dim>
[[nodiscard]] double gap_at(const case_file::Contact& contact, const Point<dim>& x);
template <int dim>
[[nodiscard]] double threshold_at(const case_file::Tresca& law, const Point<dim>& x);

/// The problem on a mesh whose regions and boundaries carry the given names. Regions and boundaries are
/// referred to by their position in these lists, so that refinement, which inherits tags, leaves the problem
/// valid.
template <int dim>
class Problem
{
 public:
  /// Resolves names. Throws InputError for a group that does not exist (listing those that do), for a region
  /// without material, for a boundary group of a mesh file that the case forgets, for vectors of wrong
  /// length. Sides of a box that are not mentioned are traction-free.
  Problem(const case_file::Config& config, std::span<const std::string> region_names,
          std::span<const std::string> boundary_names);

  [[nodiscard]] const Material& material(int region) const { return materials_[region]; }
  /// f in the region; force per volume.
  [[nodiscard]] const std::array<Expression, dim>& body_force(int region) const { return body_[region]; }
  [[nodiscard]] Point<dim> body_force(int region, const Point<dim>& x) const;
  /// Whether f is the same everywhere in the region.
  [[nodiscard]] bool body_force_is_constant(int region) const;
  /// Whether f vanishes identically in the region.
  [[nodiscard]] bool body_force_is_zero(int region) const;

  /// The condition on boundary number `tag`; a negative tag means a facet in no group: traction-free.
  [[nodiscard]] const BoundaryCondition<dim>& boundary(int tag) const
  {
    return tag < 0 ? unnamed_ : boundaries_[tag];
  }
  [[nodiscard]] std::span<const BoundaryCondition<dim>> boundaries() const { return boundaries_; }
  [[nodiscard]] std::span<const std::string> region_names() const { return region_names_; }
  [[nodiscard]] bool has_contact() const;

 private:
  std::vector<std::string> region_names_;
  std::vector<Material> materials_;
  std::vector<std::array<Expression, dim>> body_;
  std::vector<BoundaryCondition<dim>> boundaries_;
  BoundaryCondition<dim> unnamed_;
};

}  // namespace tribound::problem
