#include "tribound/certify/energy/admissible_displacement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "tribound/certify/energy/control_point.h"
#include "tribound/certify/energy/kept_apart.h"
#include "tribound/certify/energy/obstacle_facets.h"

namespace tribound::certify
{

namespace
{

/// Whether something holds at all contact points of a facet, at none of them, or at some.
enum class Extent
{
  nowhere,
  somewhere,
  everywhere
};

/// The state of a facet according to T(u).
struct FacetState
{
  Extent closed = Extent::nowhere;
  Extent sticks = Extent::nowhere;
  double pressure = 0;  ///< mean of |T^n|
  double friction = 0;  ///< mean of S_h

  [[nodiscard]] bool is_in_transition() const
  {
    return closed == Extent::somewhere || sticks == Extent::somewhere;
  }
};

bool holds(Extent extent, bool transition_is_closed)
{
  return extent == Extent::everywhere || (transition_is_closed && extent == Extent::somewhere);
}

Extent extent(int n_there, int n)
{
  if (n_there == 0) return Extent::nowhere;
  return n_there == n ? Extent::everywhere : Extent::somewhere;
}

template <int dim>
FacetState facet_state(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t, std::size_t k)
{
  const int n = form.n_segment_points();
  const problem::FrictionCone cone = problem::cone(form.segments()[k].contact->law);
  FacetState state;
  if (cone.is_tied) return {Extent::everywhere, Extent::everywhere, 1, 1};
  if (cone.is_bilateral) return {Extent::everywhere, Extent::nowhere, 1, 0};
  constexpr double rounding = 1e-12;  // of T^n where it is 0, and of |T^t| where it is at the limit
  int n_closed = 0;
  int n_sticking = 0;
  for (int q = 0; q < n; ++q)
  {
    const contact::ContactPoint<dim>& point = form.contact_points(k)[q];
    const Point<dim>& traction = t[k * n + q];
    const double component = traction.dot(point.normal);
    const double along = component < -rounding * traction.norm() ? component : 0;
    const double tangential = (traction - component * point.normal).norm();
    const double limit = cone.closed_limit(point.strength, along);
    n_closed += along < 0 ? 1 : 0;
    n_sticking += tangential < (1 - rounding) * limit ? 1 : 0;
    state.pressure -= along / n;
    state.friction += limit / n;
  }
  state.closed = extent(n_closed, n);
  state.sticks = extent(n_sticking, n);
  return state;
}

/// The control points of the slaves of all facets that match. What a facet in transition does at some points
/// counts as done everywhere, or not at all.
template <int dim>
class ControlPoints
{
 public:
  ControlPoints(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets,
                std::span<const double> u, std::span<const FacetState> states)
      : form_(form), facets_(facets), states_(states), beside_(facets.between_meshes())
  {
    for (std::size_t k = 0; k < states.size(); ++k)
    {
      if (!facets.matches(k)) continue;
      const std::vector<Point<dim>> on_slave = facets.on_slave(k, u);
      const std::vector<Point<dim>> on_master = facets.on_master(k, u);
      const std::span<const Index> masters = facets.master_nodes(k);
      for (std::size_t j = 0; j < on_slave.size(); ++j)
        points_.try_emplace(facets.nodes(k)[j])
            .first->second.add(on_slave[j], {k, j, masters.empty() ? -1 : masters[j], on_master[j]});
    }
  }

  /// The increments of the control points by node; ghosts get those of their owners. Masters move where
  /// slaves are fixed.
  [[nodiscard]] std::vector<double> corrections(bool transition_is_closed) const
  {
    const fem::LagrangeSpace<dim>& space = form_.space();
    std::vector<double> result(space.n_dofs(), 0.0);
    for (const auto& [node, at] : points_)
    {
      const Index master = at.places.front().master;
      std::array<bool, dim> fixed;
      for (int a = 0; a < dim; ++a) fixed[a] = is_fixed(node, a) && (master < 0 || is_fixed(master, a));
      const Point<dim> before = slip_before(at, transition_is_closed);
      const Point<dim> from_opposite = at.position - at.places.front().opposite - before;
      std::vector<ControlCondition<dim>> conditions =
          this->conditions(at, transition_is_closed, beside_[dim * node] != 0);
      for (ControlCondition<dim>& condition : conditions) condition.gap -= condition.normal.dot(before);
      const Point<dim> step = moved<dim>(from_opposite, fixed, conditions) - from_opposite;
      for (int a = 0; a < dim; ++a)
        if (!is_fixed(node, a))
          result[dim * node + a] += step[a];
        else if (master >= 0)
          result[dim * master + a] -= step[a];
    }
    space.update(std::span(result));
    return result;
  }

