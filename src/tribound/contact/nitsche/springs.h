#pragma once

/// @file springs.h
/// Elastic supports on the facets of a mesh: (K (u - u_0), v)_S, method section 15.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/discrete_data.h"
#include "tribound/contact/nitsche/spring_facet.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// The springs of a problem on a mesh, with ghosts. Keeps a reference to the space. All ranks construct it
/// together.
template <int dim>
class Springs
{
 public:
  /// Throws InputError as spring_facet() does.
  Springs(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space);

  [[nodiscard]] std::span<const SpringFacet<dim>> facets() const { return facets_; }
  /// Null where there is no spring.
  [[nodiscard]] const SpringFacet<dim>* on(std::size_t number) const;
  /// u at point q.
  [[nodiscard]] Point<dim> displacement(const SpringFacet<dim>& facet, std::span<const double> u,
                                        int q) const;
  /// -K (u - u_0) at point q: the force per area on the body.
  [[nodiscard]] Point<dim> traction(const SpringFacet<dim>& facet, std::span<const double> u, int q) const
  {
    return -(facet.stiffness.values[q] * (displacement(facet, u, q) - facet.rest.values[q]));
  }
  /// What is lost when -K (u - u_0) is replaced by its values at the points and projected on P^p, in norms
  /// without r.
  [[nodiscard]] LoadRemainder remainder(const SpringFacet<dim>& facet, std::span<const double> u) const;
  /// Why the energy of springs is not known between the points on some rank: K is no polynomial of degree 2,
  /// or may be negative there. Empty: it is known.
  [[nodiscard]] std::string why_unclear() const;
  /// Whether u_0 is a polynomial of degree m on all facets of all ranks.
  [[nodiscard]] bool has_polynomial_rest() const;
  /// vector_i += (f, phi_i)_S, f(facet, q) at the points.
  template <class Force>
  void add(const Force& force, std::span<double> vector) const
  {
    for (const SpringFacet<dim>& facet : facets_)
      for (std::size_t q = 0; q < facet.weights.size(); ++q)
        fem::add_at_point<dim>(space_->cell_nodes(facet.cell), values_at(facet, static_cast<int>(q)),
                               facet.weights[q] * force(facet, static_cast<int>(q)), vector);
  }
  /// vector_i += (K u_0, phi_i)_S.
  void add_rest(std::span<double> vector) const;
  /// products[cell] += (K u, v)_S over the facets of own cells.
  void add_products(std::span<const double> u, std::span<const double> v, std::span<double> products) const;
  /// vector_i += (K u, phi_i)_S.
  void add_forces(std::span<const double> u, std::span<double> vector) const;
  /// The integral of -K (u - u_0) over a boundary, of all ranks.
  [[nodiscard]] Point<dim> force(int tag, std::span<const double> u) const;
  /// (K (u - u_0), u - u_0)_S over all ranks.
  [[nodiscard]] double energy(std::span<const double> u) const;
  /// (phi_j e_b, K phi_i e_a) on a facet for nodes i and j of its cell.
  [[nodiscard]] Tensor<dim> block(const SpringFacet<dim>& facet, int i, int j) const;

 private:
  [[nodiscard]] std::span<const double> values_at(const SpringFacet<dim>& facet, int q) const
  {
    return table_.on_facet[facet.local].values_at(q);
  }

  /// Without r.
  [[nodiscard]] double plain_weight(const SpringFacet<dim>& facet, int q) const;
  [[nodiscard]] double oscillation(const SpringFacet<dim>& facet, std::span<const double> u) const;

  const fem::LagrangeSpace<dim>* space_;
  fem::Quadrature<dim - 1> rule_;
  fem::FacetTabulation<dim> table_;
  std::vector<SpringFacet<dim>> facets_;  ///< by number
};

}  // namespace tribound::contact
