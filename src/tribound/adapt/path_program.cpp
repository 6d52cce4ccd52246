#include "tribound/adapt/path_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tribound/adapt/process_zone.h"

namespace tribound::adapt
{

namespace
{

constexpr double smallest = 1.0 / 1024;  ///< step of a stage, relative to its first
constexpr double peak_accuracy = 1e-3;   ///< of t at a peak, relative

/// C at the last step of a path.
template <int dim>
double value_at(const LoadPath<dim>& path, const PathMeasure<dim>& measure)
{
  return measure.value(path.last()->at->discrete.form, path.last()->level.u);
}

/// A stage: the growing quantity, its increment, and when to end.
template <int dim>
struct Stage
{
  const char* name;
  const std::vector<Gauge>* gauges;  ///< null: the damage grows
  PathMeasure<dim> measure;
  double step;
  double until;  ///< value of the measure
  /// Integral of D at which the main stage ends; t_min ends it, too. Absent for PathProgram::then.
  std::optional<double> enough_damage{};
};

template <int dim>
class Follower
{
 public:
  using Observer = typename LoadPath<dim>::Observer;
  using Position = typename LoadPath<dim>::Position;

  Follower(LoadPath<dim>& path, const PathProgram& program, const Observer& observer,
           const StepObserver& newton, PathProgress<dim>& progress, const StepRefiner<dim>& refine)
      : path_(path),
        program_(program),
        observer_(observer),
        newton_(newton),
        refine_(refine),
        progress_(progress)
  {
    for (std::size_t i = 1; i < program.targets.size(); ++i)
      largest_change_ = std::max(largest_change_, std::abs(program.targets[i] - program.targets[i - 1]));
  }

  PathEnd run()
  {
    PathEnd& end = progress_.end;
    if (progress_.stage == PathStage::load)
    {
      by_load();
      if (!end.failure.empty() || program_.following == Following::load) return end;
      const std::optional<double>& failed = progress_.failed;
      const double last = path_.last()->t;
      progress_.direction =
          failed.value_or(last) - (failed ? last : path_.position().before_last.t) < 0 ? -1 : 1;
      const bool under_control = program_.following != Following::automatic || failed;
      begin(under_control ? PathStage::main : PathStage::then);
    }
    if (progress_.stage == PathStage::main)
    {
      end_stage(go(main_stage()));
      if (!end.failure.empty()) return end;
      begin(PathStage::then);
    }
    if (program_.then) end_stage(go(stage_of(*program_.then)));
    return end;
  }

 private:
  [[nodiscard]] const contact::NitscheForm<dim>& form() const { return path_.last()->at->discrete.form; }

  void by_load();
  void begin(PathStage stage)
  {
    progress_.stage = stage;
    progress_.steps = progress_.cuts = 0;
    progress_.size.reset();
    progress_.last_increment = 0;
    progress_.positions.clear();
  }
  [[nodiscard]] Stage<dim> main_stage() const;
  [[nodiscard]] Stage<dim> stage_of(const DisplacementStage& stage) const
  {
    return {"displacement", &stage.gauges, measure_of(stage.gauges), stage.step, stage.until};
  }
  [[nodiscard]] PathMeasure<dim> measure_of(const std::vector<Gauge>& gauges) const
  {
    return PathMeasure<dim>(functional<dim>(form(), gauges));
  }
  [[nodiscard]] std::string go(Stage<dim> stage);
  void end_stage(std::string failure);
  [[nodiscard]] std::string step(const Stage<dim>& stage, const Control<dim>& control);
  [[nodiscard]] bool is_over(const Stage<dim>& stage, double now) const;
  void committed(const Stage<dim>& stage, double size);
  [[nodiscard]] Control<dim> control(const Stage<dim>& stage, double increment) const
  {
    return {.name = stage.name,
            .measure = stage.measure,
            .increment = increment,
            .largest_change = largest_change_};
  }
  /// The step with the largest t.
  struct Summit
  {
    double t;
    double fall;    ///< drop of t in the step after it
    Position from;  ///< the previous step, or where the search began
  };
  void look_for_peak(const Stage<dim>& stage, double size);
  [[nodiscard]] std::optional<Summit> summit_with(const Stage<dim>& stage, double size, double end,
                                                  const Position& from);

