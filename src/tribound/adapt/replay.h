#pragma once

/// @file replay.h
/// A load path repeated from its first step on finer meshes until the mesh is fine enough for all its steps
/// (method section 12.4). History is never transferred between meshes.

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tribound/adapt/load_path.h"
#include "tribound/adapt/loop.h"
#include "tribound/adapt/path_program.h"

namespace tribound::adapt
{

/// A pass: the path on one mesh.
template <int dim>
struct PassView
{
  int number;  ///< from 0, on the given mesh
  /// The number of the step with the largest bound, relative to the largest ||sigma|| of the path.
  int worst;
  const certify::Bound& bound;      ///< of that step
  const certify::Verdict& verdict;  ///< the worst of its steps
  const LoadStep<dim>* step;        ///< that step; null where it was before a restart, or is not kept
};

/// The state of a run over a path after a load step.
template <int dim>
struct ReplayState
{
  int pass = 0;
  PathProgress<dim> progress;  ///< without its positions
  SavedPath<dim> path;         ///< the last step, and the positions of `progress` before it
  std::optional<certify::FriedrichsConstant> friedrichs;
  // Over the steps of the pass so far:
  std::vector<certify::BoundComponents> cells;  ///< of own cells, from the step with the largest bound there
  certify::Bound worst;                         ///< the largest
  int worst_step = 0;                           ///< the number of its step
  certify::Verdict verdict{certify::RunStatus::certified, {}};

  /// Notes the bound of a step if it is the largest so far, and the worst verdict.
  bool note_worst(const LoadStep<dim>& step);
  void note_verdict(const LoadStep<dim>& step);
  /// Notes the position of the path, before the state is reported.
  void note(const LoadPath<dim>& of);
  /// Takes a path on the same mesh to this state, for a run that continues. Throws as LoadPath::recall().
  void recall(LoadPath<dim>& on);
};

/// Callbacks of replay() and transfer(); empty functions are not called.
template <int dim>
struct ReplayObserver
{
  StepObserver newton{};
  std::function<void(int pass, const Grid<dim>&)> begins{};  ///< before anything is solved on the mesh
  std::function<void(const LoadStep<dim>&)> step{};
  std::function<void(const ReplayState<dim>&)> state{};  ///< after each step; needs copies
  std::function<void(const PathEnd&)> path_end{};        ///< of a pass, whatever its outcome
  std::function<void(const PassView<dim>&)> complete{};
  /// Called for a pass after the first; false where the previous one is no longer valid, as after a restart.
  std::function<bool()> given_up{};
  /// Called by transfer() instead of another pass: the last step solved on `left` has been solved again on
  /// the finer mesh, on which the path continues.
  std::function<void(const PassView<dim>& left, const Grid<dim>& finer)> finer{};
};

/// Follows the program on the mesh of `first`. While the bound of any step exceeds `options.tolerance` of the
/// path's largest ||sigma(u_h)||, follows it again, with its own steps, on a finer mesh. Cells are marked by
/// the largest of their bounds over the steps, with strategy.mark, within strategy.stop and strategy.limit;
/// the rest of `strategy` is not used. If a pass cannot be completed, the previous one is the last; if this
/// is the first pass, its steps so far remain, and the verdict says where it ended. Throws as LoadPath does.
/// With `from` it continues after the load step of another run, and `first` is a path on its mesh.
template <int dim>
[[nodiscard]] certify::Verdict replay(std::unique_ptr<LoadPath<dim>> first, const PathProgram& program,
                                      const Strategy<dim>& strategy, const ReplayObserver<dim>& observer,
                                      const ReplayState<dim>* from = nullptr);

}  // namespace tribound::adapt
