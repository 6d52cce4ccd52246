#pragma once

/// @file given_data.h
/// The data of a problem on one cell, facet or contact segment, as given.

#include "tribound/contact/nitsche/datum_moments.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// f on a cell.
template <int dim>
[[nodiscard]] Datum<dim> body_datum(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                    Index cell);

/// g_N on a boundary facet, without the components that are fixed there.
template <int dim>
[[nodiscard]] Datum<dim> traction_datum(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                        const mesh::BoundaryFacet& facet);

/// The measure of a boundary facet, on the meridian of a body of revolution with the weight r.
template <int dim>
[[nodiscard]] double weighted_measure(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                      const mesh::BoundaryFacet& facet);

/// In direction 0 the stress gamma g, if g is given; in direction 1 s, in direction 2 p_w.
template <int dim>
[[nodiscard]] Datum<dim, 3> contact_datum(const ContactSegment<dim>& segment);

}  // namespace tribound::contact
