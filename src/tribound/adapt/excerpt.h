#pragma once

/// @file excerpt.h
/// Some cells of a level on several ranks, gathered on the first rank to display the solution.

#include <cstdint>
#include <memory>
#include <optional>

#include "tribound/adapt/levels.h"

namespace tribound::adapt
{

/// Cells with the fields on them. Facets next to omitted cells are no boundary. Dirichlet, contact and
/// Neumann conditions are those on the boundary facets present.
template <int dim>
struct Excerpt
{
  std::shared_ptr<const Discretisation<dim>> discrete;
  /// u, the stress (all of it in `dis`) and the estimate refer to these cells; no tractions, and no
  /// equilibrium.
  CertifiedLevel<dim> level;
  bool is_merged = false;  ///< whether cells were merged, see merge_cells()
};

/// The cells of all ranks, merged if there are more than `most`; if that is not enough, only those at the
/// boundary. Empty except on the first rank. All ranks call it together.
template <int dim>
[[nodiscard]] std::optional<Excerpt<dim>> excerpt(const LevelView<dim>& view, const Method& method,
                                                  std::int64_t most);

/// The cells at the boundary.
template <int dim>
[[nodiscard]] std::optional<Excerpt<dim>> boundary_excerpt(const LevelView<dim>& view, const Method& method);

}  // namespace tribound::adapt
