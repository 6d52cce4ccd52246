#pragma once

/// @file path_program.h
/// The course of a load path: prescribed values of t, then prescribed damage or displacements (method section
/// 12.7).

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/load_path.h"
#include "tribound/adapt/path_measure.h"

namespace tribound::adapt
{

/// Steps of c.u until it reaches a value.
struct DisplacementStage
{
  std::vector<Gauge> gauges{};
  double step = 0;
  double until = std::numeric_limits<double>::infinity();  ///< -infinity for step < 0
};

/// The control after the prescribed values of t.
enum class Following
{
  load,       ///< nothing
  automatic,  ///< damage, from the first value of t that Newton's method does not reach
  damage,
  displacement
};

struct PathProgram
{
  std::vector<double> targets{};  ///< the values of t, not empty
  Following following = Following::load;
  std::optional<double> damage_step{};      ///< of the integral of D
  int damage_steps = 50;                    ///< to damage all interfaces, where `damage_step` is absent
  DisplacementStage displacement{};         ///< of Following::displacement
  double enough_damage = 0.99;              ///< mean D of all interfaces at which a stage ends
  std::optional<double> t_min{};            ///< a stage ends when t reaches it after the peak
  int max_steps = 200;                      ///< of a stage
  std::optional<DisplacementStage> then{};  ///< after everything else
};

/// The largest t (the smallest where the list decreases) before the path turns back: the load level at which
/// a structure fails.
struct Peak
{
  double t = 0;
  int number = 0;  ///< of the step with that t, before refinement of the peak
  /// Change of t when the steps around it were last halved; absent where they could not be followed.
  std::optional<double> change{};
  double step = 0;  ///< their last increment
};

/// The outcome of a program.
struct PathEnd
{
  std::string failure{};          ///< why it was not completed; empty: it was
  std::vector<double> dropped{};  ///< values of t omitted because of Following::automatic
  std::optional<Peak> peak{};     ///< where there was one
  /// Stages that ended before their goal; beyond the peak this is no failure.
  std::vector<std::string> notes{};
};

/// The current stage of a program.
enum class PathStage
{
  load,  ///< the values of t
  main,  ///< the control of Following
  then   ///< PathProgram::then
};

/// The progress of a program, for a run that continues it.
template <int dim>
struct PathProgress
{
  std::size_t target = 0;          ///< the next value of t
  LoadProgress load{};             ///< towards it
  std::optional<double> failed{};  ///< the value of t that ended Following::automatic
  double direction = 1;            ///< of t, when t was last prescribed
  PathStage stage = PathStage::load;
  int steps = 0;                 ///< of the controlled stage, as are the following members
  std::optional<double> size{};  ///< of the next increment; absent at the beginning of the stage
  double last_increment = 0;
  int cuts = 0;
  std::vector<typename LoadPath<dim>::Position>
      positions{};  ///< before its last two steps, and the current one
  PathEnd end{};    ///< the outcome so far
};

/// Called after every committed step, before it is observed. May solve it again on a finer mesh
/// (LoadPath::repeat); it then transfers the `kept` positions, to which the program may return.
template <int dim>
using StepRefiner = std::function<void(std::span<typename LoadPath<dim>::Position> kept)>;

/// Follows the program. If a step by damage fails, a step by its process zone is tried (follow_zone), so the
/// damage may grow by more or less. Steps that fail are halved, down to 1/1024. At a peak the steps around it
/// are repeated with halved increments, apart from the path, until its t changes by less than 1e-3, relative.
/// `observer` and `refine` see only the committed steps of the path. `observer` is called when `progress` is
/// that after the step: with a path at its last step, the program then continues with the next one. Throws as
/// LoadPath does, and as functional().
template <int dim>
[[nodiscard]] PathEnd follow(LoadPath<dim>& path, const PathProgram& program,
                             const typename LoadPath<dim>::Observer& observer, const StepObserver& newton,
                             PathProgress<dim>& progress, const StepRefiner<dim>& refine = {});
template <int dim>
[[nodiscard]] PathEnd follow(LoadPath<dim>& path, const PathProgram& program,
                             const typename LoadPath<dim>::Observer& observer, const StepObserver& newton)
{
  PathProgress<dim> progress;
  return follow(path, program, observer, newton, progress);
}

}  // namespace tribound::adapt
