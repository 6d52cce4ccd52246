#pragma once

/// @file contact_line.h
/// contact.csv: the state of the contact at the quadrature points.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/io/fields/vtu.h"

namespace tribound::io
{

/// A contact segment as a link of a chain.
struct ChainLink
{
  int segment;    ///< index in NitscheForm::segments()
  bool reversed;  ///< whether the chain traverses it opposite to its reference coordinate
  double arc;     ///< arc length at its first end
};

/// The contact facets of boundary group `tag` in 2D, joined end to end. A chain starts at its end with the
/// smallest x (then y), a closed one at its vertex with the smallest x (then y). Chains are sorted by their
/// starting points, and the arc length continues from one chain to the next.
[[nodiscard]] std::vector<ChainLink> contact_chains(const contact::NitscheForm<2>& form, int tag);

/// contact.csv: one row per quadrature point of form.facet_rule(), sorted along each boundary in 2D, facet by
/// facet in 3D. Columns: boundary,facet,x,y[,z],nx,ny[,nz][,arc],pressure,traction_x,traction_y[,traction_z],
/// limit,status,gap,slip_x,slip_y[,slip_z],weight,level,pair; arc in 2D only, status 0 open, 1 stick, 2 slip,
/// 3 tied, pair empty against an obstacle; for a load step `number` also damage,opening,plastic_slip_x,...
/// The sum of weight times a column is its integral over the boundary as computed by the program. Coordinates
/// and components of normals at rounding level are 0.
template <int dim>
[[nodiscard]] std::string contact_csv(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                      const SeriesPlace& place);

/// Writes contact_csv() to `path`. Throws WriteError when the file cannot be written.
template <int dim>
void write_contact_csv(const std::filesystem::path& path, const contact::NitscheForm<dim>& form,
                       std::span<const double> u, const SeriesPlace& place);

}  // namespace tribound::io
