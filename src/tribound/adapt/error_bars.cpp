#include "tribound/adapt/error_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>
#include <utility>

#include "tribound/adapt/finer_contact.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/certify/energy/obstacle_facets.h"

namespace tribound::adapt
{

namespace
{

/// work(), or the reason why it fails.
certify::EnergyBound attempt(const Ranks& ranks, const std::function<certify::EnergyBound()>& work)
{
  std::string why;
  try
  {
    return work();
  }
  catch (const SolveError& error)
  {
    why = error.what();
  }
  catch (const InputError& error)  // on data at points where nothing else needs them
  {
    why = error.what();
  }
  catch (const std::bad_alloc&)
  {
    why = "out of memory";
  }
  require_all_failed(ranks, why);
  return {.reason = why};
}

/// Sums the squares of cells over their n parent cells.
void add_up(std::vector<double>& cells, std::span<const Index> parent, Index n)
{
  if (cells.empty()) return;
  std::vector<double> sums(n, 0.0);
  for (std::size_t c = 0; c < parent.size(); ++c) sums[parent[c]] += cells[c];
  cells = std::move(sums);
}

/// The bound on a mesh with these parents, as one for the mesh of the parents.
certify::EnergyBound added_up(certify::EnergyBound bound, std::span<const Index> parent, Index n)
{
  add_up(bound.cells, parent, n);
  for (certify::QuantityInterval& quantity : bound.quantities) add_up(quantity.cells, parent, n);
  return bound;
}

/// Where the state of contact changes on cells that are bisected, or else on this mesh.
template <int dim>
certify::EnergyBound bound_or_reason(const contact::NitscheForm<dim>& form, const Method& method,
                                     std::span<const double> u,
                                     const std::vector<problem::Quantity<dim>>& quantities,
                                     std::optional<double> korn)
{
  const Ranks& ranks = form.space().mesh().ranks();
  const auto on_this_mesh = [&]
  { return certify::EnergyEstimator<dim>(form, method.solver, quantities, korn)(u); };
  const auto where_it_is_finer = [&]() -> certify::EnergyBound
  {
    const auto finer = finer_contact<dim>(form, u);
    if (!finer) return {.reason = "the state changes nowhere"};
    return added_up(certify::EnergyEstimator<dim>(*finer->form, method.solver, quantities, korn)(finer->u),
                    finer->parent, form.space().mesh().n_owned_cells());
  };
  certify::EnergyBound bound = attempt(ranks, where_it_is_finer);
  if (!bound.reason.empty()) bound = attempt(ranks, on_this_mesh);
  return bound;
}

/// 2D: the bound on a mesh with cells cut so that facets match, which is the sharper one; a reason where
/// there is none.
template <int dim>
certify::EnergyBound where_it_matches(const contact::NitscheForm<dim>& form, const Method& method,
                                      std::span<const double> u,
                                      const std::vector<problem::Quantity<dim>>& quantities,
                                      std::optional<double> korn)
{
  const auto matching = matching_contact<dim>(form, u);
  if (!matching) return {.reason = "meshes match, or cannot be made to"};
  return added_up(bound_or_reason<dim>(*matching->form, method, matching->u, quantities, korn),
                  matching->parent, form.space().mesh().n_owned_cells());
}

}  // namespace

template <int dim>
certify::EnergyBound energy_bound(const contact::NitscheForm<dim>& form, const Method& method,
                                  std::span<const double> u,
                                  const std::vector<problem::Quantity<dim>>& quantities,
                                  std::optional<double> korn)
{
  if (const std::string unfit = certify::laws_unfit(form); !unfit.empty())
    return certify::no_energy_bound<dim>(form, u, quantities, unfit);
  certify::EnergyBound bound = attempt(form.space().mesh().ranks(),
                                       [&] { return where_it_matches(form, method, u, quantities, korn); });
  if (!bound.reason.empty()) bound = bound_or_reason<dim>(form, method, u, quantities, korn);
  if (bound.quantities.size() == quantities.size()) return bound;
  return certify::no_energy_bound<dim>(form, u, quantities, bound.reason);
}

template <int dim>
certify::EnergyBound error_bars(const contact::NitscheForm<dim>& form, const Method& method,
                                const CertifiedLevel<dim>& level, const certify::Verdict& verdict,
                                const std::vector<problem::Quantity<dim>>& quantities)
{
  if (!certify::is_bound(verdict.status))
    return certify::no_energy_bound<dim>(form, level.u, quantities, "there is no bound of the residual");
  const auto& constants = level.friedrichs;
  return energy_bound<dim>(form, method, level.u, quantities,
                           constants ? std::optional(constants->korn) : std::nullopt);
}

const certify::QuantityInterval* find_interval(const certify::EnergyBound& bound, const std::string& name)
{
  const auto found = std::ranges::find(bound.quantities, name, &certify::QuantityInterval::name);
  return found != bound.quantities.end() && found->reason.empty() ? &*found : nullptr;
}

std::span<const double> shares_of_cells(const ErrorBars& bars,
                                        const std::optional<certify::EnergyBound>& bound)
{
  if (!bound || !bound->reason.empty()) return {};
  const certify::QuantityInterval* goal = bars.goal.empty() ? nullptr : find_interval(*bound, bars.goal);
  return goal && !goal->cells.empty() ? goal->cells : bound->cells;
}

namespace
{

std::string unmet_goal(const ErrorBars& bars, const certify::EnergyBound& bound)
{
  if (!bars.goal_tolerance) return {};
  const certify::QuantityInterval* goal = find_interval(bound, bars.goal);
  if (goal == nullptr)
    return fmt::format("\"{}\", for which adapt.goal_tolerance is given, has no error bar", bars.goal);
  if (goal->bar() <= *bars.goal_tolerance * std::abs(goal->value)) return {};
  return fmt::format("\"{}\" = {:.6g} is known to {:.3g}, not to adapt.goal_tolerance = {:g} %", bars.goal,
                     goal->value, goal->bar(), 100 * *bars.goal_tolerance);
}

std::string unmet_energy(const ErrorBars& bars, const certify::EnergyBound& bound, double energy_norm)
{
  if (!bars.energy_tolerance) return {};
  if (!bound.reason.empty())
    return fmt::format(
        "the error in the energy norm, for which adapt.energy_tolerance is given, has no bound: {}",
        bound.reason);
  if (bound.bound <= *bars.energy_tolerance * energy_norm) return {};
  return fmt::format(
      "the bound of the error in the energy norm is {:.3g} % of ||u_h||_en, above "
      "adapt.energy_tolerance = {:g} %",
      100 * bound.bound / energy_norm, 100 * *bars.energy_tolerance);
}

}  // namespace

std::string unmet(const ErrorBars& bars, const certify::EnergyBound& bound, double energy_norm)
{
  std::string energy = unmet_energy(bars, bound, energy_norm);
  const std::string goal = unmet_goal(bars, bound);
  return energy + (energy.empty() || goal.empty() ? "" : "; ") + goal;
}

template certify::EnergyBound energy_bound(const contact::NitscheForm<2>&, const Method&,
                                           std::span<const double>, const std::vector<problem::Quantity<2>>&,
                                           std::optional<double>);
template certify::EnergyBound energy_bound(const contact::NitscheForm<3>&, const Method&,
                                           std::span<const double>, const std::vector<problem::Quantity<3>>&,
                                           std::optional<double>);
template certify::EnergyBound error_bars(const contact::NitscheForm<2>&, const Method&,
                                         const CertifiedLevel<2>&, const certify::Verdict&,
                                         const std::vector<problem::Quantity<2>>&);
template certify::EnergyBound error_bars(const contact::NitscheForm<3>&, const Method&,
                                         const CertifiedLevel<3>&, const certify::Verdict&,
                                         const std::vector<problem::Quantity<3>>&);

}  // namespace tribound::adapt
