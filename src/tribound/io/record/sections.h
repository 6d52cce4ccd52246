#pragma once

/// @file sections.h
/// Forces and moments that the equilibrated stress carries through a plane (in 2D a line).

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/base/error.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/field.h"

namespace tribound::io
{

/// The plane through `point` across `normal`.
template <int dim>
struct Section
{
  std::string name;
  Point<dim> point;
  Point<dim> normal;                       ///< n, of length 1
  std::optional<problem::Field> within{};  ///< only where it is positive, at the centroid of what a cell has
  Where where;
};

/// What the part in front of the plane, to which n points, exerts on the part behind it; per unit of depth in
/// 2D. Moments are about Section::point. Of bodies of revolution: see docs/revolution.md.
struct SectionRecord
{
  std::string name;
  double measure = 0;          ///< length or area
  std::vector<double> force;   ///< integral of sigma_h n
  std::vector<double> moment;  ///< one number in 2D
  std::vector<double> axes;    ///< n and the axes t of V: in 2D n turned by +90 degrees, in 3D two
  double N = 0;                ///< force . n, positive in tension
  std::vector<double> V;       ///< force . t
  std::vector<double> M;       ///< the moment; in 3D about n (torsion) and about the axes t (bending)
  std::string note;            ///< why moments are not in equilibrium; empty: they are
};

/// Throws InputError for a plane that cuts no cell, or none within. All ranks call it together.
template <int dim>
void check_sections(const mesh::Mesh<dim>& mesh, std::span<const Section<dim>> sections);

/// The forces F and moments M of sigma_h on S = {(x - point) . n = 0}, integrals over the cuts T & S of
/// cells,
///     F = sum of int_{T & S} sigma_h n,
///     M = sum of int_{T & S} (x - point) x sigma_h n - int_{T-} a(sigma_h),
/// T- the part of a cut cell T behind S, a = (s_32 - s_23, s_13 - s_31, s_21 - s_12) the axial vector, in 2D
/// its last entry: exact for polynomials of degree p. Facets in S count with the cell behind it. They are in
/// equilibrium with the loads on either side (docs/method.md, sections 4.7 and 19.4). Moments need p >= 2 and
/// the weakly symmetric stress, which is made here where `level` has another one; on a meridian they are 0.
/// All ranks call it together; the result is the same on all. `level` must have its stress.
template <int dim>
[[nodiscard]] std::vector<SectionRecord> read_sections(const contact::NitscheForm<dim>& form,
                                                       const adapt::CertifiedLevel<dim>& level,
                                                       std::span<const Section<dim>> sections);

}  // namespace tribound::io
