#include "tribound/adapt/mark.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "tribound/base/norm.h"

namespace tribound::adapt
{

namespace
{

/// Values of eta_T that agree up to this relative difference count as equal.
constexpr double slack = 1e-9;

/// The cells with eta_T > 0 and eta_T >= bound, ascending.
std::vector<Index> cells_from(std::span<const double> eta, double bound)
{
  assert(std::ranges::all_of(eta, [](double x) { return std::isfinite(x) && x >= 0; }));
  std::vector<Index> cells;
  for (std::size_t c = 0; c < eta.size(); ++c)
    if (eta[c] > 0 && eta[c] >= bound) cells.push_back(static_cast<Index>(c));
  return cells;
}

/// Partial sums of squares of values >= 0, from the largest down.
class SumsFromAbove
{
 public:
  explicit SumsFromAbove(std::span<const double> values) : sorted_(values.begin(), values.end())
  {
    std::ranges::sort(sorted_, std::greater<>());
    sums_.reserve(sorted_.size() + 1);
    for (const double x : sorted_) sums_.push_back(sums_.back() + x * x);
  }

  /// The sum over values >= bound.
  [[nodiscard]] double operator()(double bound) const
  {
    const auto end = std::ranges::partition_point(sorted_, [bound](double x) { return x >= bound; });
    return sums_[end - sorted_.begin()];
  }

 private:
  std::vector<double> sorted_;
  std::vector<double> sums_{0.0};
};

/// The largest t such that the squares of the values >= t sum to at least `wanted`. Found by bisection on the
/// bits of t, which are ordered like t.
double threshold(const Ranks& ranks, const SumsFromAbove& sum, double largest, double wanted)
{
  std::uint64_t low = 0;
  std::uint64_t high = std::bit_cast<std::uint64_t>(largest) + 1;
  while (high - low > 1)
  {
    const std::uint64_t middle = low + (high - low) / 2;
    (ranks.sum(sum(std::bit_cast<double>(middle))) >= wanted ? low : high) = middle;
  }
  return std::bit_cast<double>(low);
}

/// How many cells of this rank are among the `n` cells of all ranks with the lowest names, n > 0. The n-th
/// name is found bit by bit. `cells` are in ascending order.
std::size_t n_among_lowest(const Markers& markers, std::span<const Index> cells, std::int64_t n)
{
  if (markers.ranks.size() == 1) return std::min<std::size_t>(cells.size(), n);
  using Words = std::array<std::uint64_t, 3>;
  const auto words = [&](Index cell)
  {
    const mesh::CellName& name = markers.names[cell];
    return Words{static_cast<std::uint64_t>(name.root), name.path[0], name.path[1]};
  };
  const auto n_before = [&](const Words& key)
  { return std::ranges::partition_point(cells, [&](Index c) { return words(c) < key; }) - cells.begin(); };
  Words key{};
  for (std::uint64_t& word : key)
    for (std::uint64_t bit = std::uint64_t{1} << 63; bit != 0; bit >>= 1)
    {
      word |= bit;
      if (markers.ranks.sum(std::int64_t{n_before(key)}) >= n) word ^= bit;
    }
  const auto end = std::ranges::partition_point(cells, [&](Index c) { return words(c) <= key; });
  return end - cells.begin();
}

std::vector<Index> mark_one(std::span<const double> eta, const MarkingOptions& options,
                            const Markers& markers)
{
  return options.strategy == Marking::doerfler ? mark_doerfler(eta, options.theta, markers)
                                               : mark_maximum(eta, options.theta, markers);
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

std::vector<Index> mark_doerfler(std::span<const double> eta, double theta, const Markers& markers)
{
  assert(theta > 0 && theta <= 1);
  if (theta == 1) return cells_from(eta, 0);  // round-off must not drop a small one
  const Ranks& ranks = markers.ranks;
  const SumsFromAbove sum(eta);
  const double largest = ranks.max(eta.empty() ? 0.0 : *std::ranges::max_element(eta));
  if (largest == 0) return {};
  const double wanted = theta * theta * ranks.sum(sum(0));
  const double t = threshold(ranks, sum, largest, wanted);

  std::vector<Index> cells;
  std::vector<Index> ties;
  double sum_above = 0;
  for (std::size_t c = 0; c < eta.size(); ++c)
    if (eta[c] > t * (1 + slack))
    {
      cells.push_back(static_cast<Index>(c));
      sum_above += eta[c] * eta[c];
    }
    else if (eta[c] >= t * (1 - slack))
      ties.push_back(static_cast<Index>(c));
  constexpr double rounding = 1e-6;  // of a cell
  double missing = std::ceil((wanted - ranks.sum(sum_above)) / (t * t) - rounding);
  const bool has_any = ranks.any(!cells.empty());
  if (!(missing >= 1)) missing = has_any ? 0 : 1;  // tiny shares, or squares that underflow
  missing = std::min(missing, static_cast<double>(ranks.sum(static_cast<std::int64_t>(ties.size()))));
  ties.resize(missing > 0 ? n_among_lowest(markers, ties, std::llround(missing)) : 0);
  std::vector<Index> both;
  std::ranges::merge(cells, ties, std::back_inserter(both));
  return both;
}

std::vector<Index> mark_maximum(std::span<const double> eta, double theta, const Markers& markers)
{
  assert(theta > 0 && theta <= 1);
  const double largest = markers.ranks.max(eta.empty() ? 0.0 : *std::ranges::max_element(eta));
  return cells_from(eta, theta * largest * (1 - slack));
}

std::vector<Index> mark_all(std::size_t n_cells)
{
  std::vector<Index> cells(n_cells);
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

std::vector<Index> mark(std::span<const certify::BoundComponents> cells, const MarkingOptions& options,
                        const Markers& markers)
{
  if (options.strategy == Marking::uniform) return mark_all(cells.size());
  if (!options.separate_contact)
    return mark_one(values(cells, &certify::BoundComponents::total_sharp), options, markers);
  constexpr double small_part = 0.1;  // of the bound
  const auto size = [&](const std::vector<double>& eta)
  { return std::sqrt(markers.ranks.sum(std::pow(norm(eta), 2))); };
  const double bound = size(values(cells, &certify::BoundComponents::total_sharp));
  std::vector<Index> marked;
  for (const auto part : {&certify::BoundComponents::body, &certify::BoundComponents::contact})
  {
    const std::vector<double> eta = values(cells, part);
    if (size(eta) < small_part * bound) continue;
    const std::vector<Index> own = mark_one(eta, options, markers);
    std::vector<Index> both;
    std::ranges::set_union(marked, own, std::back_inserter(both));
    marked = std::move(both);
  }
  return marked;
}

std::vector<Index> mark(std::span<const double> squares, const MarkingOptions& options,
                        const Markers& markers)
{
  if (options.strategy == Marking::uniform) return mark_all(squares.size());
  std::vector<double> eta(squares.begin(), squares.end());
  for (double& x : eta) x = std::sqrt(x);
  return mark_one(eta, options, markers);
}

}  // namespace tribound::adapt
