#pragma once

/// @file path_program.h
/// What a load path goes through: values of t, and beyond them what damage or displacements lead to (method
/// section 12.7).

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

/// Steps of c.u, until it has a value.
struct DisplacementStage
{
  std::vector<Gauge> gauges{};
  double step = 0;
  double until = std::numeric_limits<double>::infinity();  ///< -infinity for step < 0
};

/// What is given after the values of t.
enum class Following
{
  load,       ///< nothing
  automatic,  ///< damage, from the first value on that Newton's method does not come to
  damage,
  displacement
};

struct PathProgram
{
  std::vector<double> targets{};  ///< the values of t, not empty
  Following following = Following::load;
  std::optional<double> damage_step{};      ///< of the integral of D
  int damage_steps = 50;                    ///< all interfaces are damaged in, where `damage_step` is absent
  DisplacementStage displacement{};         ///< of Following::displacement
  double enough_damage = 0.99;              ///< mean D of all interfaces at which a stage ends
  std::optional<double> t_min{};            ///< a stage ends with t at or beyond it, after the peak
  int max_steps = 200;                      ///< of a stage
  std::optional<DisplacementStage> then{};  ///< after all
};

/// The largest t (where the list decreases, the smallest) that the path turns back from: the level at which a
/// structure fails.
struct Peak
{
  double t = 0;
  int number = 0;  ///< of the step with that t, before it was looked at more closely
  /// Of t when the steps around it were halved for the last time; absent where they could not be followed.
  std::optional<double> change{};
  double step = 0;  ///< their increment then
};

/// What came of a program.
struct PathEnd
{
  std::string failure{};          ///< not empty: why it was not followed to its end
  std::vector<double> dropped{};  ///< values of t that were left out for Following::automatic
  std::optional<Peak> peak{};     ///< where there was one
  /// Stages that ended before what they were to reach: beyond the peak this is no failure.
  std::vector<std::string> notes{};
};

/// What a program is at.
enum class PathStage
{
  load,  ///< the values of t
  main,  ///< what Following names
  then   ///< PathProgram::then
};

/// Where a program is, for one that goes on from there.
template <int dim>
struct PathProgress
{
  std::size_t target = 0;          ///< the next value of t
  LoadProgress load{};             ///< on the way there
  std::optional<double> failed{};  ///< the value of t that ended Following::automatic
  double direction = 1;            ///< of t, when t was given for the last time
  PathStage stage = PathStage::load;
  int steps = 0;                 ///< of the stage by control, as all that follows
  std::optional<double> size{};  ///< of the next increment; absent at its beginning
  double last_increment = 0;
  int cuts = 0;
  std::vector<typename LoadPath<dim>::Position>
      positions{};  ///< before its last two steps, and the one that is looked for
  PathEnd end{};    ///< what has come of the program so far
};

/// Called after every step that is committed, before it is observed. May solve it again on a finer mesh
/// (LoadPath::repeat); it then carries the `kept` positions there, to which the program may go back.
template <int dim>
using StepRefiner = std::function<void(std::span<typename LoadPath<dim>::Position> kept)>;

/// Follows the program. A step by damage that fails is tried by its process zone (follow_zone), so that the
/// damage may grow by more or less; steps that fail are halved, down to 1/1024. At a peak the steps around it
/// are tried again with halved increments, beside the path, until its t changes by less than 1e-3, relative.
/// `observer` sees the committed steps of the path, those beside it not, nor does `refine`, when `progress`
/// is that after the step: with a path at its last step then it goes on with the next one. Throws as LoadPath
/// does, and as functional().
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
