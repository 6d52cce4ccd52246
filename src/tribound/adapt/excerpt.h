#pragma once

/// @file excerpt.h
/// Some cells of a level on several ranks, all on the first: what is shown of a solution as one.

#include <cstdint>
#include <memory>
#include <optional>

#include "tribound/adapt/levels.h"

namespace tribound::adapt
{

/// Cells with the fields on them. Facets where others are left out are no boundary, and Dirichlet's,
/// contact's and Neumann's conditions are those on the boundary facets that are there.
template <int dim>
struct Excerpt
{
  std::shared_ptr<const Discretisation<dim>> discrete;
  /// u, the stress (all of it in `dis`) and the cells of the estimate are those of the cells; no tractions,
  /// and no equilibrium.
  CertifiedLevel<dim> level;
  bool is_merged = false;  ///< whether cells were put together, see merge_cells()
};

/// The cells of all ranks, merged where there are more than `most`; where that is not enough those at the
/// boundary. Nothing elsewhere than on the first rank. All ranks call it together.
template <int dim>
[[nodiscard]] std::optional<Excerpt<dim>> excerpt(const LevelView<dim>& view, const Method& method,
                                                  std::int64_t most);

/// The cells at the boundary.
template <int dim>
[[nodiscard]] std::optional<Excerpt<dim>> boundary_excerpt(const LevelView<dim>& view, const Method& method);

}  // namespace tribound::adapt
