#include "adapt/mark.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tribound
{

namespace
{

/// The cells with eta_T > 0 and eta_T >= bound, ascending.
std::vector<Index> cells_from(std::span<const double> eta, double bound)
{
  assert(std::ranges::all_of(eta, [](double x) { return std::isfinite(x) && x >= 0; }));
  std::vector<Index> cells;
  for (std::size_t c = 0; c < eta.size(); ++c)
    if (eta[c] > 0 && eta[c] >= bound) cells.push_back(static_cast<Index>(c));
  return cells;
}

}  // namespace

std::vector<Index> mark_doerfler(std::span<const double> eta, double theta)
{
  assert(theta > 0 && theta <= 1);
  std::vector<Index> cells = cells_from(eta, 0);
  if (theta == 1) return cells;  // round-off must not leave a small one out
  const auto sum = [&](auto first, auto last)
  { return std::accumulate(first, last, 0.0, [&](double s, Index c) { return s + eta[c] * eta[c]; }); };
  const auto larger = [&](Index a, Index b) { return eta[a] != eta[b] ? eta[a] > eta[b] : a < b; };

  // Bisection by nth_element: [begin, taken) is in the set, [rest, end) is not.
  double missing = theta * theta * sum(cells.begin(), cells.end());
  auto taken = cells.begin();
  auto rest = cells.end();
  while (rest - taken > 1)
  {
    const auto middle = taken + (rest - taken) / 2;
    std::nth_element(taken, middle, rest, larger);
    const double half = sum(taken, middle);
    if (half >= missing)
      rest = middle;
    else
    {
      missing -= half;
      taken = middle;
    }
  }
  cells.erase(rest, cells.end());
  std::ranges::sort(cells);
  return cells;
}

std::vector<Index> mark_maximum(std::span<const double> eta, double theta)
{
  assert(theta > 0 && theta <= 1);
  return eta.empty() ? std::vector<Index>{} : cells_from(eta, theta * *std::ranges::max_element(eta));
}

std::vector<Index> mark(std::span<const double> eta, const AdaptConfig& config)
{
  return config.marking == Marking::doerfler ? mark_doerfler(eta, config.theta)
                                             : mark_maximum(eta, config.theta);
}

}  // namespace tribound
