#pragma once

/// @file contact_geometry.h
/// How the polygon on which contact is solved differs from the true curve or surface.

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Over all contact boundaries and all ranks.
struct ContactGeometryFacts
{
  bool has_shape = false;      ///< whether the true surface of a body is given
  bool has_direction = false;  ///< whether contact acts along other directions than the facet normals
  double sagitta = 0;          ///< largest distance of the facets from the true surface, at points
  double straightened = 0;     ///< mesh::sagitta() of second-order facets for which no true surface is given
  double turn = 0;             ///< degrees: the largest angle between the normals of adjacent facets
  double jump = 0;             ///< degrees: the same for the directions of contact, at common vertices
  double off_normal = 0;       ///< degrees: the largest angle between direction and normal, at points
};

/// Facets that meet at more than 45 degrees form a corner of the body and do not count.
template <int dim>
[[nodiscard]] ContactGeometryFacts contact_geometry(const contact::NitscheForm<dim>& form);

}  // namespace tribound::certify