 private:
  struct Place
  {
    std::size_t facet;
    std::size_t coefficient;
    Index master;         ///< its node; -1 against an obstacle
    Point<dim> opposite;  ///< its control point; 0 against an obstacle
  };
  struct ControlPoint
  {
    Point<dim> position = Point<dim>::Zero();
    std::vector<Place> places;

    /// The position is taken from the first facet; the others agree up to rounding.
    void add(const Point<dim>& c, const Place& place)
    {
      if (places.empty()) position = c;
      places.push_back(place);
    }
  };

  [[nodiscard]] bool is_fixed(Index node, int a) const
  {
    return form_.constraints().fixed[dim * node + a] != 0;
  }
  /// The mean of earlier slips on the facets that stick.
  [[nodiscard]] Point<dim> slip_before(const ControlPoint& at, bool transition_is_closed) const
  {
    Point<dim> sum = Point<dim>::Zero();
    int n = 0;
    for (const Place& place : at.places)
    {
      if (!holds(states_[place.facet].sticks, transition_is_closed)) continue;
      sum += facets_.slip_before(place.facet, place.coefficient);
      ++n;
    }
    return n == 0 ? sum : sum / n;
  }
  /// Conditions on the distance from the opposite control point of the first facet. Facets with the same
  /// normal share one condition. A point beside another mesh, from which it is kept apart as well, obeys no
  /// equalities but those of tied bodies.
  [[nodiscard]] std::vector<ControlCondition<dim>> conditions(const ControlPoint& at,
                                                              bool transition_is_closed, bool is_beside) const
  {
    constexpr double same = 1e-12;
    std::vector<ControlCondition<dim>> result;
    for (const auto& [k, j, master, opposite] : at.places)
    {
      const Point<dim>& normal = form_.segments()[k].normal;
      const double gap = facets_.gap(k)[j] + normal.dot(opposite - at.places.front().opposite);
      auto found = std::ranges::find_if(
          result, [&](const ControlCondition<dim>& other) { return (other.normal - normal).norm() <= same; });
      if (found == result.end()) found = result.insert(found, {.normal = normal, .gap = gap});
      found->gap = std::min(found->gap, gap);
      const bool is_bound = !is_beside || problem::cone(form_.segments()[k].contact->law).is_bilateral;
      found->closed = found->closed || (is_bound && holds(states_[k].closed, transition_is_closed));
      found->sticks = found->sticks || (is_bound && holds(states_[k].sticks, transition_is_closed));
      found->pressure += states_[k].pressure;
      found->friction += states_[k].friction;
    }
    return result;
  }

  const contact::NitscheForm<dim>& form_;
  const ObstacleFacets<dim>& facets_;
  std::span<const FacetState> states_;
  std::vector<char> beside_;              ///< degrees of freedom that are also on facets that do not match
  std::map<Index, ControlPoint> points_;  ///< by node
};

/// u with its control points moved.
template <int dim>
std::vector<double> with_corrections(const fem::LagrangeSpace<dim>& space, const ObstacleFacets<dim>& facets,
                                     std::span<const double> u, std::span<const double> corrections)
{
  std::vector<double> v(u.begin(), u.end());
  for (std::size_t k = 0; k < facets.size(); ++k)
    for (const std::span<const Index> nodes : {facets.nodes(k), facets.master_nodes(k)})
    {
      if (!facets.matches(k)) continue;
      const std::vector<Point<dim>> change = facets.values(nodes, corrections);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (int a = 0; a < dim; ++a)
        {
          const Index dof = dim * nodes[i] + a;
          v[dof] = u[dof] + change[i][a];
        }
    }
  space.update(std::span(v));
  return v;
}

/// The largest coefficient of [v]^n - g_h, of sliders that of its absolute value, between tied bodies of
/// |[v]|.
template <int dim>
double excess(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets,
              std::span<const double> v)
{
  double largest = -HUGE_VAL;
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    const std::vector<Point<dim>> coefficients = facets.turned(k, facets.coefficients(k, v));
    const problem::FrictionCone cone = problem::cone(form.segments()[k].contact->law);
    for (std::size_t j = 0; j < coefficients.size(); ++j)
    {
      double beyond = facets.frames().normal(k).dot(coefficients[j]) - facets.gap(k)[j];
      if (cone.is_bilateral) beyond = std::abs(beyond);
      if (cone.is_tied) beyond = coefficients[j].norm();
      largest = std::max(largest, beyond);
    }
  }
  return form.space().mesh().ranks().max(largest);
}

/// The maximum of |u| and |g|.
template <int dim>
double size_on(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets,
               std::span<const double> u)
{
  double largest = 0;
  for (const double x : u) largest = std::max(largest, std::abs(x));
  for (std::size_t k = 0; k < facets.size(); ++k)
    for (const double g : facets.gap(k)) largest = std::max(largest, std::abs(g));
  return form.space().mesh().ranks().max(largest);
}

}  // namespace

