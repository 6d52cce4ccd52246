#pragma once

/// @file contact_geometry.h
/// How the polygon on which contact is solved differs from the curve or surface behind it.

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Over all contact boundaries, and over all ranks.
struct ContactGeometryFacts
{
  bool has_shape = false;      ///< whether the true surface of a body is given
  bool has_direction = false;  ///< whether contact acts along anything but the normals of the facets
  double sagitta = 0;          ///< largest distance of the facets from the true surface, at points
  double straightened = 0;     ///< mesh::sagitta() of second-order facets for which no true surface is given
  double turn = 0;             ///< degrees: the largest angle between the normals of facets that meet
  double jump = 0;             ///< degrees: the same of the directions of contact, where they meet
  double off_normal = 0;       ///< degrees: the largest angle between direction and normal, at points
};

/// Facets that meet at more than 45 degrees meet at a corner of the body and do not count.
template <int dim>
[[nodiscard]] ContactGeometryFacts contact_geometry(const contact::NitscheForm<dim>& form);

}  // namespace tribound::certify
