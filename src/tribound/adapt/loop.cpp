#include "tribound/adapt/loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/adapt/mark.h"
#include "tribound/base/clock.h"
#include "tribound/base/error.h"
#include "tribound/base/memory.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bisect.h"

namespace tribound::adapt
{

namespace
{

constexpr double gigabyte = 1e9;

/// Of the bound on the mesh before: what the data may leave out of the next one.
constexpr double share_of_data = 0.01;

/// Thrown out of Newton's method when the user wants the run to end.
struct Interrupted
{
};

/// The loop with what it carries from level to level.
template <int dim>
class Loop
{
 public:
  Loop(const problem::Problem<dim>& problem, const Method& method, const AdaptOptions& options,
       const LoopObserver<dim>& observer, const std::atomic<bool>& stop)
      : problem_(problem), method_(method), options_(options), observer_(observer), stop_(stop)
  {
  }

  certify::Verdict run(std::unique_ptr<Discretisation<dim>> first)
  {
    current_ = std::move(first);
    for (number_ = 0;; ++number_)
    {
      std::optional<CertifiedLevel<dim>> level = solve();
      if (!level) return ended_;
      certify::Verdict verdict = judge_level(*level);
      if (number_ > 0 && !holds(verdict)) return certificate_of_the_level_before(verdict.reason);
      last_ = std::move(verdict);
      std::string limit = limit_reached();
      const bool is_last = last_.status != certify::RunStatus::budget || !limit.empty();
      if (is_last) finish(*level);
      tell(*level);
      if (!is_last)
      {
        limit = go_on_to_finer_mesh(*level);
        if (!limit.empty() && finish(*level)) tell(*level);
      }
      if (last_.status != certify::RunStatus::budget || !limit.empty()) return used_up(limit);
      level->stress = {};
      level->estimate = {};
      before_ = std::move(*level);
    }
  }

 private:
  static bool holds(const certify::Verdict& verdict)
  {
    return verdict.status == certify::RunStatus::certified || verdict.status == certify::RunStatus::budget;
  }
  /// The verdict on the last level; where it is `budget`, the limit that ended the run.
  [[nodiscard]] certify::Verdict used_up(const std::string& limit) const
  {
    if (last_.status != certify::RunStatus::budget) return last_;
    return {certify::RunStatus::budget, last_.reason + "; " + limit};
  }
  /// The certificate of the level before, its last word on it, too.
  [[nodiscard]] certify::Verdict certificate_of_the_level_before(const std::string& problem);

  void tell(const CertifiedLevel<dim>& level)
  {
    observer_.level({number_, *current_, level, last_, seconds_since(level_begin_), current_});
    level_begin_ = Clock::now();
  }
  /// Lets Newton's method converge on the last level, as far as it does so without harm; whether it has
  /// changed anything.
  bool finish(CertifiedLevel<dim>& level);

  /// Passes the steps on, and ends Newton's method when the user wants it to end and it may.
  [[nodiscard]] StepObserver watch(bool interruptible) const;
  /// Nothing if the level did not end; ended_ says why.
  std::optional<CertifiedLevel<dim>> solve();
  [[nodiscard]] certify::Verdict judge_level(const CertifiedLevel<dim>& level) const;
  [[nodiscard]] std::string limit_reached() const;
  /// refine(), which may find that there is not the memory for it.
  [[nodiscard]] std::string go_on_to_finer_mesh(const CertifiedLevel<dim>& level)
  {
    try
    {
      return refine(level);
    }
    catch (const std::bad_alloc&)
    {
      return "out of memory for the next mesh";
    }
  }
  /// Marks, bisects and carries the solution; or names the limit that the finer mesh would exceed.
  [[nodiscard]] std::string refine(const CertifiedLevel<dim>& level);
  /// The limit that a mesh with `growth` times as many unknowns would exceed, or nothing.
  [[nodiscard]] std::string memory_limit_reached(double growth) const;

