#pragma once

/// @file nitsche.h
/// The discrete problem of method section 2:
/// find u_h with a(u_h, v) - ([P^n(u_h)]_-, v^n)_C - ([P^t(u_h)]_{S_h(u_h)}, v^t)_C = L(v) for all v in V_h,
/// where normal and tangential parts are taken by the direction of contact N, by default that of the facet.

#include <memory>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/contact_history.h"
#include "tribound/contact/nitsche/discrete_data.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/rigid_parts.h"
#include "tribound/contact/nitsche/segment_values.h"
#include "tribound/contact/nitsche/springs.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// The state of one point of the contact boundary, as users ask for it.
template <int dim>
struct ContactState
{
  Point<dim> point;
  Point<dim> normal;    ///< N
  double pressure;      ///< -[P^n]_- >= 0
  Point<dim> traction;  ///< T = [P^n]_- n + [P^t]_S
  double limit;         ///< S_h: the limit of |T^t|
  problem::ContactStatus status;
  double gap;                               ///< g - [u]^n: the remaining distance
  Point<dim> slip;                          ///< [u]^t
  Point<dim> displacement;                  ///< u of the slave
  double opening = 0;                       ///< delta^n of the law's resolvent
  double water = 0;                         ///< p_w: the effective traction is T + p_w n
  problem::InterfaceState<dim> state = {};  ///< state that a step ending here commits
};

/// A quadrature point of a contact segment.
template <int dim>
struct ContactPoint
{
  Point<dim> x;                        ///< on the slave
  double weight;                       ///< of the rule, times measure, on a meridian times r
  Point<dim> normal;                   ///< N
  double gap;                          ///< g
  double strength;                     ///< s of the law, 0 where it has none
  double water;                        ///< p_w in the joint, stress
  problem::InterfaceState<dim> state;  ///< after the last committed step
};

/// Which linearisation of T a Newton step uses.
enum class Linearisation
{
  /// The first step from scratch: T_lin(w) = P^n(w) n + P^t(w), without P^t if nothing resists sliding. If
  /// some points are bonded, -p_w n at the broken ones.
  closed_sticking,
  newton  ///< T_lin(w) = T(u) + DT(u)[w - u]
};

/// Which gap, threshold and water pressure T(u) uses.
enum class WhichData
{
  discrete,  ///< those of the discrete problem: the resultants are integrals of this T(u)
  given      ///< those of the problem, between the contact points
};

/// The discrete problem on one mesh. Contact integrals touch only cells on Gamma_C. Contact quantities live
/// at the quadrature points of the contact segments: point q of segment k has number k * n_segment_points() +
/// q. Keeps references to problem and space. If delta > 0 (a stress) is given, the projections in T are the
/// regularised ones of method section 7: T_delta.
///
/// On a distributed mesh, values per degree of freedom include those of ghosts, but sums over cells lack the
/// cells that are not on this rank. All ranks construct it together.
template <int dim>
class NitscheForm
{
 public:
  /// Contact on contact_segments(). `accuracy` and errors as for DiscreteData and contact_segments().
  NitscheForm(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space, double gamma0,
              const DataAccuracy& accuracy = {});
  /// Contact on the given segments of the mesh.
  NitscheForm(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space, double gamma0,
              std::vector<ContactSegment<dim>> segments, const DataAccuracy& accuracy = {});

  /// The same with another gamma_0; nothing is integrated again.
  [[nodiscard]] NitscheForm with_gamma0(double gamma0) const;

  /// Sets what the contact points remember from now on; without it all are as before the first step. The
  /// history must be that of a form on the same segments. All ranks together.
  void set_history(std::shared_ptr<const ContactHistory<dim>> history);
  /// Null before the first step.
  [[nodiscard]] const std::shared_ptr<const ContactHistory<dim>>& history() const { return history_; }
  /// What a step that ends with u commits, by number of the contact points.
  [[nodiscard]] std::vector<problem::InterfaceResponse<dim>> advance(std::span<const double> u) const;

