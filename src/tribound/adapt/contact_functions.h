#pragma once

/// @file contact_functions.h
/// Functions on the contact boundary of a mesh, such as the contact history, and their values on a
/// refinement.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/box_tree.h"

namespace tribound::adapt
{

/// Polynomials of degree p + 2 on every contact segment. Each rank has those of all ranks. A segment of a
/// refinement lies in one of these segments, and has the same polynomials there: it is a child of a facet on
/// an obstacle or, between bodies in 2D, the part of a child with one partner. (Between bodies in 3D, parts
/// are cut into simplices, which do not nest.)
template <int dim>
class ContactFunctions
{
 public:
  /// From the values of n functions at the owned contact points of the form, values[point n + i]. The
  /// polynomials are the projections by the quadrature rule; in 2D they interpolate the values. All ranks
  /// call it together.
  ContactFunctions(const contact::NitscheForm<dim>& form, std::span<const double> values, std::size_t n);

  /// Sets the values at the contact points of one segment, [point n + i].
  using Fresh = std::function<void(const contact::ContactSegment<dim>&, std::span<double>)>;
  /// The values at all contact points of a form on a refinement, ghosts included, in the same order. On a
  /// segment that lies in no piece, `fresh` sets them, by default to 0.
  [[nodiscard]] std::vector<double> at_points_of(const contact::NitscheForm<dim>& form,
                                                 const Fresh& fresh = {}) const;

 private:
  /// A segment that the functions are on.
  struct Piece
  {
    int tag;  ///< number of the boundary
    Point<dim> normal;
    Point<dim> origin;
    Eigen::Matrix<double, dim, dim - 1> jacobian;
  };

  void set_pieces(std::span<const double> places);
  void evaluate(const contact::NitscheForm<dim>& form, std::size_t k, std::size_t piece,
                std::span<double> values) const;
  /// The index of the piece that the segment lies in; the number of pieces where there is none.
  [[nodiscard]] std::size_t piece_of(const contact::NitscheForm<dim>& form, std::size_t k) const;

  std::size_t n_;
  int degree_;
  std::vector<Piece> pieces_;
  std::vector<double> coefficients_;  ///< [(piece dim P^{p+2} + j) n + i]
  mesh::BoxTree<dim> tree_;
};

/// Transfers the history of a form to a form on a refinement of its mesh. In 2D the history is the same
/// function. In 3D polynomials replace the states at the contact points, and need not interpolate them. All
/// ranks call it together.
template <int dim>
[[nodiscard]] std::shared_ptr<const contact::ContactHistory<dim>> carried_history(
    const contact::ContactHistory<dim>& history, const contact::NitscheForm<dim>& from,
    const contact::NitscheForm<dim>& to);

/// Transfers vectors at the contact points of a form to those of a form on a refinement. All ranks call it
/// together.
template <int dim>
[[nodiscard]] std::vector<Point<dim>> carried_vectors(std::span<const Point<dim>> vectors,
                                                      const contact::NitscheForm<dim>& from,
                                                      const contact::NitscheForm<dim>& to);

}  // namespace tribound::adapt
