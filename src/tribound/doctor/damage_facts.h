#pragma once

/// @file damage_facts.h
/// Whether the facets resolve an interface that softens and fails (method section 12.1).

#include <optional>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

/// Where gamma is closest to the softening slope of a law on a boundary.
struct Softening
{
  double slope = 0;  ///< 0: nothing softens
  double gamma = 0;
  double h = 0;  ///< of the facet
  Place where;

  [[nodiscard]] double ratio() const { return slope > 0 ? slope / gamma : 0; }
};

struct DamageFacts
{
  Softening softening;
  /// Rows of facets between the broken part (D = 1 all over a facet) and the intact one: A / (a f (dim - 1)).
  /// A is the measure of the points where 0 < D < 1, a the mean measure of facets with such points, and f the
  /// number of vertices (2D) or edges (3D) between broken and other facets; in 3D two triangles make a row.
  /// Empty unless there are both broken facets and points with 0 < D < 1.
  std::optional<double> process_zone;
  double open_cohesion = 0;  ///< of a joint without tensile strength, whose cohesion survives opening
};

/// The states at the points of a segment.
template <int dim>
using SegmentStates = std::vector<contact::ContactState<dim>>;

/// The facts of the boundary `tag`, with the states on every segment of the form.
template <int dim>
[[nodiscard]] DamageFacts damage_facts(const contact::NitscheForm<dim>& form,
                                       std::span<const SegmentStates<dim>> states, int tag);

}  // namespace tribound::doctor
