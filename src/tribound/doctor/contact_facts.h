#pragma once

/// @file contact_facts.h
/// The geometry of each contact boundary before anything is solved.

#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

struct ContactBoundaryFacts
{
  std::string name;
  long facets = 0;
  double measure = 0;  ///< length or area
  Place normal;        ///< mean unit normal, weighted by measure; empty for a closed surface, which has none
  double spread = 0;   ///< degrees: the largest angle between a facet's normal and the mean
  double kink = 0;     ///< the largest kink()
  Place kink_at;
  double off_normal =
      0;  ///< degrees: the largest angle between the direction of contact and a facet's normal
  Place off_normal_at;
  double straightened = 0;  ///< mesh::sagitta() of second-order facets without a shape
  double smallest_gap = 0;  ///< g at the quadrature points
  Place smallest_gap_at;
  double largest_gap = 0;
  Place largest_gap_at;
  bool is_bilateral = false;  ///< sliders and ties: nothing opens, the gap is a prescribed displacement
};

/// The angle between two unit vectors, degrees.
template <int dim>
[[nodiscard]] double degrees_between(const Point<dim>& a, const Point<dim>& b);

/// The angle between the directions of contact on neighbouring facets where they meet, degrees. 0 from 45 on,
/// which is a corner of the body and not a curved surface, and below 0.01, which is round-off of the
/// coordinates in a file.
template <int dim>
[[nodiscard]] double kink(const mesh::Mesh<dim>& mesh, const contact::ContactSegment<dim>& a,
                          const contact::ContactSegment<dim>& b);

/// Facts of every contact boundary that has facets, in the order of the problem.
template <int dim>
[[nodiscard]] std::vector<ContactBoundaryFacts> contact_boundary_facts(const contact::NitscheForm<dim>& form);

/// Whether segment k is the first of its slave facet, whose segments come one after another.
template <int dim>
[[nodiscard]] bool is_first_of_facet(const contact::NitscheForm<dim>& form, int k)
{
  return k == 0 || form.segments()[k - 1].slave.number != form.segments()[k].slave.number;
}

/// Pairs of facets of one boundary that share a vertex (2D) or an edge (3D), by the indices of their first
/// segments in the form.
template <int dim>
[[nodiscard]] std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<dim>& form);

}  // namespace tribound::doctor
