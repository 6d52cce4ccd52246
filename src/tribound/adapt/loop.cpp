#include "tribound/adapt/loop.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tribound/base/clock.h"
#include "tribound/base/memory.h"
#include "tribound/mesh/partition.h"

namespace tribound::adapt
{

namespace
{

constexpr double gigabyte = 1e9;

/// The limit that a mesh with `growth` times as many unknowns would exceed, or nothing.
std::string memory_limit_reached(const AdaptOptions& options, double before, const NextMesh& next, int dim)
{
  MemoryLimit limit = memory_limit(options);
  limit.bytes = -next.ranks.max(-limit.bytes);  // the most restricted machine decides
  const double expected =
      next.ranks.max(next.ranks.sum_on_machine(expected_memory(before, peak_memory(), next.growth, dim)));
  if (limit.bytes == 0 || expected <= limit.bytes) return {};
  return fmt::format("the next mesh is expected to take {:.3g} GB, more than {} = {:.3g} GB",
                     expected / gigabyte, limit.from_case ? "adapt.max_memory" : "nine tenths of the machine",
                     limit.bytes / gigabyte);
}

}  // namespace

template <int dim>
Strategy<dim> make_strategy(const AdaptOptions& options, const std::atomic<bool>* interrupt)
{
  Strategy<dim> strategy;
  strategy.mark = [options](const LevelView<dim>& view)
  {
    const mesh::Mesh<dim>& mesh = view.discrete.mesh;
    const Ranks& ranks = mesh.ranks();
    Markers markers{ranks, {}};
    if (mesh.partition()) markers.names = mesh.partition()->names;
    const bool is_steered = options.measure == ErrorMeasure::energy || !options.bars.goal.empty();
    if (const std::span<const double> shares = shares_of_cells(options.bars, view.level.energy);
        is_steered && ranks.any(!shares.empty()))
      if (std::vector<Index> marked = mark(shares, options.marking, markers); ranks.any(!marked.empty()))
        return marked;
    return mark(view.level.estimate.cells, options.marking, markers);
  };
  strategy.stop = [options, interrupt, begin = Clock::now()](const LevelView<dim>& view) -> std::string
  {
    const Ranks& ranks = view.discrete.mesh.ranks();
    if (ranks.any(interrupt && *interrupt)) return "interrupted";
    if (view.number >= options.max_levels)
      return fmt::format("adapt.max_levels = {} is reached", options.max_levels);
    if (options.max_time && ranks.first_says(seconds_since(begin) >= *options.max_time))
      return fmt::format("adapt.max_time = {:g} s is used up", *options.max_time);
    return {};
  };
  strategy.last_level = options.max_levels;
  strategy.limit = [options, before = peak_memory()](const NextMesh& next) -> std::string
  {
    if (options.max_cells && next.cells > *options.max_cells)
      return fmt::format("the next mesh has {} cells, more than adapt.max_cells = {}", next.cells,
                         *options.max_cells);
    if (!next.dofs) return {};
    if (*next.dofs > options.max_dofs)
      return fmt::format("the next mesh has {} degrees of freedom, more than adapt.max_dofs = {}", *next.dofs,
                         options.max_dofs);
    return memory_limit_reached(options, before, next, dim);
  };
  return strategy;
}

MemoryLimit memory_limit(const AdaptOptions& options)
{
  constexpr double share_of_machine = 0.9;
  if (options.max_memory) return {*options.max_memory * gigabyte, true};
  return {share_of_machine * machine_memory(), false};
}

double expected_memory(double before, double peak, double growth, int dim)
{
  // Factors of a sparse matrix: n log n in 2D, n^{4/3} in 3D [George73]; everything else is linear.
  const double exponent = dim == 2 ? 1.1 : 4.0 / 3.0;
  return before + (peak - before) * std::pow(growth, exponent);
}

template <int dim>
certify::Verdict adapt(Levels<dim>& levels, const Strategy<dim>& strategy)
{
  const auto tell = [&]
  {
    if (strategy.observer.level) strategy.observer.level(levels.view());
  };
  const auto finish = [&]
  {
    const bool has_converged = levels.finish(strategy.observer.step);
    return levels.bound_energy() || has_converged;
  };
  const auto is_open = [&] { return levels.verdict().status == certify::RunStatus::budget; };
  std::string end;  // why the last level is the last
  for (int number = levels.next_number();; ++number)
  {
    end = levels.advance(strategy.observer.step, number == strategy.last_level);
    const bool told = !end.empty();
    if (!told && levels.bars().on_every_level()) levels.bound_energy();
    if (end.empty() && strategy.stop) end = strategy.stop(levels.view());
    const bool has_changed = (!end.empty() || !is_open()) && finish();
    if (has_changed || !told) tell();
    if (!end.empty() || !is_open()) break;
    end = levels.refine(strategy.mark, strategy.limit);
    if (end.empty())
    {
      if (strategy.observer.refined) strategy.observer.refined(levels);
      continue;
    }
    if (finish()) tell();
    break;
  }
  certify::Verdict verdict = levels.verdict();
  if (verdict.status == certify::RunStatus::budget) verdict.reason += "; " + end;
  return verdict;
}

template <int dim>
certify::Verdict adapt(const problem::Problem<dim>& problem, const Method& method,
                       const AdaptOptions& options, std::unique_ptr<Discretisation<dim>> first,
                       const LoopObserver<dim>& observer, const std::atomic<bool>& interrupt)
{
  Strategy<dim> strategy = make_strategy<dim>(options, &interrupt);
  strategy.observer = observer;
  Levels<dim> levels(problem, method, options.tolerance, std::move(first), &interrupt);
  levels.ask_for(options.bars);
  return adapt(levels, strategy);
}

template Strategy<2> make_strategy(const AdaptOptions&, const std::atomic<bool>*);
template Strategy<3> make_strategy(const AdaptOptions&, const std::atomic<bool>*);
template certify::Verdict adapt(Levels<2>&, const Strategy<2>&);
template certify::Verdict adapt(Levels<3>&, const Strategy<3>&);
template certify::Verdict adapt(const problem::Problem<2>&, const Method&, const AdaptOptions&,
                                std::unique_ptr<Discretisation<2>>, const LoopObserver<2>&,
                                const std::atomic<bool>&);
template certify::Verdict adapt(const problem::Problem<3>&, const Method&, const AdaptOptions&,
                                std::unique_ptr<Discretisation<3>>, const LoopObserver<3>&,
                                const std::atomic<bool>&);

}  // namespace tribound::adapt