  LoadPath<dim>& path_;
  const PathProgram& program_;
  const Observer& observer_;
  const StepObserver& newton_;
  const StepRefiner<dim>& refine_;
  double largest_change_ = 0;  ///< of t, between neighbours in the list
  PathProgress<dim>& progress_;
};

template <int dim>
void Follower<dim>::by_load()
{
  const bool is_automatic = program_.following == Following::automatic;
  PathEnd& end = progress_.end;
  std::size_t& i = progress_.target;
  while (i < program_.targets.size() && end.failure.empty() && !progress_.failed)
  {
    const double t = program_.targets[i];
    const auto committed = [&](const LoadStep<dim>& step)
    {
      if (step.t == t) ++i;
      if (refine_) refine_(progress_.positions);
      if (observer_) observer_(*path_.last());
    };
    end.failure = path_.advance(t, committed, newton_, !is_automatic, progress_.load);
    if (end.failure.empty() || !is_automatic || i < 2 || !path_.interruption().empty()) continue;
    progress_.failed = t;
    end.failure.clear();
    end.dropped.assign(program_.targets.begin() + static_cast<std::ptrdiff_t>(i), program_.targets.end());
  }
  if (!end.failure.empty() && is_automatic && path_.interruption().empty())
    end.failure += "; to go on by damage takes two load steps before: smaller history.steps";
}

template <int dim>
Stage<dim> Follower<dim>::main_stage() const
{
  const double measure = bonded_measure(form());
  const double enough = program_.enough_damage * measure;
  Stage<dim> stage{.name = "damage",
                   .gauges = nullptr,
                   .measure = {},
                   .step = program_.damage_step.value_or(measure / program_.damage_steps),
                   .until = enough,
                   .enough_damage = {}};
  if (program_.following == Following::displacement) stage = stage_of(program_.displacement);
  stage.enough_damage = measure > 0 ? enough : std::numeric_limits<double>::infinity();
  return stage;
}

/// Whether the measure, with value `now`, has reached its target, or damage or t have.
template <int dim>
bool Follower<dim>::is_over(const Stage<dim>& stage, double now) const
{
  constexpr double margin = 1e-9;
  const double left = (stage.until - now) * (stage.step < 0 ? -1 : 1);
  if (left <= margin * std::abs(stage.step)) return true;
  if (!stage.enough_damage) return false;
  const bool has_fallen =
      program_.t_min && progress_.end.peak && progress_.direction * (path_.last()->t - *program_.t_min) <= 0;
  return has_fallen || value_at(path_, PathMeasure<dim>()) >= *stage.enough_damage;
}

/// Returns why the stage failed; empty on success.
template <int dim>
std::string Follower<dim>::go(Stage<dim> stage)
{
  if (!progress_.size) progress_.size = stage.step;
  double& size = *progress_.size;
  if (const double now = value_at(path_, stage.measure);
      progress_.steps == 0 && (stage.until - now) * stage.step < 0 && !stage.enough_damage)
    return fmt::format("the stage by {} is to go on until {:.6g}, and begins at {:.6g}", stage.name,
                       stage.until, now);
  while (progress_.steps < program_.max_steps)
  {
    const double now = value_at(path_, stage.measure);
    if (is_over(stage, now)) return {};
    Control<dim> control = this->control(stage, size);
    if (std::abs(size) > std::abs(stage.until - now)) control.increment = stage.until - now;
    control.last_increment = progress_.last_increment;
    control.cuts = progress_.cuts;
    if (progress_.steps == 0) control.failed = progress_.failed;
    progress_.positions.push_back(path_.position());
    const std::shared_ptr<const LoadStep<dim>> before = path_.last();
    std::string failure = step(stage, control);
    if (failure.empty())
    {
      if (refine_) refine_(progress_.positions);
      if (stage.gauges != nullptr && path_.last()->at->discrete.grid != before->at->discrete.grid)
        stage.measure = measure_of(*stage.gauges);  // its coefficients belong to degrees of freedom
      ++progress_.steps;
      progress_.cuts = 0;
      progress_.last_increment = value_at(path_, stage.measure) - now;
      const bool was_easy = static_cast<int>(path_.last()->level.steps.size()) <= path_.options().few_steps;
      if (was_easy && std::abs(size) < std::abs(stage.step))
      {
        const double larger = path_.options().growth * size;
        size = std::abs(larger) < std::abs(stage.step) ? larger : stage.step;
      }
      committed(stage, control.increment);
      if (observer_) observer_(*path_.last());
    }
    else if (!path_.interruption().empty() ||
             std::abs(control.increment) / 2 < smallest * std::abs(stage.step))
      return failure;
    else
    {
      progress_.positions.pop_back();
      size = control.increment / 2;
      ++progress_.cuts;
    }
  }
  progress_.end.notes.push_back(
      fmt::format("the stage by {} ended after {} steps, history.stop.steps, at t = {:.9g}", stage.name,
                  program_.max_steps, path_.last()->t));
  return {};
}

/// Returns why there is no step; empty on success.
template <int dim>
std::string Follower<dim>::step(const Stage<dim>& stage, const Control<dim>& control)
{
  std::string failure = path_.follow(control, {}, newton_);
  if (failure.empty() || stage.gauges != nullptr || !path_.interruption().empty()) return failure;
  return follow_zone(path_, control, {}, newton_) ? std::string() : failure;
}

/// Where a structure slides as a whole, there may be no equilibrium nearby. Beyond the peak the path then
/// ends there, and the steps so far remain valid. Before the peak this is a failure.
template <int dim>
void Follower<dim>::end_stage(std::string failure)
{
  PathEnd& end = progress_.end;
  const bool has_fallen = end.peak && progress_.direction * (end.peak->t - path_.last()->t) >
                                          peak_accuracy * std::abs(end.peak->t);
  if (failure.empty() || !has_fallen || !path_.interruption().empty())
  {
    end.failure = std::move(failure);
    return;
  }
  end.notes.push_back(
      fmt::format("the path ends beyond its peak, with {:.3g} % of the bonds open or slipping: {}",
                  100 * moving_share(*path_.last()), failure));
}

/// Called after a step from the last of the positions.
template <int dim>
void Follower<dim>::committed(const Stage<dim>& stage, double size)
{
  constexpr double rounding = 1e-9;
  std::vector<Position>& positions = progress_.positions;
  if (positions.size() > 2) positions.erase(positions.begin());
  const double t = positions.back().last->t;
  const double fall = progress_.direction * (t - path_.last()->t);
  const std::optional<Peak>& peak = progress_.end.peak;
  const bool is_highest = !peak || progress_.direction * (t - peak->t) > 0;
  if (is_highest && fall > rounding * std::max(std::abs(t), largest_change_)) look_for_peak(stage, size);
}

/// Locates the peak that the last step has passed.
template <int dim>
void Follower<dim>::look_for_peak(const Stage<dim>& stage, double size)
{
  constexpr int max_halvings = 8;
  const LoadStep<dim>& highest = *progress_.positions.back().last;
  progress_.end.peak = Peak{.t = highest.t, .number = highest.number, .change = {}, .step = size};
  Peak& peak = *progress_.end.peak;
  const double end = value_at(path_, stage.measure);
  std::optional<Summit> summit = Summit{highest.t, 0, progress_.positions.front()};
  for (int i = 0; i < max_halvings; ++i)
  {
    summit = summit_with(stage, peak.step / 2, end, summit->from);
    if (!summit) return;
    peak.change = summit->t - peak.t;
    peak.t = summit->t;
    peak.step /= 2;
    if (std::max(std::abs(*peak.change), summit->fall) <= peak_accuracy * std::abs(peak.t)) return;
  }
}

/// The highest step on the path from `from` to the value `end` of the measure, with steps of this size.
template <int dim>
auto Follower<dim>::summit_with(const Stage<dim>& stage, double size, double end, const Position& from)
    -> std::optional<Summit>
{
  LoadPath<dim> beside = path_;
  beside.ask_for({});
  beside.go_back(from);
  Summit summit{from.last->t, 0, from};
  Control<dim> control = this->control(stage, size);
  double left = std::abs(end - value_at(beside, stage.measure));
  for (; left > 0.5 * std::abs(size); left -= std::abs(size))
  {
    const Position before = beside.position();
    if (!beside.follow(control, {}, newton_).empty()) return std::nullopt;
    control.last_increment = size;
    summit.fall = progress_.direction * (summit.t - beside.last()->t);
    if (summit.fall > 0) return summit;
    summit = {beside.last()->t, 0, before};
  }
  return std::nullopt;
}

}  // namespace

template <int dim>
PathEnd follow(LoadPath<dim>& path, const PathProgram& program,
               const typename LoadPath<dim>::Observer& observer, const StepObserver& newton,
               PathProgress<dim>& progress, const StepRefiner<dim>& refine)
{
  return Follower<dim>(path, program, observer, newton, progress, refine).run();
}

template PathEnd follow(LoadPath<2>&, const PathProgram&, const LoadPath<2>::Observer&, const StepObserver&,
                        PathProgress<2>&, const StepRefiner<2>&);
template PathEnd follow(LoadPath<3>&, const PathProgram&, const LoadPath<3>::Observer&, const StepObserver&,
                        PathProgress<3>&, const StepRefiner<3>&);

}  // namespace tribound::adapt
