#pragma once

/// @file pair_facts.h
/// The geometry of each pair of bodies in contact before anything is solved.

#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

struct PairFacts
{
  std::string name;  ///< such as `"dam.base" on "rock.top"`, slave first
  bool is_tied = false;
  bool geometric_gap = false;  ///< the gap is the distance of the meshes
  long segments = 0;
  double covered_share = 0;  ///< of the length or area of the slave
  double smallest_gap = 0;   ///< the smallest |g| at the quadrature points over the h_k there
  double turn = 0;           ///< the largest angle between neighbouring facets of the slave, degrees
  Place turn_at;
  double stretch = 0;  ///< the largest max(dM/dS, dS/dM)
  Place stretch_at;
  double distance = 0;  ///< the largest |Pi(x) - x| at corners of segments
  Place distance_at;
  double size = 0;  ///< diagonal of the bounding box of the covered part of the slave
};

/// In the order of the problem.
template <int dim>
[[nodiscard]] std::vector<PairFacts> pair_facts(const contact::NitscheForm<dim>& form);

}  // namespace tribound::doctor
