#pragma once

/// @file probes.h
/// The solution at points that a case names.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/base/error.h"
#include "tribound/mesh/mesh.h"

namespace tribound::io
{

template <int dim>
struct Probe
{
  std::string name;
  std::vector<Point<dim>> points;  ///< one, or those along a line
  Where where;
};

/// What is read at a point of a probe in one region of one body. Where facets meet at the point, the means
/// over the cells of this region that have it: stresses jump there.
struct ProbeRow
{
  std::size_t point = 0;  ///< number in Probe::points
  std::vector<double> x;
  std::string body;  ///< body_names()
  std::string region;
  std::vector<double> u;
  std::array<double, 6> stress{};                          ///< sigma(u_h), as symmetric_part() has it
  std::optional<std::array<double, 6>> equilibrated = {};  ///< sigma_h; absent without a bound
  /// The largest |sigma(u_h) - sigma_h| of these cells, Frobenius norm: an indication of the error, no bound.
  std::optional<double> difference = {};
};

struct ProbeRecord
{
  std::string name;
  std::vector<ProbeRow> rows{};  ///< point after point; one on an interface has a row for each side
};

/// Throws InputError for a point that no cell has, and tells how far from the mesh it is. A point at most
/// 1e-10 of the diagonal of the box around the mesh outside a cell counts as one of its points. All ranks
/// call it together.
template <int dim>
void check_probes(const mesh::Mesh<dim>& mesh, std::span<const Probe<dim>> probes);

/// What is read of a solution; sigma_h where `has_bound`. Points must have passed check_probes() on this
/// mesh, or on one that it refines. All ranks call it together; the result is the same on all.
template <int dim>
[[nodiscard]] std::vector<ProbeRecord> read_probes(const contact::NitscheForm<dim>& form,
                                                   const adapt::CertifiedLevel<dim>& level, bool has_bound,
                                                   std::span<const Probe<dim>> probes);

}  // namespace tribound::io
