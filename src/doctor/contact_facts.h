#pragma once

/// @file contact_facts.h
/// The geometry of each contact boundary before anything is solved.

#include <string>
#include <vector>

#include "contact/nitsche.h"
#include "doctor/place.h"

namespace tribound
{

struct ContactBoundaryFacts
{
  std::string name;
  long facets = 0;
  double measure = 0;  ///< length or area
  Place normal;        ///< mean unit normal, weighted by measure; empty for a closed surface, which has none
  double spread = 0;   ///< degrees: the largest angle between a facet's normal and the mean
  double kink = 0;     ///< degrees: the largest angle below 45 between normals of facets that share a vertex
                       ///< (2D) or an edge (3D); larger ones are corners of the body
  Place kink_at;
  double smallest_gap = 0;  ///< g at the quadrature points
  Place smallest_gap_at;
  double largest_gap = 0;
  Place largest_gap_at;
};

/// Facts of every contact boundary that has facets, in the order of the problem.
template <int dim>
[[nodiscard]] std::vector<ContactBoundaryFacts> contact_boundary_facts(const NitscheForm<dim>& form);

/// Pairs of contact facets of one boundary that share a vertex (2D) or an edge (3D), by their numbers in the
/// form.
template <int dim>
[[nodiscard]] std::vector<std::array<int, 2>> contact_neighbours(const NitscheForm<dim>& form);

}  // namespace tribound
