#pragma once

/// @file load_facts.h
/// Loads relative to stiffness: the strain to expect before solving.

#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

/// Young's modulus and Poisson's ratio.
struct ElasticConstants
{
  double E = 0;
  double nu = 0;
};

/// E and nu from lambda and mu, the inverse of lame(). Plane stress, considered in 2D only, uses lambda_ps =
/// 2 lambda mu / (lambda + 2 mu), hence nu = lambda_ps / (lambda_ps + 2 mu).
[[nodiscard]] ElasticConstants elastic_constants(const problem::Material& material, int dimension);

struct RegionMaterial
{
  std::string region;
  double E = 0;
  double nu = 0;
  bool plane_stress = false;  ///< 2D only
};

/// A boundary with negative pressure somewhere: it pulls.
struct Suction
{
  std::string boundary;
  double lowest = 0;  ///< pressure at the quadrature points
  Place where;
};

/// Stresses and strains of a back-of-the-envelope estimate.
struct LoadFacts
{
  std::vector<double> extent;  ///< of the bounding box of the mesh
  double size = 0;             ///< its longest side L
  std::vector<RegionMaterial> materials;
  double smallest_E = 0;
  double largest_body_force = 0;   ///< largest mean of |f| over a cell
  double traction_stress = 0;      ///< the largest mean of |g_N| over a boundary
  double support_stress = 0;       ///< |int f + int g_N| over the area held by contact or displacements
  double body_stress = 0;          ///< max |f| L
  double displacement_strain = 0;  ///< range of a component, prescribed or of springs at rest, / L; it
                                   ///< includes 0 with contact and springs; or of a slider's motion
  double interference_strain = 0;  ///< the largest interference, -g, / L
  double thermal_strain = 0;       ///< largest |alpha (temperature - reference)|
  double initial_stress = 0;       ///< largest |sigma_0| but for temperature
  /// |F| / (L int |K|), F the components of int f + int g_N that no displacement condition takes up: how far
  /// the loads move what springs alone hold, / L; 0 with contact.
  double spring_shift = 0;
  bool has_springs = false;
  std::vector<Suction> suction;

  /// The largest of the stresses that need balance.
  [[nodiscard]] double stress() const;
  /// stress() / smallest E, displacement_strain, interference_strain, thermal_strain or initial_stress /
  /// smallest E, whichever is the largest.
  [[nodiscard]] double strain() const;
};

template <int dim>
[[nodiscard]] LoadFacts load_facts(const contact::NitscheForm<dim>& form);

}  // namespace tribound::doctor
