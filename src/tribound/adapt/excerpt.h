#pragma once

/// @file excerpt.h
/// Some cells of a level on several ranks, all on the first: what is shown of a solution as one.

#include <memory>
#include <optional>
#include <span>

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
};

/// Those own cells of each rank; nothing elsewhere than on the first rank. All ranks call it together.
template <int dim>
[[nodiscard]] std::optional<Excerpt<dim>> excerpt(const LevelView<dim>& view, const Method& method,
                                                  std::span<const Index> cells);

}  // namespace tribound::adapt
