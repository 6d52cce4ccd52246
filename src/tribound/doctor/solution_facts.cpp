#include "tribound/doctor/solution_facts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <variant>

#include "tribound/base/dense_factors.h"
#include "tribound/contact/support/support.h"
#include "tribound/doctor/contact_facts.h"

namespace tribound::doctor
{

namespace
{

/// A contact facet in the solution.
template <int dim>
struct FacetOutcome
{
  double measure = 0;
  Point<dim> centre = Point<dim>::Zero();
  double pressure = 0;  ///< mean
  double largest_pressure = 0;
  Point<dim> largest_pressure_at = Point<dim>::Zero();
  bool closed = true;  ///< pressure at every quadrature point
};

/// Adds the states on a facet to the outcome of its boundary.
template <int dim>
FacetOutcome<dim> add_facet(std::span<const contact::ContactPoint<dim>> points, double measure,
                            std::span<const contact::ContactState<dim>> states, ContactOutcome& outcome)
{
  FacetOutcome<dim> facet{.measure = measure};
  for (std::size_t q = 0; q < points.size(); ++q)
  {
    const contact::ContactState<dim>& state = states[q];
    const double share = points[q].weight / measure;
    facet.centre += share * state.point;
    facet.pressure += share * std::max(0.0, state.pressure);  // a bond may be in tension
    facet.closed = facet.closed && state.pressure > 0;
    if (state.pressure > 0) outcome.closed += measure * share;
    outcome.carries = outcome.carries || !state.traction.isZero(0);
    if (state.pressure > 0 && state.status == problem::ContactStatus::slip)
      outcome.slipping += measure * share;
    if (state.pressure > facet.largest_pressure)
    {
      facet.largest_pressure = state.pressure;
      facet.largest_pressure_at = state.point;
    }
    if (-state.gap <= outcome.penetration) continue;
    outcome.penetration = -state.gap;
    outcome.penetration_at = place<dim>(state.point);
  }
  outcome.largest_pressure = std::max(outcome.largest_pressure, facet.largest_pressure);
  outcome.force += measure * facet.pressure;
  ++outcome.facets;
  outcome.closed_facets += facet.closed ? 1 : 0;
  return facet;
}

/// Adds the outcome on another segment of the facet.
template <int dim>
void join(FacetOutcome<dim>& facet, const FacetOutcome<dim>& part)
{
  const double share = part.measure / (facet.measure + part.measure);
  facet.measure += part.measure;
  facet.centre += share * (part.centre - facet.centre);
  facet.pressure += share * (part.pressure - facet.pressure);
  facet.closed = facet.closed && part.closed;
  if (part.largest_pressure <= facet.largest_pressure) return;
  facet.largest_pressure = part.largest_pressure;
  facet.largest_pressure_at = part.largest_pressure_at;
}

/// d_F of ContactOutcome::zigzag.
template <int dim>
double deviation(std::span<const FacetOutcome<dim>> facets, int k, const std::vector<int>& neighbours)
{
  const auto n = static_cast<Eigen::Index>(neighbours.size());
  double size = 0;
  for (const int j : neighbours) size = std::max(size, (facets[j].centre - facets[k].centre).norm());
  Eigen::MatrixXd conditions(dim + 1, n);  // the weights reproduce 1 and x; in the least-squares sense on
  for (Eigen::Index i = 0; i < n; ++i)     // a curved boundary
    conditions.col(i) << 1, (facets[neighbours[i]].centre - facets[k].centre) / size;
  const Eigen::VectorXd weights = least_norm_solution(conditions, Eigen::VectorXd::Unit(dim + 1, 0));
  double interpolated = 0;
  for (Eigen::Index i = 0; i < n; ++i) interpolated += weights[i] * facets[neighbours[i]].pressure;
  return facets[k].pressure - interpolated;
}

/// a_F of ContactOutcome::zigzag for every facet.
template <int dim>
std::vector<double> zigzag_amplitudes(std::span<const FacetOutcome<dim>> facets,
                                      std::span<const std::array<int, 2>> pairs)
{
  std::vector<std::vector<int>> neighbours(facets.size());
  for (const auto& [k, l] : pairs)
  {
    if (!facets[k].closed || !facets[l].closed) continue;
    neighbours[k].push_back(l);
    neighbours[l].push_back(k);
  }
  std::vector<double> d(facets.size(), 0);  // zero, without a sign, where it is not defined
  for (std::size_t k = 0; k < facets.size(); ++k)
    if (neighbours[k].size() == dim) d[k] = deviation(facets, static_cast<int>(k), neighbours[k]);
  std::vector<double> amplitudes(facets.size(), 0);
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    double largest = 0;  // of the other sign
    double second = 0;
    for (const int j : neighbours[k])
    {
      if (d[j] * d[k] >= 0) continue;
      second = std::max(second, std::min(largest, std::abs(d[j])));
      largest = std::max(largest, std::abs(d[j]));
    }
    amplitudes[k] = std::min(std::abs(d[k]), second) / 2;
  }
  return amplitudes;
}

template <int dim>
void add_zigzag(const contact::NitscheForm<dim>& form, std::span<const FacetOutcome<dim>> facets,
                std::span<const std::array<int, 2>> pairs, std::map<int, ContactOutcome>& outcomes)
{
  struct Squares
  {
    double amplitude = 0;
    double pressure = 0;
    double largest_amplitude = 0;
  };
  std::map<int, Squares> squares;  // by boundary
  const std::vector<double> amplitudes = zigzag_amplitudes<dim>(facets, pairs);
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    if (!facets[k].closed) continue;
    const int tag = form.segments()[k].slave.facet.tag;
    Squares& sums = squares[tag];
    sums.amplitude += facets[k].measure * amplitudes[k] * amplitudes[k];
    sums.pressure += facets[k].measure * facets[k].pressure * facets[k].pressure;
    if (amplitudes[k] <= sums.largest_amplitude) continue;
    sums.largest_amplitude = amplitudes[k];
    outcomes.at(tag).zigzag_at = place<dim>(facets[k].centre);
  }
  for (const auto& [tag, sums] : squares) outcomes.at(tag).zigzag = std::sqrt(sums.amplitude / sums.pressure);
}

