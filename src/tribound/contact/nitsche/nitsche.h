#pragma once

/// @file nitsche.h
/// The discrete problem of method section 2:
/// find u_h with a(u_h, v) - ([P^n(u_h)]_-, v^n)_C - ([P^t(u_h)]_{S_h(u_h)}, v^t)_C = L(v) for all v in V_h.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/discrete_data.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// Everything a user asks about one point of the contact boundary.
template <int dim>
struct ContactState
{
  Point<dim> point;
  Point<dim> normal;    ///< outward unit normal
  double pressure;      ///< -[P^n]_- >= 0
  Point<dim> traction;  ///< T = [P^n]_- n + [P^t]_S
  double limit;         ///< S_h: what |T^t| may reach
  problem::ContactStatus status;
  double gap;       ///< g - u^n: distance left
  Point<dim> slip;  ///< u^t
};

/// A facet of Gamma_C with what the integrals need.
template <int dim>
struct ContactFacet
{
  mesh::BoundaryFacet facet;
  mesh::FacetGeometry<dim> geometry;
  double gamma;  ///< gamma_0 min(lambda + 2 mu, 34 mu) / h_F
  const problem::Contact* contact;
  std::size_t number;  ///< in Mesh::boundary()
};

/// Which linearisation of T a Newton step uses.
enum class Linearisation
{
  closed_sticking,  ///< T_lin(w) = P^n(w) n + P^t(w): the first step from scratch
  newton            ///< T_lin(w) = T(u) + DT(u)[w - u]
};

/// The discrete problem on one mesh. Contact integrals touch only cells on Gamma_C. Contact quantities live
/// at the quadrature points of the contact facets: point q of contact facet k has number k * n_facet_points()
/// + q. Keeps references to problem and space. Where delta > 0 (a stress) is given, the projections of T are
/// the regularised ones of method section 7: T_delta.
template <int dim>
class NitscheForm
{
 public:
  /// `accuracy` and errors: as DiscreteData.
  NitscheForm(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space, double gamma0,
              const DataAccuracy& accuracy = {});

  [[nodiscard]] const problem::Problem<dim>& problem() const { return *problem_; }
  [[nodiscard]] const fem::LagrangeSpace<dim>& space() const { return *space_; }
  [[nodiscard]] const DiscreteData<dim>& data() const { return data_; }
  [[nodiscard]] const fem::Constraints& constraints() const { return constraints_; }
  [[nodiscard]] double gamma0() const { return gamma0_; }
  /// L(phi_i) for every degree of freedom, fixed ones included.
  [[nodiscard]] std::span<const double> load() const { return load_; }

  [[nodiscard]] std::span<const ContactFacet<dim>> contact_facets() const { return contact_facets_; }
  [[nodiscard]] const fem::Quadrature<dim - 1>& facet_rule() const { return facet_rule_; }
  [[nodiscard]] int n_facet_points() const { return facet_rule_.size(); }
  [[nodiscard]] std::size_t n_contact_points() const { return contact_facets_.size() * facet_rule_.size(); }

  /// T(u) at the contact points.
  [[nodiscard]] std::vector<Point<dim>> traction(std::span<const double> u, double delta = 0) const;
  /// T_lin(w) at the contact points, linearised at u.
  [[nodiscard]] std::vector<Point<dim>> linearised_traction(Linearisation kind, std::span<const double> u,
                                                            std::span<const double> w,
                                                            double delta = 0) const;
  /// vector_i += (t, phi_i)_C with t given at the contact points.
  void add_contact_load(std::span<const Point<dim>> t, std::span<double> vector) const;
  /// -(DT(u)[phi_j], phi_i)_C over free i and j. Rows and columns do not depend on u.
  [[nodiscard]] algebra::Triplets contact_tangent(Linearisation kind, std::span<const double> u,
                                                  double delta = 0) const;

  /// States on contact facet k at the points of `table`.
  [[nodiscard]] std::vector<ContactState<dim>> contact_states(std::span<const double> u, int k,
                                                              const fem::FacetTabulation<dim>& table) const;

 private:
  /// P(u) = sigma(u) n - gamma (u - g n), so that P^n = P.n and P^t = P - P^n n.
  [[nodiscard]] Point<dim> augmented_traction(std::span<const double> u, std::size_t k, int q,
                                              const Tensor<dim>& inverse_transpose) const;
  [[nodiscard]] problem::LawPoint<dim> law_point(std::size_t k, std::size_t i) const;
  /// M with DT(u)[w] = M (sigma(w) n - gamma w), from P(u) at contact point i of facet k.
  [[nodiscard]] Tensor<dim> traction_derivative(Linearisation kind, std::size_t k, std::size_t i,
                                                const Point<dim>& augmented, double delta) const;
  [[nodiscard]] Tensor<dim> inverse_transpose(std::size_t k) const;
  /// Appends the rows of the nodes on the facet; block [i * n_nodes + j] belongs to local nodes i and j.
  void add_block_entries(const mesh::BoundaryFacet& facet, std::span<const Tensor<dim>> block,
                         algebra::Triplets& entries) const;

  const problem::Problem<dim>* problem_;
  const fem::LagrangeSpace<dim>* space_;
  double gamma0_;
  fem::Constraints constraints_;
  DiscreteData<dim> data_;
  std::vector<double> load_;
  fem::Quadrature<dim - 1> facet_rule_;
  fem::FacetTabulation<dim> facet_table_;
  std::vector<ContactFacet<dim>> contact_facets_;
  std::vector<double> gap_;       ///< g at the contact points
  std::vector<double> strength_;  ///< s at the contact points, 0 where the law has none
};

/// Resultants of a contact traction t given at the contact points.
template <int dim>
struct ContactResultants
{
  Point<dim> force = Point<dim>::Zero();  ///< integral of t
  double normal = 0;                      ///< integral of t^n (negative in compression)
  double tangential = 0;      ///< 2D: integral of t.(n turned by +90 degrees); 3D: |integral of t^t|
  double abs_tangential = 0;  ///< integral of |t^t|
};

/// Over the contact facets with boundary number `tag`, or over all for tag < 0.
template <int dim>
[[nodiscard]] ContactResultants<dim> contact_resultants(const NitscheForm<dim>& form,
                                                        std::span<const Point<dim>> t, int tag = -1);

}  // namespace tribound::contact
