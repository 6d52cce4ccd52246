#pragma once

/// @file contact_functions.h
/// Functions on the contact boundary of a mesh, such as what it remembers, on a refinement of it.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/box_tree.h"

namespace tribound::adapt
{

/// Polynomials of degree p + 2 on every contact segment, of all ranks on each. A segment of a refinement lies
/// in one of these: a child of the facet of an obstacle does, and between bodies in 2D the part of a child
/// with one partner. There it has the same polynomials. (Between bodies in 3D parts are cut into simplices,
/// which do not nest.)
template <int dim>
class ContactFunctions
{
 public:
  /// Of n functions with such values at the owned contact points of the form: values[point n + i]. The
  /// polynomials are the projections by the rule; in 2D they have the values. All ranks call it together.
  ContactFunctions(const contact::NitscheForm<dim>& form, std::span<const double> values, std::size_t n);

  /// At the contact points of one segment, [point n + i].
  using Fresh = std::function<void(const contact::ContactSegment<dim>&, std::span<double>)>;
  /// Their values at all contact points of a form on a refinement, ghosts included, in the same order; on a
  /// segment that lies in none what `fresh` sets, by default 0.
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
  /// The piece that the segment lies in; their number where there is none.
  [[nodiscard]] std::size_t piece_of(const contact::NitscheForm<dim>& form, std::size_t k) const;

  std::size_t n_;
  int degree_;
  std::vector<Piece> pieces_;
  std::vector<double> coefficients_;  ///< [(piece dim P^{p+2} + j) n + i]
  mesh::BoxTree<dim> tree_;
};

/// The history of a form on one on a refinement of its mesh. In 2D it is the same function. In 3D it is the
/// same between the contact points; at these the polynomials take the place of the states that were there,
/// which they need not go through. All ranks call it together.
template <int dim>
[[nodiscard]] std::shared_ptr<const contact::ContactHistory<dim>> carried_history(
    const contact::ContactHistory<dim>& history, const contact::NitscheForm<dim>& from,
    const contact::NitscheForm<dim>& to);

/// Vectors at the contact points of a form, at those of one on a refinement. All ranks call it together.
template <int dim>
[[nodiscard]] std::vector<Point<dim>> carried_vectors(std::span<const Point<dim>> vectors,
                                                      const contact::NitscheForm<dim>& from,
                                                      const contact::NitscheForm<dim>& to);

}  // namespace tribound::adapt
