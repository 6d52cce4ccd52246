#pragma once

/// @file support_facts.h
/// How the bodies are supported, and where conditions contradict each other.

#include <optional>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/support/support.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

/// A rigid motion that is free under displacement conditions and ties, and is stopped only by contact.
struct ContactHeldMotion
{
  std::string body;                       ///< or bodies
  std::string motion;                     ///< such as "translation along x"
  bool by_friction = false;               ///< stopped by friction only; else by pressure, one way
  std::optional<contact::Remedy> remedy;  ///< what would stop it without contact
  bool of_several = false;                ///< of bodies joined by contact
};

/// The motions of every assembly that only contact stops: first those stopped by pressure, then by friction.
template <int dim>
[[nodiscard]] std::vector<ContactHeldMotion> motions_held_by_contact(const contact::NitscheForm<dim>& form);

/// Per boundary number, whether a body would slide along this obstacle or slave as a whole without its
/// friction. This requires that the facets of the boundary are within 10 degrees of a plane, and that neither
/// displacement conditions and ties nor closed frictionless contact stop a rigid motion along the plane.
/// There, and only there, resultants tell how far sliding is. Refinement does not change this. Needs the
/// whole mesh.
template <int dim>
[[nodiscard]] std::vector<bool> slides_as_a_whole(const problem::Problem<dim>& problem,
                                                  const mesh::Mesh<dim>& mesh);

/// Vertices where a contact boundary meets a boundary that fixes the normal displacement.
struct OverconstrainedCorner
{
  std::string contact;
  std::string displacement;
  long vertices = 0;
  Place where;          ///< the vertex with the largest u_D^n - g
  double normal = 0;    ///< u_D^n there
  double gap = 0;       ///< g there
  bool sticks = false;  ///< whether everything is prescribed there and the contact has friction

  /// Whether the body is pushed into the obstacle, so that there is no solution.
  [[nodiscard]] bool contradicts() const;
};

/// One for each such pair of boundaries.
template <int dim>
[[nodiscard]] std::vector<OverconstrainedCorner> overconstrained_corners(
    const contact::NitscheForm<dim>& form);

}  // namespace tribound::doctor
