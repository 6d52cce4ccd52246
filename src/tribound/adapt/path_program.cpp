#include "tribound/adapt/path_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tribound::adapt
{

namespace
{

constexpr double smallest = 1.0 / 1024;  ///< step of a stage, over its first

/// C at the last step of a path.
template <int dim>
double value_at(const LoadPath<dim>& path, const PathMeasure<dim>& measure)
{
  return measure.value(path.last()->at->discrete.form, path.last()->level.u);
}

/// A stage: what grows, by how much, and when it is enough.
template <int dim>
struct Stage
{
  const char* name;
  const std::vector<Gauge>* gauges;  ///< null: it is the damage that grows
  PathMeasure<dim> measure;
  double step;
  double until;  ///< value of the measure
  /// Integral of D at which the main stage ends; t_min ends it, too. Absent of PathProgram::then.
  std::optional<double> enough_damage{};
};

template <int dim>
class Follower
{
 public:
  using Observer = typename LoadPath<dim>::Observer;
  using Position = typename LoadPath<dim>::Position;

  Follower(LoadPath<dim>& path, const PathProgram& program, const Observer& observer,
           const StepObserver& newton, const StepRefiner<dim>& refine)
      : path_(path), program_(program), newton_(newton)
  {
    observer_ = [this, &observer, &refine](const LoadStep<dim>&)
    {
      if (refine) refine(positions_);
      if (observer) observer(*path_.last());
    };
    for (std::size_t i = 1; i < program.targets.size(); ++i)
      largest_change_ = std::max(largest_change_, std::abs(program.targets[i] - program.targets[i - 1]));
  }

  PathEnd run()
  {
    by_load();
    if (!end_.failure.empty() || program_.following == Following::load) return end_;
    const bool under_control = program_.following != Following::automatic || failed_;
    const double last = path_.last()->t;
    direction_ = failed_.value_or(last) - (failed_ ? last : path_.position().before_last.t) < 0 ? -1 : 1;
    if (under_control) end_.failure = go(main_stage());
    if (end_.failure.empty() && program_.then) end_.failure = go(stage_of(*program_.then));
    return end_;
  }

 private:
  [[nodiscard]] const contact::NitscheForm<dim>& form() const { return path_.last()->at->discrete.form; }

  void by_load();
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
    double fall;    ///< of t to the step after it
    Position from;  ///< the step before it, or where the search began
  };
  void look_for_peak(const Stage<dim>& stage, double size);
  [[nodiscard]] std::optional<Summit> summit_with(const Stage<dim>& stage, double size, double end,
                                                  const Position& from);

  LoadPath<dim>& path_;
  const PathProgram& program_;
  Observer observer_;
  const StepObserver& newton_;
  double largest_change_ = 0;       ///< of t, between neighbours in the list
  std::optional<double> failed_{};  ///< the value of t that ended Following::automatic
  PathEnd end_{};
  double direction_ = 1;  ///< of t, when t was given for the last time
  /// Before the last two steps of a stage, and before the one that is looked for.
  std::vector<Position> positions_{};
};

template <int dim>
void Follower<dim>::by_load()
{
  const bool is_automatic = program_.following == Following::automatic;
  for (std::size_t i = 0; i < program_.targets.size() && end_.failure.empty() && !failed_; ++i)
  {
    const double t = program_.targets[i];
    end_.failure = path_.advance(t, observer_, newton_, !is_automatic);
    if (end_.failure.empty() || !is_automatic || i < 2 || !path_.interruption().empty()) continue;
    failed_ = t;
    end_.failure.clear();
    end_.dropped.assign(program_.targets.begin() + static_cast<std::ptrdiff_t>(i), program_.targets.end());
  }
  if (!end_.failure.empty() && is_automatic && path_.interruption().empty())
    end_.failure += "; to go on by damage takes two load steps before: smaller history.steps";
}

template <int dim>
Stage<dim> Follower<dim>::main_stage() const
{
  const double measure = bonded_measure(form());
  const double enough = program_.enough_damage * measure;
  Stage<dim> stage{"damage", nullptr, PathMeasure<dim>(), program_.damage_step.value_or(measure / 50),
                   enough};
  if (program_.following == Following::displacement) stage = stage_of(program_.displacement);
  stage.enough_damage = measure > 0 ? enough : std::numeric_limits<double>::infinity();
  return stage;
}

/// Whether the measure, which is `now`, has come as far as it should, or damage and t have.
template <int dim>
bool Follower<dim>::is_over(const Stage<dim>& stage, double now) const
{
  constexpr double margin = 1e-9;
  const double left = (stage.until - now) * (stage.step < 0 ? -1 : 1);
  if (left <= margin * std::abs(stage.step)) return true;
  if (!stage.enough_damage) return false;
  const bool has_fallen =
      program_.t_min && end_.peak && direction_ * (path_.last()->t - *program_.t_min) <= 0;
  return has_fallen || value_at(path_, PathMeasure<dim>()) >= *stage.enough_damage;
}

/// Not empty: why it was not gone through.
template <int dim>
std::string Follower<dim>::go(Stage<dim> stage)
{
  double size = stage.step;
  double last_increment = 0;
  int cuts = 0;
  positions_.clear();
  if (const double now = value_at(path_, stage.measure);
      (stage.until - now) * stage.step < 0 && !stage.enough_damage)
    return fmt::format("the stage by {} is to go on until {:.6g}, and begins at {:.6g}", stage.name,
                       stage.until, now);
  for (int n = 0; n < program_.max_steps;)
  {
    const double now = value_at(path_, stage.measure);
    if (is_over(stage, now)) return {};
    Control<dim> control = this->control(stage, size);
    if (std::abs(size) > std::abs(stage.until - now)) control.increment = stage.until - now;
    control.last_increment = last_increment;
    control.cuts = cuts;
    if (n == 0) control.failed = failed_;
    positions_.push_back(path_.position());
    const std::shared_ptr<const LoadStep<dim>> before = path_.last();
    std::string failure = path_.follow(control, observer_, newton_);
    if (failure.empty())
    {
      ++n;
      cuts = 0;
      last_increment = control.increment;
      if (stage.gauges != nullptr && path_.last()->at->discrete.grid != before->at->discrete.grid)
        stage.measure = measure_of(*stage.gauges);  // its numbers are those of degrees of freedom
      committed(stage, control.increment);
      const bool was_easy = static_cast<int>(path_.last()->level.steps.size()) <= path_.options().few_steps;
      if (was_easy && std::abs(size) < std::abs(stage.step))
      {
        const double larger = path_.options().growth * size;
        size = std::abs(larger) < std::abs(stage.step) ? larger : stage.step;
      }
    }
    else if (!path_.interruption().empty() ||
             std::abs(control.increment) / 2 < smallest * std::abs(stage.step))
      return failure;
    else
    {
      positions_.pop_back();
      size = control.increment / 2;
      ++cuts;
    }
  }
  end_.notes.push_back(fmt::format("the stage by {} ended after {} steps, history.stop.steps, at t = {:.9g}",
                                   stage.name, program_.max_steps, path_.last()->t));
  return {};
}

/// After a step from the last of the positions.
template <int dim>
void Follower<dim>::committed(const Stage<dim>& stage, double size)
{
  constexpr double rounding = 1e-9;
  if (positions_.size() > 2) positions_.erase(positions_.begin());
  const double t = positions_.back().last->t;
  const double fall = direction_ * (t - path_.last()->t);
  if (!end_.peak && fall > rounding * std::max(std::abs(t), largest_change_)) look_for_peak(stage, size);
}

/// Notes the peak that the last step has left behind.
template <int dim>
void Follower<dim>::look_for_peak(const Stage<dim>& stage, double size)
{
  constexpr double accuracy = 1e-3;
  constexpr int max_halvings = 8;
  const LoadStep<dim>& highest = *positions_.back().last;
  end_.peak = Peak{.t = highest.t, .number = highest.number, .change = {}, .step = size};
  Peak& peak = *end_.peak;
  const double end = value_at(path_, stage.measure);
  std::optional<Summit> summit = Summit{highest.t, 0, positions_.front()};
  for (int i = 0; i < max_halvings; ++i)
  {
    summit = summit_with(stage, peak.step / 2, end, summit->from);
    if (!summit) return;
    peak.change = summit->t - peak.t;
    peak.t = summit->t;
    peak.step /= 2;
    if (std::max(std::abs(*peak.change), summit->fall) <= accuracy * std::abs(peak.t)) return;
  }
}

/// The summit on the path from `from` to the value `end` of the measure with steps of this size.
template <int dim>
auto Follower<dim>::summit_with(const Stage<dim>& stage, double size, double end, const Position& from)
    -> std::optional<Summit>
{
  LoadPath<dim> beside = path_;
  beside.go_back(from);
  Summit summit{from.last->t, 0, from};
  Control<dim> control = this->control(stage, size);
  double left = std::abs(end - value_at(beside, stage.measure));
  for (; left > 0.5 * std::abs(size); left -= std::abs(size))
  {
    const Position before = beside.position();
    if (!beside.follow(control, {}, newton_).empty()) return std::nullopt;
    control.last_increment = size;
    summit.fall = direction_ * (summit.t - beside.last()->t);
    if (summit.fall > 0) return summit;
    summit = {beside.last()->t, 0, before};
  }
  return std::nullopt;
}

}  // namespace

template <int dim>
PathEnd follow(LoadPath<dim>& path, const PathProgram& program,
               const typename LoadPath<dim>::Observer& observer, const StepObserver& newton,
               const StepRefiner<dim>& refine)
{
  return Follower<dim>(path, program, observer, newton, refine).run();
}

template PathEnd follow(LoadPath<2>&, const PathProgram&, const LoadPath<2>::Observer&, const StepObserver&,
                        const StepRefiner<2>&);
template PathEnd follow(LoadPath<3>&, const PathProgram&, const LoadPath<3>::Observer&, const StepObserver&,
                        const StepRefiner<3>&);

}  // namespace tribound::adapt
