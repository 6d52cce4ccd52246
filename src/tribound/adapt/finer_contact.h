#pragma once

/// @file finer_contact.h
/// A solution on a mesh whose facets match and are cut up where the state of contact changes, for error bars.

#include <memory>
#include <span>
#include <vector>

#include "tribound/adapt/level.h"

namespace tribound::adapt
{

/// The same function u on a mesh that is bisected, or cut otherwise. Its parts refer to each other: it stays
/// where it is made.
template <int dim>
struct FinerContact
{
  std::unique_ptr<const Grid<dim>> grid;
  /// With gamma and {sigma} of the form that it comes from: T(u) is the same function.
  std::unique_ptr<const contact::NitscheForm<dim>> form;
  std::vector<double> u;
  std::vector<Index> parent;  ///< per own cell: the own cell of the mesh before that contains it
};

/// Throws SolveError where the function on the finer mesh is not u: where their energies differ in a cell by
/// more than rounding. All ranks call it together.
template <int dim>
void require_carried(const contact::NitscheForm<dim>& form, std::span<const double> u,
                     const FinerContact<dim>& finer);

/// 2D: on a mesh whose cells in contact are cut in fans where segments end, so that facets of bodies match.
/// Null where they do anyhow, where rounding does not let them, and in 3D. All ranks call it together. Throws
/// InputError where that is no mesh, and as require_carried().
template <int dim>
[[nodiscard]] std::unique_ptr<FinerContact<dim>> matching_contact(const contact::NitscheForm<dim>& form,
                                                                  std::span<const double> u);

/// Polynomials cannot be complementary on a facet where the state changes, the less so the higher their
/// degree: there the cells are bisected until edges are an eighth in 2D, halved in 3D. Null where the state
/// changes on no facet of any rank, or the form has no bound of the error in the energy norm. All ranks call
/// it together. Throws as require_carried().
template <int dim>
[[nodiscard]] std::unique_ptr<FinerContact<dim>> finer_contact(const contact::NitscheForm<dim>& form,
                                                               std::span<const double> u);

}  // namespace tribound::adapt
