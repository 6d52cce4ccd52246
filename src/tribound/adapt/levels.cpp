#include "tribound/adapt/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "tribound/adapt/finer.h"
#include "tribound/base/clock.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/support/rigid_motion.h"

namespace tribound::adapt
{

namespace
{

/// The data error allowed on the next mesh, as a fraction of the bound on the previous one.
constexpr double share_of_data = 0.01;

constexpr const char* out_of_memory = "out of memory";

/// Thrown out of Newton's method when the user wants the run to stop.
struct Interrupted
{
};

template <int dim>
std::int64_t free_dofs(const Discretisation<dim>& discrete)
{
  return fem::n_free_dofs(discrete.space, discrete.form.constraints());
}

}  // namespace

template <int dim>
Levels<dim>::Levels(const problem::Problem<dim>& problem, const Method& method, double tolerance,
                    std::unique_ptr<Discretisation<dim>> first, const std::atomic<bool>* stop,
                    std::shared_ptr<const mesh::Mesh<dim>> whole)
    : problem_(problem), method_(method), tolerance_(tolerance), stop_(stop), current_(std::move(first))
{
  if (current_->mesh.partition())
  {
    assert(whole || !current_->mesh.ranks().is_first());
    current_->mesh.ranks().on_first([&]
                                    { contact::check_rigid_motions<dim>(problem_, *whole, method_.degree); });
    ask(whole.get());
  }
  else
    contact::check_rigid_motions(current_->form);
}

template <int dim>
Levels<dim>::Levels(const problem::Problem<dim>& problem, const Method& method, double tolerance,
                    std::unique_ptr<Discretisation<dim>> first, const LevelStart& start,
                    std::vector<double> u, const std::atomic<bool>* stop,
                    std::shared_ptr<const mesh::Mesh<dim>> whole)
    : problem_(problem),
      method_(method),
      tolerance_(tolerance),
      stop_(stop),
      number_(start.level - 1),
      current_(std::move(first)),
      start_(std::move(u)),
      accuracy_(start.accuracy),
      expected_(start.expected),
      is_likely_last_(start.is_likely_last)
{
  level_.delta = start.delta;
  level_.friedrichs = start.friedrichs;
  if (current_->mesh.partition() && !level_.friedrichs) ask(whole.get());
}

template <int dim>
void Levels<dim>::ask(const mesh::Mesh<dim>* whole)
{
  level_.friedrichs =
      current_->mesh.ranks().on_first([&] { return certify::friedrichs_constant<dim>(problem_, *whole); });
}

template <int dim>
std::string Levels<dim>::advance(const StepObserver& observer, bool is_last)
{
  const Clock::time_point begin = Clock::now();
  std::string why = try_to_advance(observer, is_last);
  if (!why.empty())
  {
    current_ = std::move(discrete_before_);
    start_.clear();
    expected_.reset();
    is_likely_last_ = false;
  }
  seconds_ = (why.empty() ? 0 : seconds_) + std::exchange(seconds_of_next_, 0) + seconds_since(begin);
  return why;
}

template <int dim>
std::string Levels<dim>::try_to_advance(const StepObserver& observer, bool is_last)
{
  std::string why;
  std::optional<CertifiedLevel<dim>> level = solve(observer, is_last, why);
  if (!level) return why;
  certify::Verdict verdict = judge(*level);
  if (discrete_before_ && !certify::is_bound(verdict.status))
    return fmt::format("this is level {}, level {} failed: {}", number_, number_ + 1, verdict.reason);
  ++number_;
  level_ = std::move(*level);
  has_stress_ = true;
  verdict_ = std::move(verdict);
  discrete_before_.reset();
  return {};
}

template <int dim>
std::optional<CertifiedLevel<dim>> Levels<dim>::solve_to_the_end(const StepObserver& observer) const
{
  if (!method_.stopping.finish || method_.stopping.criterion != Stopping::adaptive || method_.regularisation)
    return std::nullopt;
  Method method = method_;
  method.stopping.criterion = Stopping::last_bounded;
  try
  {
    CertifiedLevel<dim> level = solve_and_certify<dim>(current_->form, start_, method, observer, level_.delta,
                                                       expected_, level_.friedrichs);
    if (level.converged && bound_holds(level)) return level;
  }
  catch (const SolveError& error)  // the criterion may accept an earlier iterate
  {
    require_all_failed(current_->mesh.ranks(), error.what());
  }
  return std::nullopt;
}

template <int dim>
std::optional<CertifiedLevel<dim>> Levels<dim>::solve(const StepObserver& observer, bool is_last,
                                                      std::string& why) const
{
  const bool is_first = !discrete_before_;
  const auto failed = [&](const char* problem)
  { return fmt::format("this is level {}, level {} failed: {}", number_, number_ + 1, problem); };
  try
  {
    const StepObserver watching = watch(observer, !is_first);
    std::optional<CertifiedLevel<dim>> level;
    if (is_last || is_likely_last_) level = solve_to_the_end(watching);
    if (!level)
      level = solve_and_certify<dim>(current_->form, start_, method_, watching, level_.delta, expected_,
                                     level_.friedrichs);
    level->refinement = refinement_;
    return level;
  }
  catch (const Interrupted&)
  {
    why = fmt::format("interrupted, this is level {}", number_);
  }
  catch (const SolveError& error)
  {
    if (is_first) throw;
    require_all_failed(current_->mesh.ranks(), error.what());
    why = failed(error.what());
  }
  catch (const std::bad_alloc&)
  {
    if (is_first) throw;
    require_all_failed(current_->mesh.ranks(), out_of_memory);
    why = failed(out_of_memory);
  }
  return std::nullopt;
}

template <int dim>
certify::Verdict Levels<dim>::judge(const CertifiedLevel<dim>& level) const
{
  if (!level.solved()) return {certify::RunStatus::failed, level.failure};
  certify::Verdict verdict = certify::judge(level.estimate, level.identities, level.norms, tolerance_);
  if (level.tightened && !certify::is_bound(verdict.status))
    verdict.reason +=
        "; solving the systems again to rounding accuracy (solver.tolerance = 0) did not help: check for "
        "materials of very different stiffness, nu near 0.5 and very flat cells";
  return verdict;
}

template <int dim>
StepObserver Levels<dim>::watch(const StepObserver& observer, bool interruptible) const
{
  return [this, &observer, interruptible](const CertifiedStep& step)
  {
    if (observer) observer(step);
    if (interruptible && interrupted()) throw Interrupted{};
  };
}

template <int dim>
bool Levels<dim>::finish(const StepObserver& observer)
{
  if (!method_.stopping.finish || level_.converged || !certify::is_bound(verdict_.status) || interrupted())
    return false;
  const Clock::time_point begin = Clock::now();
  const auto attempt = [&]() -> std::optional<CertifiedLevel<dim>>
  {
    try
    {
      return converge<dim>(current_->form, level_, method_, watch(observer, true));
    }
    catch (const Interrupted&)
    {
    }
    catch (const SolveError& error)
    {
      require_all_failed(current_->mesh.ranks(), error.what());
    }
    catch (const std::bad_alloc&)
    {
      require_all_failed(current_->mesh.ranks(), out_of_memory);
    }
    return std::nullopt;
  };
  std::optional<CertifiedLevel<dim>> converged = attempt();
  seconds_ += seconds_since(begin);
  if (!converged) return false;
  certify::Verdict verdict = judge(*converged);
  if (verdict_.status == certify::RunStatus::certified && verdict.status != certify::RunStatus::certified)
    return false;
  level_ = std::move(*converged);
  has_stress_ = true;
  verdict_ = std::move(verdict);
  return true;
}

template <int dim>
bool Levels<dim>::restore_stress()
{
  if (has_stress_) return true;
  try
  {
    certify_again<dim>(current_->form, method_, level_);
  }
  catch (const std::bad_alloc&)
  {
    require_all_failed(current_->mesh.ranks(), out_of_memory);
    return false;
  }
  has_stress_ = true;
  return true;
}

template <int dim>
certify::EnergyBound Levels<dim>::energy_or_reason()
{
  const bool is_bound = certify::is_bound(verdict_.status);
  if (is_bound && interrupted())
    return certify::no_energy_bound<dim>(current_->form, level_.u, quantities_, "interrupted");
  const ScopedTimer timer(level_.certify_seconds, level_.certify_cpu);
  if (is_bound && level_.converged)
    level_.equilibrium.reset();  // factors, for finish(), take most of the memory
  return error_bars<dim>(current_->form, method_, level_, verdict_, quantities_);
}

template <int dim>
bool Levels<dim>::bound_energy()
{
  const bool is_wanted = bars_.levels != EnergyLevels::off && level_.solved() && !level_.energy;
  const Clock::time_point begin = Clock::now();
  if (!is_wanted || !restore_stress()) return false;
  level_.energy = energy_or_reason();
  if (verdict_.status == certify::RunStatus::certified)
    if (std::string why = unmet(bars_, *level_.energy, std::sqrt(level_.norms.energy)); !why.empty())
      verdict_ = {certify::RunStatus::budget, std::move(why)};
  seconds_ += seconds_since(begin);
  return true;
}

namespace
{

/// A bound of this part of the tolerance is expected to meet it.
constexpr double likely = 0.9;

/// The mesh after this one, if it grows by two thirds of the factor at least.
NextMesh one_more(NextMesh mesh)
{
  mesh.growth *= 2.0 / 3.0;
  mesh.cells = static_cast<std::int64_t>(static_cast<double>(mesh.cells) * mesh.growth);
  mesh.dofs = static_cast<std::int64_t>(static_cast<double>(*mesh.dofs) * mesh.growth);
  return mesh;
}

}  // namespace

template <int dim>
std::string Levels<dim>::refine(const Marker<dim>& mark, const MeshLimit& limit)
{
  assert(has_stress_);
  const Clock::time_point begin = Clock::now();
  std::string why;
  try
  {
    why = try_to_refine(mark, limit);
  }
  catch (const std::bad_alloc&)
  {
    require_all_failed(current_->mesh.ranks(), out_of_memory);
    why = "out of memory for the next mesh";
  }
  (why.empty() ? seconds_of_next_ : seconds_) += seconds_since(begin);
  return why;
}

template <int dim>
std::string Levels<dim>::try_to_refine(const Marker<dim>& mark, const MeshLimit& limit)
{
  Clock::time_point begin = Clock::now();
  const auto lap = [&] { return seconds_since(std::exchange(begin, Clock::now())); };
  const std::vector<Index> marked = mark(view());
  const Finer<dim> finer = finer_mesh<dim>(current_->space, {level_.u}, marked, {.twins = current_->twins()});
  RefinementSeconds seconds{.bisect = lap()};
  NextMesh is_next{.cells = finer.n_cells, .ranks = current_->mesh.ranks()};
  if (limit)
    if (std::string why = limit(is_next); !why.empty()) return why;
  mesh::Mesh<dim> mesh = finer.mesh();
  seconds.bisect += lap();
  accuracy_ = share_of_data * level_.estimate.total_sharp;
  auto next = std::make_shared<const Discretisation<dim>>(std::move(mesh), problem_, method_,
                                                          contact::DataAccuracy{.absolute = accuracy_});
  seconds.discretise = lap();
  is_next.dofs = free_dofs(*next);
  is_next.growth = static_cast<double>(*is_next.dofs) /
                   static_cast<double>(std::max(std::int64_t{1}, free_dofs(*current_)));
  if (limit)
    if (std::string why = limit(is_next); !why.empty()) return why;
  start_ = std::move(finer.carry(next->space).front());
  seconds.transfer = lap();
  refinement_ = seconds;
  const double falls_to = std::pow(is_next.growth, -1.0 * method_.degree / dim);
  expected_ = level_.estimate.global.discretisation() * falls_to;
  const bool meets_tolerance =
      level_.estimate.total_sharp * falls_to <= likely * tolerance_ * level_.norms.sigma;
  is_likely_last_ = meets_tolerance || (limit && !limit(one_more(is_next)).empty());
  has_stress_ = false;
  level_.stress = {};
  level_.estimate = {};
  level_.equilibrium = {};
  discrete_before_ = std::exchange(current_, std::move(next));
  return {};
}

template class Levels<2>;
template class Levels<3>;

}  // namespace tribound::adapt