  const problem::Problem<dim>& problem_;
  const Method& method_;
  const AdaptOptions& options_;
  const LoopObserver<dim>& observer_;
  const std::atomic<bool>& stop_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point level_begin_ = begin_;
  const double memory_before_ = peak_memory();
  int number_ = 0;
  std::shared_ptr<const Discretisation<dim>> current_;
  std::vector<double> start_;  ///< the solution of the level before, on the current mesh
  double delta_ = 0;           ///< of the regularised variant after the level before
  RefinementSeconds refinement_;
  std::optional<certify::FriedrichsConstant> friedrichs_;  ///< of the mesh on which it was first needed
  std::optional<double> expected_;  ///< BoundComponents::discretisation() on the current mesh, guessed
  CertifiedLevel<dim> before_;      ///< the level before, without stress and estimate
  std::shared_ptr<const Discretisation<dim>> discrete_before_;
  certify::Verdict last_{certify::RunStatus::failed, {}};
  certify::Verdict ended_{certify::RunStatus::failed, {}};
};

template <int dim>
std::optional<CertifiedLevel<dim>> Loop<dim>::solve()
{
  try
  {
    CertifiedLevel<dim> level = solve_and_certify<dim>(current_->form, start_, method_, watch(number_ > 0),
                                                       delta_, expected_, friedrichs_);
    friedrichs_ = level.friedrichs;
    level.refinement = refinement_;
    return level;
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
  catch (const std::bad_alloc&)
  {
    if (number_ == 0) throw;
    ended_ = certificate_of_the_level_before("out of memory");
  }
  return std::nullopt;
}

template <int dim>
certify::Verdict Loop<dim>::judge_level(const CertifiedLevel<dim>& level) const
{
  if (!level.solved()) return {certify::RunStatus::failed, level.failure};
  certify::Verdict verdict =
      certify::judge(level.estimate, level.identities, method_.degree, level.norms, options_.tolerance);
  if (level.tightened && !holds(verdict))
    verdict.reason +=
        "; solving the systems anew as far as rounding lets them be, with solver.tolerance = 0, did not mend "
        "it: are materials of very different stiffness, nu near 0.5 or very flat cells involved?";
  return verdict;
}

template <int dim>
StepObserver Loop<dim>::watch(bool interruptible) const
{
  return [this, interruptible](const CertifiedStep& step)
  {
    if (observer_.step) observer_.step(step);
    if (stop_ && interruptible) throw Interrupted{};
  };
}

template <int dim>
bool Loop<dim>::finish(CertifiedLevel<dim>& level)
{
  if (!method_.stopping.finish || level.converged || !holds(last_) || stop_) return false;
  const auto attempt = [&]() -> std::optional<CertifiedLevel<dim>>
  {
    try
    {
      return converge<dim>(current_->form, level, method_, watch(true));
    }
    catch (const Interrupted&)
    {
    }
    catch (const SolveError&)
    {
    }
    catch (const std::bad_alloc&)
    {
    }
    return std::nullopt;
  };
  std::optional<CertifiedLevel<dim>> converged = attempt();
  if (!converged) return false;
  certify::Verdict verdict = judge_level(*converged);
  if (last_.status == certify::RunStatus::certified && verdict.status != certify::RunStatus::certified)
    return false;
  level = std::move(*converged);
  last_ = std::move(verdict);
  return true;
}

template <int dim>
certify::Verdict Loop<dim>::certificate_of_the_level_before(const std::string& problem)
{
  const std::string limit =
      fmt::format("this is level {}, level {} failed: {}", number_ - 1, number_, problem);
  --number_;
  current_ = std::move(discrete_before_);
  if (finish(before_)) tell(before_);
  return used_up(limit);
}

template <int dim>
std::string Loop<dim>::limit_reached() const
{
  if (stop_) return "interrupted";
  if (number_ >= options_.max_levels)
    return fmt::format("adapt.max_levels = {} is reached", options_.max_levels);
  if (options_.max_time && seconds_since(begin_) >= *options_.max_time)
    return fmt::format("adapt.max_time = {:g} s is used up", *options_.max_time);
  return {};
}

template <int dim>
std::string Loop<dim>::refine(const CertifiedLevel<dim>& level)
{
  Clock::time_point begin = Clock::now();
  const auto lap = [&] { return seconds_since(std::exchange(begin, Clock::now())); };
  mesh::Bisected<dim> finer = mesh::bisect<dim>(current_->mesh, mark(level.estimate.cells, options_.marking));
  refinement_.bisect = lap();
  if (options_.max_cells && finer.mesh.n_cells() > *options_.max_cells)
    return fmt::format("the next mesh has {} cells, more than adapt.max_cells = {}", finer.mesh.n_cells(),
                       *options_.max_cells);
  auto next = std::make_shared<const Discretisation<dim>>(
      std::move(finer.mesh), problem_, method_,
      contact::DataAccuracy{.absolute = share_of_data * level.estimate.total_sharp});
  refinement_.discretise = lap();
  const long dofs = next->space.n_dofs() - next->form.constraints().n_fixed();
  if (dofs > options_.max_dofs)
    return fmt::format("the next mesh has {} degrees of freedom, more than adapt.max_dofs = {}", dofs,
                       options_.max_dofs);
  const int fixed = current_->form.constraints().n_fixed();
  const double growth = static_cast<double>(dofs) / std::max(1, current_->space.n_dofs() - fixed);
  if (auto limit = memory_limit_reached(growth); !limit.empty()) return limit;
  delta_ = level.delta;
  expected_ = level.estimate.global.discretisation() * std::pow(growth, -1.0 * method_.degree / dim);
  start_ = fem::nested_interpolant<dim>(current_->space, level.u, finer.parent, next->space);
  refinement_.transfer = lap();
  discrete_before_ = std::exchange(current_, std::move(next));
  return {};
}

template <int dim>
std::string Loop<dim>::memory_limit_reached(double growth) const
{
  const MemoryLimit limit = memory_limit(options_);
  const double expected = expected_memory(memory_before_, peak_memory(), growth, dim);
  if (limit.bytes == 0 || expected <= limit.bytes) return {};
  return fmt::format("the next mesh is expected to take {:.3g} GB, more than {} = {:.3g} GB",
                     expected / gigabyte, limit.from_case ? "adapt.max_memory" : "nine tenths of the machine",
                     limit.bytes / gigabyte);
}

}  // namespace

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
certify::Verdict adapt(const problem::Problem<dim>& problem, const Method& method,
                       const AdaptOptions& options, std::unique_ptr<Discretisation<dim>> first,
                       const LoopObserver<dim>& observer, const std::atomic<bool>& stop)
{
  return Loop<dim>(problem, method, options, observer, stop).run(std::move(first));
}

template certify::Verdict adapt(const problem::Problem<2>&, const Method&, const AdaptOptions&,
                                std::unique_ptr<Discretisation<2>>, const LoopObserver<2>&,
                                const std::atomic<bool>&);
template certify::Verdict adapt(const problem::Problem<3>&, const Method&, const AdaptOptions&,
                                std::unique_ptr<Discretisation<3>>, const LoopObserver<3>&,
                                const std::atomic<bool>&);

}  // namespace tribound::adapt
