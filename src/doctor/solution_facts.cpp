#include "doctor/solution_facts.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <variant>

#include "contact/body_support.h"
#include "doctor/contact_facts.h"

namespace tribound
{

namespace
{

/// A contact facet after the solution.
template <int dim>
struct FacetOutcome
{
  Point<dim> centre;
  double pressure = 0;  ///< mean
  bool closed = true;   ///< pressure at every quadrature point
};

/// Adds the states on a facet to the outcome of its boundary.
template <int dim>
FacetOutcome<dim> add_facet(const Quadrature<dim - 1>& rule, double measure,
                            std::span<const ContactState<dim>> states, ContactOutcome& outcome)
{
  FacetOutcome<dim> facet;
  facet.centre.setZero();
  for (int q = 0; q < rule.size(); ++q)
  {
    const ContactState<dim>& state = states[q];
    const double share = rule.weights[q] * (dim - 1);  // of the facet
    facet.centre += share * state.point;
    facet.pressure += share * state.pressure;
    facet.closed = facet.closed && state.pressure > 0;
    if (state.pressure > 0) outcome.closed += measure * share;
    if (state.pressure > 0 && state.status == ContactStatus::slip) outcome.slipping += measure * share;
    outcome.largest_pressure = std::max(outcome.largest_pressure, state.pressure);
    if (-state.gap <= outcome.penetration) continue;
    outcome.penetration = -state.gap;
    outcome.penetration_at = place<dim>(state.point);
  }
  ++outcome.facets;
  outcome.closed_facets += facet.closed ? 1 : 0;
  return facet;
}

/// The mean pressure of a facet minus the value in its centre of the linear function through its neighbours.
template <int dim>
double deviation(std::span<const FacetOutcome<dim>> facets, int k, const std::vector<int>& neighbours)
{
  const auto n = static_cast<Eigen::Index>(neighbours.size());
  double size = 0;
  for (const int j : neighbours) size = std::max(size, (facets[j].centre - facets[k].centre).norm());
  Eigen::MatrixXd conditions(dim + 1, n);  // the weights reproduce 1 and x; in the least-squares sense on
  for (Eigen::Index i = 0; i < n; ++i)     // a curved boundary
    conditions.col(i) << 1, (facets[neighbours[i]].centre - facets[k].centre) / size;
  const Eigen::VectorXd weights =
      conditions.completeOrthogonalDecomposition().solve(Eigen::VectorXd::Unit(dim + 1, 0));
  double interpolated = 0;
  for (Eigen::Index i = 0; i < n; ++i) interpolated += weights[i] * facets[neighbours[i]].pressure;
  return facets[k].pressure - interpolated;
}

template <int dim>
void add_zigzag(const NitscheForm<dim>& form, std::span<const FacetOutcome<dim>> facets,
                std::map<int, ContactOutcome>& outcomes)
{
  const std::vector<std::array<int, 2>> pairs = contact_neighbours(form);
  std::vector<std::vector<int>> neighbours(facets.size());
  for (const auto& [k, l] : pairs)
    if (facets[k].closed && facets[l].closed)
    {
      neighbours[k].push_back(l);
      neighbours[l].push_back(k);
    }
  std::vector<std::optional<double>> deviations(facets.size());
  for (std::size_t k = 0; k < facets.size(); ++k)
    if (neighbours[k].size() == dim) deviations[k] = deviation(facets, static_cast<int>(k), neighbours[k]);
  for (const auto& [k, l] : pairs)
  {
    if (!deviations[k] || !deviations[l] || *deviations[k] * *deviations[l] >= 0) continue;
    ContactOutcome& outcome = outcomes.at(form.contact_facets()[k].facet.tag);
    const double amplitude = std::min(std::abs(*deviations[k]), std::abs(*deviations[l]));
    if (amplitude <= outcome.zigzag) continue;
    outcome.zigzag = amplitude;
    outcome.zigzag_at = place<dim>((facets[k].centre + facets[l].centre) / 2);
  }
}

}  // namespace

template <int dim>
std::vector<ContactOutcome> contact_outcomes(const NitscheForm<dim>& form, std::span<const double> u)
{
  const FacetTabulation<dim> table = tabulate_on_facets<dim>(form.space().basis(), form.facet_rule().points);
  std::map<int, ContactOutcome> outcomes;  // by boundary
  std::vector<FacetOutcome<dim>> facets;
  facets.reserve(form.contact_facets().size());
  for (int k = 0; k < static_cast<int>(form.contact_facets().size()); ++k)
  {
    const ContactFacet<dim>& facet = form.contact_facets()[k];
    ContactOutcome& outcome = outcomes[facet.facet.tag];
    outcome.boundary = form.problem().boundary(facet.facet.tag).name;
    outcome.has_friction = has_friction(facet.contact->friction);
    if (const auto* coulomb = std::get_if<Coulomb>(&facet.contact->friction))
      outcome.coefficient = coulomb->coefficient;
    facets.push_back(
        add_facet<dim>(form.facet_rule(), facet.geometry.measure, form.contact_states(u, k, table), outcome));
  }
  add_zigzag<dim>(form, facets, outcomes);
  std::vector<ContactOutcome> result;
  result.reserve(outcomes.size());
  for (auto& [tag, outcome] : outcomes) result.push_back(std::move(outcome));
  return result;
}

template std::vector<ContactOutcome> contact_outcomes(const NitscheForm<2>&, std::span<const double>);
template std::vector<ContactOutcome> contact_outcomes(const NitscheForm<3>&, std::span<const double>);

}  // namespace tribound
