#include "tribound/adapt/error_bars.h"

#include <fmt/format.h>

#include <new>

#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"

namespace tribound::adapt
{

template <int dim>
certify::EnergyBound energy_bound(const contact::NitscheForm<dim>& form, const Method& method,
                                  std::span<const double> u)
{
  std::string why;
  try
  {
    return certify::EnergyEstimator<dim>(form, method.solver)(u);
  }
  catch (const SolveError& error)
  {
    why = error.what();
  }
  catch (const InputError& error)  // of data at points where nothing else needs them
  {
    why = error.what();
  }
  catch (const std::bad_alloc&)
  {
    why = "out of memory";
  }
  require_all_failed(form.space().mesh().ranks(), why);
  return {.reason = why};
}

std::string unmet(const ErrorBars& bars, const certify::EnergyBound& bound, double energy_norm)
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

template certify::EnergyBound energy_bound(const contact::NitscheForm<2>&, const Method&,
                                           std::span<const double>);
template certify::EnergyBound energy_bound(const contact::NitscheForm<3>&, const Method&,
                                           std::span<const double>);

}  // namespace tribound::adapt
