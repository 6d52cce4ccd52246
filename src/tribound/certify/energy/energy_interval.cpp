#include "tribound/certify/energy/energy_interval.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tribound::certify
{

template <int dim>
bool is_homogeneous(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets)
{
  const auto is_zero = [](const problem::Field& field) { return field.is_zero(); };
  bool result = !form.problem().has_initial_stress();
  for (const problem::BoundaryCondition<dim>& boundary : form.problem().boundaries())
  {
    result = result && !boundary.spring;
    for (const std::optional<problem::Field>& component : boundary.displacement)
      result = result && (!component || is_zero(*component));
  }
  for (const problem::Contact* contact : form.problem().contacts())
    result = result && (!contact->gap || is_zero(*contact->gap));
  constexpr double rounding = 1e-14;  // of coordinates
  const auto is_apart = [&](const contact::ContactSegment<dim>& segment)
  {
    if (segment.contact->gap || problem::cone(segment.contact->law).is_tied) return false;
    const auto map = contact::simplex_map(form.space().mesh(), segment.slave);
    const double size = rounding * (map.origin.norm() + map.jacobian.norm());
    return std::ranges::any_of(segment.offset,
                               [&](const Point<dim>& offset)
                               {
                                 return (segment.varying_normal != nullptr
                                             ? offset.norm()
                                             : std::abs(offset.dot(segment.normal))) > size;
                               });
  };
  bool differs = std::ranges::any_of(form.segments(), is_apart);
  for (std::size_t k = 0; k < facets.size(); ++k) differs = differs || facets.has_slipped(k);
  return result && !form.space().mesh().ranks().any(differs);
}

template <int dim>
void set_energy(const BoundedState<dim>& state, bool is_homogeneous, QuantityInterval& interval)
{
  const EnergyBound& bound = state.bound;
  const DualPair<dim> pair{.z = {state.v.begin(), state.v.end()}};
  const Ranks& ranks = state.form.space().mesh().ranks();
  const DualProducts products = products_of_stresses<dim>(state, pair);
  const DualSums sums(products, ranks);
  const double quarter = bound.gap - bound.mid * bound.mid - bound.springs / 4;  // ||tau - sigma(v)||^2 / 4
  const double of_mean = sums.square + 2 * sums.centre + quarter;                // ||(tau + sigma(v))/2||^2
  double lower = std::pow(std::max(0.0, std::sqrt(std::max(0.0, of_mean - sums.doubt)) - bound.mid), 2);
  double upper = std::pow(std::sqrt(std::max(0.0, of_mean + sums.doubt)) + bound.mid, 2);
  interval.basis = "energy bound";
  if (is_homogeneous)
  {
    const double of_tau =
        sums.square + 4 * sums.centre + 4 * quarter + 2 * state.remainder(pair.z, sums.work);
    const double off = 2 * state.unresolved * std::sqrt(sums.energy) + sums.doubt;
    const double beyond = 2 * bound.oscillation * bound.b_v;
    intersect(lower, upper, of_tau - 2 * bound.gap - off, of_tau + beyond + off);
    interval.basis = "duality gap";
  }
  constexpr double unit = 1e-13;
  set_ends(interval, lower, upper, unit * (sums.square + sums.absolute));
  interval.cells = state.shares((interval.upper - interval.lower) / 2);
}

template bool is_homogeneous(const contact::NitscheForm<2>&, const ObstacleFacets<2>&);
template bool is_homogeneous(const contact::NitscheForm<3>&, const ObstacleFacets<3>&);
template void set_energy(const BoundedState<2>&, bool, QuantityInterval&);
template void set_energy(const BoundedState<3>&, bool, QuantityInterval&);

}  // namespace tribound::certify