  [[nodiscard]] const problem::Problem<dim>& problem() const { return *problem_; }
  [[nodiscard]] const fem::LagrangeSpace<dim>& space() const { return *space_; }
  [[nodiscard]] const DiscreteData<dim>& data() const { return data_; }
  /// Null unless the problem is axisymmetric.
  [[nodiscard]] const std::shared_ptr<const MeridianCells>& meridian() const { return meridian_; }
  [[nodiscard]] const Springs<dim>& springs() const { return springs_; }
  [[nodiscard]] const RigidParts<dim>& rigid_parts() const { return rigid_parts_; }
  /// The degrees of freedom of rigid parts are among the fixed ones.
  [[nodiscard]] const fem::Constraints& constraints() const { return constraints_; }
  /// Gives u the prescribed values at fixed degrees of freedom; rigid parts keep their motion.
  void prescribe(std::span<double> u) const;
  /// Sets a vector to 0 at fixed degrees of freedom; on rigid parts to the nodal forces with the same work in
  /// their motions, or to the nearest rigid motion.
  void keep_free(std::span<double> vector) const;
  [[nodiscard]] double gamma0() const { return gamma0_; }
  /// L(phi_i) + (K u_0, phi_i)_S - (sigma_0, grad phi_i) for every degree of freedom, fixed ones included. L
  /// has the forces on rigid parts, as RigidParts::add_load().
  [[nodiscard]] std::span<const double> load() const { return load_; }

  [[nodiscard]] std::span<const ContactSegment<dim>> segments() const { return segments_; }
  /// On several ranks: the segments whose slaves are facets of own cells come first; this is their number.
  [[nodiscard]] std::size_t n_owned_segments() const { return n_owned_segments_; }
  [[nodiscard]] std::size_t n_owned_contact_points() const
  {
    return n_owned_segments_ * static_cast<std::size_t>(n_segment_points());
  }
  /// The rule on segments, and on boundary facets in general.
  [[nodiscard]] const fem::Quadrature<dim - 1>& facet_rule() const { return data_.facet_rule(); }
  [[nodiscard]] int n_segment_points() const { return facet_rule().size(); }
  [[nodiscard]] std::size_t n_contact_points() const { return points_.size(); }
  [[nodiscard]] std::span<const ContactPoint<dim>> contact_points() const { return points_; }
  /// The contact points of segment k.
  [[nodiscard]] std::span<const ContactPoint<dim>> contact_points(std::size_t k) const
  {
    return contact_points().subspan(k * n_segment_points(), n_segment_points());
  }
  /// The arguments of the law of segment k at points x with coordinates s, where N is n.
  [[nodiscard]] std::vector<problem::LawPoint<dim>> law_points(std::size_t k,
                                                               std::span<const Point<dim - 1>> s,
                                                               std::span<const Point<dim>> x,
                                                               std::span<const Point<dim>> n) const;
  /// Vectors at the contact points of a segment.
  using Columns = Eigen::Matrix<double, dim, Eigen::Dynamic>;
  /// {C eps(u)} - gamma [u] at the contact points of segment k: P(u) without gap and initial stress.
  [[nodiscard]] Columns traction_without_gap(std::span<const double> u, std::size_t k) const;
  [[nodiscard]] const InitialTractions<dim>& initial_tractions() const { return initial_tractions_; }

  /// p_w n at the contact points: T + p_w n is the effective traction.
  [[nodiscard]] std::vector<Point<dim>> water_pressure() const;
  /// T(u) at the contact points.
  [[nodiscard]] std::vector<Point<dim>> traction(std::span<const double> u, double delta = 0) const;
  /// T_lin(w) at the contact points, linearised at u.
  [[nodiscard]] std::vector<Point<dim>> linearised_traction(Linearisation kind, std::span<const double> u,
                                                            std::span<const double> w,
                                                            double delta = 0) const;
  /// vector_i += (t, [phi_i])_C with t given at the contact points.
  void add_contact_load(std::span<const Point<dim>> t, std::span<double> vector) const;
  /// -(DT(u)[phi_j], [phi_i])_C over free i and j.
  [[nodiscard]] algebra::Triplets contact_tangent(Linearisation kind, std::span<const double> u,
                                                  double delta = 0) const;
  /// The values of its entries, whose rows and columns do not depend on u; and the entries themselves, with
  /// the value 0.
  [[nodiscard]] std::vector<double> contact_tangent_values(Linearisation kind, std::span<const double> u,
                                                           double delta = 0) const;
  [[nodiscard]] algebra::Triplets contact_pattern() const;

  /// The states on segment k at its contact points, or at the points of `table`.
  [[nodiscard]] std::vector<ContactState<dim>> contact_states(std::span<const double> u, std::size_t k) const
  {
    return contact_states(u, k, tables_[k]);
  }
  [[nodiscard]] std::vector<ContactState<dim>> contact_states(std::span<const double> u, std::size_t k,
                                                              const SegmentTable<dim>& table) const;
  [[nodiscard]] std::vector<ContactState<dim>> contact_states(std::span<const double> u, std::size_t k,
                                                              const SegmentTable<dim>& table,
                                                              WhichData which) const;

