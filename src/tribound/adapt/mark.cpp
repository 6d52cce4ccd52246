#include "tribound/adapt/mark.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "tribound/base/norm.h"

namespace tribound::adapt
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

std::vector<Index> mark_one(std::span<const double> eta, const MarkingOptions& options)
{
  return options.strategy == Marking::doerfler ? mark_doerfler(eta, options.theta)
                                               : mark_maximum(eta, options.theta);
}

std::vector<double> values(std::span<const certify::BoundComponents> cells,
                           double (certify::BoundComponents::*part)() const)
{
  std::vector<double> eta;
  eta.reserve(cells.size());
  for (const certify::BoundComponents& cell : cells) eta.push_back((cell.*part)());
  return eta;
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

std::vector<Index> mark_all(std::size_t n_cells)
{
  std::vector<Index> cells(n_cells);
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

std::vector<Index> mark(std::span<const certify::BoundComponents> cells, const MarkingOptions& options)
{
  if (options.strategy == Marking::uniform) return mark_all(cells.size());
  if (!options.separate_contact)
    return mark_one(values(cells, &certify::BoundComponents::total_sharp), options);
  constexpr double small_part = 0.1;  // of the bound
  const double bound = norm(values(cells, &certify::BoundComponents::total_sharp));
  std::vector<Index> marked;
  for (const auto part : {&certify::BoundComponents::body, &certify::BoundComponents::contact})
  {
    const std::vector<double> eta = values(cells, part);
    if (norm(eta) < small_part * bound) continue;
    const std::vector<Index> own = mark_one(eta, options);
    std::vector<Index> both;
    std::ranges::set_union(marked, own, std::back_inserter(both));
    marked = std::move(both);
  }
  return marked;
}

}  // namespace tribound::adapt
