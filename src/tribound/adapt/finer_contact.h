#pragma once

/// @file finer_contact.h
/// A solution on a mesh with matching facets, refined where the contact state changes, for error bars.

#include <memory>
#include <span>
#include <vector>

#include "tribound/adapt/level.h"

namespace tribound::adapt
{

/// The same function u on a mesh that is bisected, or cut otherwise. Not movable: its parts refer to each
/// other.
template <int dim>
struct FinerContact
{
  std::unique_ptr<const Grid<dim>> grid;
  /// With gamma and {sigma} of the original form, so that T(u) is the same function.
  std::unique_ptr<const contact::NitscheForm<dim>> form;
  std::vector<double> u;
  std::vector<Index> parent;  ///< per own cell: the own cell of the previous mesh that contains it
};

/// Throws SolveError where the function on the finer mesh is not u: where their energies in a cell differ by
/// more than rounding. All ranks call it together.
template <int dim>
void require_carried(const contact::NitscheForm<dim>& form, std::span<const double> u,
                     const FinerContact<dim>& finer);

/// 2D: the solution on a mesh whose cells in contact are cut in fans where segments end, so that the facets
/// of the bodies match, except where facets narrower than 0.04 times the old ones would come. If bodies are
/// tied, which have no bound otherwise, there are no exceptions. Null where nothing is to be cut, where
/// rounding prevents it, and in 3D. All ranks call it together. Throws InputError where the result is no
/// valid mesh, and as require_carried().
template <int dim>
[[nodiscard]] std::unique_ptr<FinerContact<dim>> matching_contact(const contact::NitscheForm<dim>& form,
                                                                  std::span<const double> u);

/// Polynomials cannot satisfy complementarity on a facet where the state changes, the less so the higher
/// their degree. There the cells are bisected until edges are an eighth in 2D, halved in 3D. Null where the
/// state changes on no facet of any rank, where the form has no bound of the error in the energy norm, and
/// between 3D meshes that do not match after earlier load steps, since their segments do not nest. All ranks
/// call it together. Throws as require_carried().
template <int dim>
[[nodiscard]] std::unique_ptr<FinerContact<dim>> finer_contact(const contact::NitscheForm<dim>& form,
                                                               std::span<const double> u);

}  // namespace tribound::adapt
