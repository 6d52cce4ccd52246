#pragma once

/// @file share_out.h
/// Meshes on several ranks: the first one comes from the rank that has it, and the cells of each later one go
/// where they balance.

#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/mesh/mesh.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// The parts of a mesh that the first rank has; elsewhere `whole` is null. All ranks get equally many cells,
/// up to one. Cells have their vertices in the order in which bisect() takes them, and are sent in batches of
/// `batch`.
template <int dim>
[[nodiscard]] Mesh<dim> share_out(const Ranks& ranks, const Mesh<dim>* whole, Index batch = 1'000'000);

/// The same for a box, of which each rank makes its own cells.
template <int dim>
[[nodiscard]] Mesh<dim> share_out(const Ranks& ranks, const BoxMesh& box);
template <int dim>
[[nodiscard]] Mesh<dim> share_out(const Ranks& ranks, const Boxes& boxes);
/// The same for boxes, or for a mesh of another source, which is `whole`.
template <int dim>
[[nodiscard]] Mesh<dim> share_out(const Ranks& ranks, const MeshSource& source, const Mesh<dim>* whole)
{
  if (const auto* box = std::get_if<BoxMesh>(&source)) return share_out<dim>(ranks, *box);
  if (const auto* boxes = std::get_if<Boxes>(&source)) return share_out<dim>(ranks, *boxes);
  return share_out<dim>(ranks, whole);
}

/// When cells are moved along the curve such that all ranks have equally many.
enum class Move
{
  never,
  where_unbalanced,  ///< if one rank has too many
  always
};

/// The part of a rank, and the values that have come with the cells.
template <int dim>
struct Balanced
{
  Mesh<dim> mesh;
  std::vector<Index> cells;    ///< own cells in the order of their values
  std::vector<double> values;  ///< equally many for each of them
};

/// The mesh of these cells, on each rank those that it has now, with `n_values` values each, which may be 0.
/// `before`: an earlier mesh that they come from. All ranks call it together. Throws InputError, on all
/// ranks, if the cells do not form a mesh.
template <int dim>
[[nodiscard]] Balanced<dim> balance(const Mesh<dim>& before, std::vector<CellRecord<dim>> cells,
                                    std::span<const double> values, int n_values,
                                    Move move = Move::where_unbalanced);

/// The facets of boxes, MeshLabels::quadratic_facets; null for a file. All ranks call it together.
template <int dim>
[[nodiscard]] std::shared_ptr<const QuadraticFacets> box_facets(const Ranks& ranks, const MeshSource& source);

/// The mesh of cells that a rank has from somewhere else, for example a file. `first`: the mesh they come
/// from, on the first rank; null elsewhere. `facets`: of that mesh, where `first` is one of the same boxes
/// with fewer cells. On one rank it is a whole mesh that comes from bisect().
template <int dim>
[[nodiscard]] Balanced<dim> restore(const Ranks& ranks, const Mesh<dim>* first,
                                    std::vector<CellRecord<dim>> cells, std::span<const double> values,
                                    int n_values, const std::shared_ptr<const QuadraticFacets>& facets = {});

/// Own cells as records to be sent.
template <int dim>
[[nodiscard]] std::vector<CellRecord<dim>> records_of(const Mesh<dim>& mesh, std::span<const Index> cells);

/// The mesh with these cells of other ranks as additional ghosts, unless they are ghosts already. Own cells
/// keep their numbers. Ranks may call it alone.
template <int dim>
[[nodiscard]] Mesh<dim> with_more_ghosts(Mesh<dim> mesh, std::vector<Ghost<dim>> more);

/// Cells of all ranks on this one alone, in ascending order of their names.
template <int dim>
struct PickedOut
{
  Mesh<dim> mesh;
  std::vector<Index> number;  ///< in the mesh, per cell given
};

/// The mesh of cells that have been picked out of another, with the bodies that they belong to. Inner facets
/// may have one cell only, and no vertex has its patch.
template <int dim>
[[nodiscard]] PickedOut<dim> pick_out(const Mesh<dim>& from, std::span<const CellRecord<dim>> cells,
                                      std::span<const int> bodies);

}  // namespace tribound::mesh
