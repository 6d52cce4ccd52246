#include "app/console/forecast.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "tribound/adapt/rate.h"

namespace tribound::app
{

namespace
{

constexpr std::size_t fewest_levels = 3;
/// Slower than this nothing is known of what is to come.
constexpr double slowest_rate = -0.05;

/// Two digits: it is a guess.
std::string count_in_words(double n)
{
  if (!(n < 1e9)) return "more than 10^9";
  const bool millions = n >= 995'000;  // which rounds to one
  if (millions) n /= 1e6;
  const double unit = std::pow(10, std::floor(std::log10(n)) - 1);
  return fmt::format("{:g}{}", std::round(n / unit) * unit, millions ? " million" : "");
}

}  // namespace

std::string forecast_text(const io::RunRecord& run, long max_dofs)
{
  std::vector<adapt::RatePoint> points;
  for (const io::LevelRecord& level : run.levels)
    if (const auto relative = io::relative_bound(level))
      points.push_back({static_cast<double>(level.dofs), *relative});
  if (points.size() < fewest_levels || points.back().value <= run.tolerance) return {};
  const std::optional<double> rate = adapt::fitted_rate(points);
  if (!rate) return {};
  if (*rate > slowest_rate) return "  the bound hardly decreases";
  const double needed = points.back().dofs * std::pow(run.tolerance / points.back().value, 1 / *rate);
  return fmt::format("  at this rate {:g} % needs {} unknowns{}", 100 * run.tolerance, count_in_words(needed),
                     needed > static_cast<double>(max_dofs) ? ", above adapt.max_dofs" : "");
}

}  // namespace tribound::app
