#include "tribound/certify/energy/quantity_interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tribound::certify
{

double QuantityInterval::bar() const
{
  return std::max(upper - value, value - lower);
}

void set_ends(QuantityInterval& interval, double lower, double upper, double rounding)
{
  interval.lower = std::min(lower, upper) - rounding;
  interval.upper = std::max(lower, upper) + rounding;
  if (std::isfinite(interval.lower) && std::isfinite(interval.upper)) return;
  interval.lower = interval.upper = 0;
  interval.reason = "an end of the interval is not a finite number";
}

void intersect(double& lower, double& upper, double other_lower, double other_upper)
{
  const double low = std::max(lower, other_lower);
  const double high = std::min(upper, other_upper);
  lower = std::min(low, high);
  upper = std::max(low, high);
}

void set_safety_factor(QuantityInterval& interval, double coefficient, const QuantityInterval& normal,
                       const std::vector<QuantityInterval>& tangential)
{
  double least = 0;  // lower bound of H^2
  double most = 0;
  for (const QuantityInterval& component : tangential)
  {
    const double nearest = std::max({0.0, component.lower, -component.upper});
    least += nearest * nearest;
    most += std::pow(std::max(std::abs(component.lower), std::abs(component.upper)), 2);
  }
  const double at_least = coefficient * std::max(normal.lower, 0.0) / std::sqrt(most);  // in tension 0
  if (least > 0)
    set_ends(interval, at_least, coefficient * std::max(normal.upper, 0.0) / std::sqrt(least), 0);
  else
    interval.reason =
        std::isfinite(at_least)
            ? fmt::format("the tangential force may be 0: the factor is at least {:.6g}", at_least)
            : "there may be no force";
}

}  // namespace tribound::certify