template <int dim>
AdmissibleDisplacements admissible_displacements(const contact::NitscheForm<dim>& form,
                                                 std::span<const double> u, std::span<const Point<dim>> t)
{
  const Ranks& ranks = form.space().mesh().ranks();
  AdmissibleDisplacements result;
  result.reason = obstacles_unfit(form);
  if (!result.reason.empty()) return result;
  const ObstacleFacets<dim> facets(form);
  std::vector<FacetState> states;
  states.reserve(facets.size());
  for (std::size_t k = 0; k < facets.size(); ++k) states.push_back(facet_state<dim>(form, t, k));
  result.has_transition = ranks.any(
      std::ranges::any_of(states, [](const FacetState& state) { return state.is_in_transition(); }));
  result.gap_remainder = ranks.max(facets.gap_remainder());
  result.direction_remainder = ranks.max(facets.frames().remainder());

  const double most = 1e-14 * size_on(form, facets, u);  // rounding
  const auto make = [&](bool transition_is_closed, double& beyond) -> std::optional<std::vector<double>>
  {
    // If a slave is the master of another one, the other has to follow.
    constexpr int most_sweeps = 5;
    std::vector<WantedContact> wanted;
    wanted.reserve(states.size());
    for (const FacetState& state : states)
      wanted.push_back(
          {holds(state.closed, transition_is_closed), holds(state.sticks, transition_is_closed)});
    // Later sweeps only move bodies apart, which undoes nothing where facets match beside others that do not.
    const std::vector<WantedContact> nothing(wanted.size());
    for (const MovedSide side : {MovedSide::preferred, MovedSide::other})  // it may be fixed
    {
      std::vector<double> v(u.begin(), u.end());
      for (int sweep = 0; sweep < most_sweeps; ++sweep)
      {
        const ControlPoints<dim> control_points(form, facets, v, states);
        v = with_corrections<dim>(form.space(), facets, v, control_points.corrections(transition_is_closed));
        v = kept_apart<dim>(form, facets, side, sweep == 0 ? wanted : nothing, v);
        beyond = excess<dim>(form, facets, v);
        if (beyond <= most) return v;
      }
    }
    return {};
  };
  result.open = make(false, result.excess_open);
  if (!result.has_transition)
  {
    result.closed = result.open;
    result.excess_closed = result.excess_open;
    return result;
  }
  result.closed = make(true, result.excess_closed);
  return result;
}

template <int dim>
std::vector<std::size_t> facets_in_transition(const contact::NitscheForm<dim>& form,
                                              std::span<const Point<dim>> t)
{
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    if (facet_state<dim>(form, t, k).is_in_transition()) result.push_back(k);
  return result;
}

template AdmissibleDisplacements admissible_displacements(const contact::NitscheForm<2>&,
                                                          std::span<const double>, std::span<const Point<2>>);
template AdmissibleDisplacements admissible_displacements(const contact::NitscheForm<3>&,
                                                          std::span<const double>, std::span<const Point<3>>);
template std::vector<std::size_t> facets_in_transition(const contact::NitscheForm<2>&,
                                                       std::span<const Point<2>>);
template std::vector<std::size_t> facets_in_transition(const contact::NitscheForm<3>&,
                                                       std::span<const Point<3>>);

}  // namespace tribound::certify
