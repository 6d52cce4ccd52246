#pragma once

/// @file nodal_forces.h
/// Forces at nodes as tractions.

#include <map>
#include <vector>

#include "tribound/case/deck/deck_faces.h"

namespace tribound::case_file
{

/// A uniform traction on connected faces with the resultant of the nodal forces there.
struct SpreadForce
{
  std::vector<Index> faces{};
  Point<3> traction = Point<3>::Zero();  ///< force per area, in plane decks per length
  double area = 0;
  bool keeps_resultant = false;  ///< whether force and moment are those of the nodal forces, to a hundredth
  bool is_exact = false;         ///< whether the forces are those of this traction
};

struct SpreadForces
{
  std::vector<SpreadForce> parts{};
  std::vector<Index> lone_nodes{};  ///< of no face that has forces at all its nodes
};

/// The faces are those that have forces at all nodes to which a uniform traction gives some.
[[nodiscard]] SpreadForces spread(const DeckFaces& faces, const std::map<Index, Point<3>>& forces);

}  // namespace tribound::case_file