template <int dim>
void add_kinks(const contact::NitscheForm<dim>& form, std::span<const FacetOutcome<dim>> facets,
               std::span<const std::array<int, 2>> pairs, std::map<int, ContactOutcome>& outcomes)
{
  for (const auto& [k, l] : pairs)
  {
    const double angle = kink(form.space().mesh(), form.segments()[k], form.segments()[l]);
    const FacetOutcome<dim>& facet = facets[facets[k].largest_pressure > facets[l].largest_pressure ? k : l];
    if (angle == 0 || facet.largest_pressure == 0) continue;
    ContactOutcome& outcome = outcomes.at(form.segments()[k].slave.facet.tag);
    outcome.kink = std::max(outcome.kink, angle);
    if (facet.largest_pressure <= outcome.kink_pressure) continue;
    outcome.kink_pressure = facet.largest_pressure;
    outcome.kink_at = place<dim>(facet.largest_pressure_at);
  }
}

}  // namespace

template <int dim>
std::vector<ContactOutcome> contact_outcomes(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  std::map<int, ContactOutcome> outcomes;  // by boundary
  std::vector<FacetOutcome<dim>> facets(form.segments().size(),
                                        FacetOutcome<dim>{.closed = false});  // of first segments
  int first = 0;
  std::vector<SegmentStates<dim>> states;
  states.reserve(form.segments().size());
  for (int k = 0; k < static_cast<int>(form.segments().size()); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    ContactOutcome& outcome = outcomes[segment.slave.facet.tag];
    outcome.boundary = form.problem().boundary(segment.slave.facet.tag).name;
    outcome.has_master = segment.master.has_value();
    const problem::FrictionCone friction = cone(segment.contact->law);
    outcome.has_friction = friction.resists_sliding() && !friction.is_bonded;
    if (friction.coefficient > 0) outcome.coefficient = friction.coefficient;
    states.push_back(form.contact_states(u, k));
    const FacetOutcome<dim> part =
        add_facet<dim>(form.contact_points(k), segment.measure, states.back(), outcome);
    if (is_first_of_facet(form, k))
      facets[first = k] = part;
    else
      join(facets[first], part);
  }
  const std::vector<std::array<int, 2>> pairs = contact_neighbours(form);
  add_zigzag<dim>(form, facets, pairs, outcomes);
  add_kinks<dim>(form, facets, pairs, outcomes);
  std::vector<ContactOutcome> result;
  result.reserve(outcomes.size());
  for (auto& [tag, outcome] : outcomes)
  {
    if (form.problem().contact(tag)->is_bilateral()) continue;
    outcome.damage = damage_facts<dim>(form, states, tag);
    result.push_back(std::move(outcome));
  }
  return result;
}

template std::vector<ContactOutcome> contact_outcomes(const contact::NitscheForm<2>&,
                                                      std::span<const double>);
template std::vector<ContactOutcome> contact_outcomes(const contact::NitscheForm<3>&,
                                                      std::span<const double>);

}  // namespace tribound::doctor
