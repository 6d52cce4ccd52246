#pragma once

/// @file contact_history.h
/// What the contact boundary remembers of earlier steps (method section 12.2).

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "tribound/fem/quadrature.h"
#include "tribound/problem/contact_law.h"

namespace tribound::contact
{

/// States at the contact points of a form, and between them on each segment. There D, q and w are the
/// polynomials of degree p + 2 that the projection by the rule gives (in 2D, interpolation at its points),
/// cut to what the law admits. So T is a function on the whole segment, and the residual of a step is well
/// defined: the history is part of its data.
template <int dim>
class ContactHistory
{
 public:
  /// `states`: by number of the contact points of a form with the given rule; `degree`: p + 2.
  ContactHistory(std::vector<problem::InterfaceState<dim>> states, const fem::Quadrature<dim - 1>& rule,
                 int degree);
  using Cut = std::function<problem::InterfaceState<dim>(std::size_t point, problem::InterfaceState<dim>)>;
  /// From values of D, q and w that a law need not admit, such as those of the polynomials of another
  /// history. They define the polynomials; `cut` makes the states at the points from them.
  ContactHistory(std::vector<problem::InterfaceState<dim>> values, const fem::Quadrature<dim - 1>& rule,
                 int degree, const Cut& cut);

  [[nodiscard]] std::span<const problem::InterfaceState<dim>> states() const { return states_; }
  /// The state on segment k, at the point with coordinates s.
  [[nodiscard]] problem::InterfaceState<dim> at(const problem::ContactLaw& law, std::size_t k,
                                                const Point<dim - 1>& s) const;
  /// The same before it is cut: values of the polynomials.
  [[nodiscard]] problem::InterfaceState<dim> uncut(std::size_t k, const Point<dim - 1>& s) const;

 private:
  static constexpr int n_values = dim + 2;  ///< D, q, w
  using Values = Eigen::Matrix<double, n_values, 1>;

  std::vector<problem::InterfaceState<dim>> states_;
  int degree_;
  std::size_t n_;                     ///< dim P^{p+2}
  std::vector<Values> coefficients_;  ///< on segment k in the orthonormal basis: [k n_ + i]
};

}  // namespace tribound::contact