 private:
  [[nodiscard]] std::vector<ContactPoint<dim>> make_points() const;
  void look_for_bonds();
  /// The arguments of the law at a contact point of segment k.
  [[nodiscard]] problem::LawPoint<dim> law_point(std::size_t k, int q) const
  {
    const ContactPoint<dim>& point = contact_points(k)[q];
    return {point.normal, point.strength, segments_[k].gamma, point.state, point.water};
  }
  /// Evaluates functions of the space at the nodes of segment k.
  [[nodiscard]] SegmentValues<dim> at_nodes(std::size_t k) const
  {
    return {*problem_, *space_, segments_[k], node_tables_[k]};
  }
  /// P(u) = {sigma(u)} - gamma ([u] - g n) at its contact points: P^n = P.n and P^t = P - P^n n.
  [[nodiscard]] Columns augmented_traction(std::span<const double> u, std::size_t k) const;
  /// T from P = `augmented` at a contact point of segment k.
  [[nodiscard]] Point<dim> respond(std::size_t k, int q, const Point<dim>& augmented, double delta) const;
  /// Whether the first step from scratch takes the point as open: broken, while others are bonded.
  [[nodiscard]] bool starts_open(std::size_t k, int q) const;
  /// M with DT(u)[w] = M ({sigma(w)} - gamma [w]), from P(u) at point q of segment k.
  [[nodiscard]] Tensor<dim> traction_derivative(Linearisation kind, std::size_t k, int q,
                                                const Point<dim>& augmented, double delta) const;
  /// block(dim i + a, dim j + b) += -(DT(u)[phi_j e_b], [phi_i e_a]) on segment k, with i over the nodes of
  /// all sides that are on the facet, and j over all nodes of all sides.
  void add_tangent_block(Linearisation kind, std::span<const double> u, std::size_t k, double delta,
                         Eigen::Ref<Eigen::MatrixXd> block) const;
  /// -(DT(u)[v], theta_i e_a) = sum_l result(dim i + a, dim l + b) (P(v) without the gap)_b at node l of the
  /// segment.
  [[nodiscard]] Eigen::MatrixXd tested_derivative(Linearisation kind, std::span<const double> u,
                                                  std::size_t k, double delta) const;
  /// The block of segments number first, ..., last - 1, which lie on the same facets. Its entries have the
  /// numbers position, ... in the tangent, column by column.
  struct TangentBlock
  {
    std::size_t first;
    std::size_t last;
    std::size_t position;
    Eigen::Index n_rows;  ///< for nodes on the facets
    Eigen::Index n_columns;

    [[nodiscard]] std::size_t end() const { return position + n_rows * n_columns; }
  };
  [[nodiscard]] std::vector<TangentBlock> tangent_blocks() const;
  /// evaluate(k, values) sets the values at the contact points of every segment.
  template <class Value, class Evaluate>
  [[nodiscard]] std::vector<Value> at_contact_points(const Evaluate& evaluate) const;

  const problem::Problem<dim>* problem_;
  const fem::LagrangeSpace<dim>* space_;
  std::shared_ptr<const MeridianCells> meridian_;
  double gamma0_;
  fem::Constraints constraints_;
  std::vector<ContactSegment<dim>> segments_;
  DiscreteData<dim> data_;
  Springs<dim> springs_;
  RigidParts<dim> rigid_parts_;
  std::vector<double> load_;
  std::size_t n_owned_segments_;
  std::vector<ContactPoint<dim>> points_;
  SegmentTables<dim> tables_;  ///< at the contact points
  SegmentNodes<dim> nodes_;
  SegmentTables<dim> node_tables_;
  InitialTractions<dim> initial_tractions_;
  std::shared_ptr<const ContactHistory<dim>> history_;  ///< null: none yet
  bool has_bonds_ = false;                              ///< on any rank
};

/// The norms of sigma(u) with the data of the form.
template <int dim>
[[nodiscard]] StressNorms stress_norms(const NitscheForm<dim>& form, std::span<const double> u)
{
  return stress_norms(form.problem(), form.space(), u, &form.data(), form.meridian());
}

/// Resultants of a contact traction t given at the contact points, over all ranks; of an axisymmetric problem
/// over the full circle, radial parts by their amounts.
template <int dim>
struct ContactResultants
{
  Point<dim> force = Point<dim>::Zero();  ///< integral of t
  double normal = 0;                      ///< integral of t^n (negative in compression)
  double tangential = 0;      ///< 2D: integral of t.(n turned by +90 degrees); 3D: |integral of t^t|
  double abs_tangential = 0;  ///< integral of |t^t|
  double abs_normal = 0;      ///< integral of |t^n|
};

/// Over the segments whose slave has boundary number `tag`; over all for tag < 0.
template <int dim>
[[nodiscard]] ContactResultants<dim> contact_resultants(const NitscheForm<dim>& form,
                                                        std::span<const Point<dim>> t, int tag = -1);

}  // namespace tribound::contact
