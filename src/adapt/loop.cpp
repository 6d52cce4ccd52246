#include "adapt/loop.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "adapt/mark.h"
#include "base/clock.h"
#include "base/error.h"
#include "fem/nested.h"
#include "mesh/bisect.h"

namespace tribound
{

namespace
{

/// Thrown out of Newton's method when the user wants the run to end.
struct Interrupted
{
};

/// The loop with what it carries from level to level.
template <int dim>
class Loop
{
 public:
  Loop(const Problem<dim>& problem, const Config& config, const LoopObserver<dim>& observer,
       const std::atomic<bool>& stop)
      : problem_(problem), config_(config), observer_(observer), stop_(stop)
  {
  }

  Verdict run(std::unique_ptr<Discretisation<dim>> first)
  {
    current_ = std::move(first);
    for (number_ = 0;; ++number_)
    {
      const std::optional<CertifiedLevel<dim>> level = solve();
      if (!level) return ended_;
      Verdict verdict = judge_level(*level);
      if (number_ > 0 && !holds(verdict)) return certificate_of_the_level_before(verdict.reason);
      observer_.level({number_, *current_, *level, verdict, seconds_since(level_begin_)});
      level_begin_ = Clock::now();
      last_ = verdict;
      if (verdict.status != RunStatus::budget) return verdict;
      if (const auto limit = limit_reached(); !limit.empty()) return used_up(limit);
      if (const auto limit = refine(*level); !limit.empty()) return used_up(limit);
    }
  }

 private:
  static bool holds(const Verdict& verdict)
  {
    return verdict.status == RunStatus::certified || verdict.status == RunStatus::budget;
  }
  [[nodiscard]] Verdict used_up(const std::string& limit) const
  {
    return {RunStatus::budget, last_.reason + "; " + limit};
  }
  [[nodiscard]] Verdict certificate_of_the_level_before(const std::string& problem) const
  {
    return used_up(fmt::format("this is level {}, level {} failed: {}", number_ - 1, number_, problem));
  }

  /// Nothing if the level did not end; ended_ says why.
  std::optional<CertifiedLevel<dim>> solve();
  [[nodiscard]] Verdict judge_level(const CertifiedLevel<dim>& level) const;
  [[nodiscard]] std::string limit_reached() const;
  /// Marks, bisects and carries the solution; or names the limit that the finer mesh would exceed.
  [[nodiscard]] std::string refine(const CertifiedLevel<dim>& level);

  const Problem<dim>& problem_;
  const Config& config_;
  const LoopObserver<dim>& observer_;
  const std::atomic<bool>& stop_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point level_begin_ = begin_;
  int number_ = 0;
  std::unique_ptr<Discretisation<dim>> current_;
  std::vector<double> start_;  ///< the solution of the level before, on the current mesh
  Verdict last_{RunStatus::failed, {}};
  Verdict ended_{RunStatus::failed, {}};
};

template <int dim>
std::optional<CertifiedLevel<dim>> Loop<dim>::solve()
{
  const auto watch = [&](const CertifiedStep& step)
  {
    if (observer_.step) observer_.step(step);
    if (stop_ && number_ > 0) throw Interrupted{};
  };
  try
  {
    return solve_and_certify<dim>(current_->form, start_, config_, watch);
  }
  catch (const Interrupted&)
  {
    ended_ = used_up(fmt::format("interrupted, this is level {}", number_ - 1));
  }
  catch (const SolveError& error)
  {
    if (number_ == 0) throw;
    ended_ = certificate_of_the_level_before(error.what());
  }
  return std::nullopt;
}

template <int dim>
Verdict Loop<dim>::judge_level(const CertifiedLevel<dim>& level) const
{
  if (!level.solved()) return {RunStatus::failed, level.failure};
  return judge(level.estimate, level.identities, config_.degree, level.sigma_norm, config_.adapt.tolerance);
}

template <int dim>
std::string Loop<dim>::limit_reached() const
{
  if (stop_) return "interrupted";
  if (number_ >= config_.adapt.max_levels)
    return fmt::format("adapt.max_levels = {} is reached", config_.adapt.max_levels);
  if (config_.adapt.max_time && seconds_since(begin_) >= *config_.adapt.max_time)
    return fmt::format("adapt.max_time = {:g} s is used up", *config_.adapt.max_time);
  return {};
}

template <int dim>
std::string Loop<dim>::refine(const CertifiedLevel<dim>& level)
{
  std::vector<double> eta;
  eta.reserve(level.estimate.cells.size());
  for (const BoundComponents& cell : level.estimate.cells) eta.push_back(cell.total_sharp());
  Bisected<dim> finer = bisect<dim>(current_->mesh, mark(eta, config_.adapt));
  if (config_.adapt.max_cells && finer.mesh.n_cells() > *config_.adapt.max_cells)
    return fmt::format("the next mesh has {} cells, more than adapt.max_cells = {}", finer.mesh.n_cells(),
                       *config_.adapt.max_cells);
  auto next = std::make_unique<Discretisation<dim>>(std::move(finer.mesh), problem_, config_);
  const long dofs = next->space.n_dofs() - next->form.constraints().n_fixed();
  if (dofs > config_.adapt.max_dofs)
    return fmt::format("the next mesh has {} degrees of freedom, more than adapt.max_dofs = {}", dofs,
                       config_.adapt.max_dofs);
  start_ = nested_interpolant<dim>(current_->space, level.u, finer.parent, next->space);
  current_ = std::move(next);
  return {};
}

}  // namespace

template <int dim>
Verdict adapt(const Problem<dim>& problem, const Config& config, std::unique_ptr<Discretisation<dim>> first,
              const LoopObserver<dim>& observer, const std::atomic<bool>& stop)
{
  return Loop<dim>(problem, config, observer, stop).run(std::move(first));
}

template Verdict adapt(const Problem<2>&, const Config&, std::unique_ptr<Discretisation<2>>,
                       const LoopObserver<2>&, const std::atomic<bool>&);
template Verdict adapt(const Problem<3>&, const Config&, std::unique_ptr<Discretisation<3>>,
                       const LoopObserver<3>&, const std::atomic<bool>&);

}  // namespace tribound
